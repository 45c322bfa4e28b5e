// Rate monotonic: the shorter the period, the higher the priority (Liu and Layland, J. ACM 20, 1973), below the cycle's.

#include "runtime/run/task_priorities.hpp"

#include <gtest/gtest.h>

namespace taktwerk::runtime {
namespace {

std::vector<TaskConfig> with(std::initializer_list<std::uint16_t> divisors) {
    std::vector<TaskConfig> out;
    for (const auto divisor : divisors) out.emplace_back().divisor = divisor;
    return out;
}

using Priorities = std::vector<int>;

TEST(TaskPriorities, TheShortestPeriodHasTheHighestAndEqualOnesShareOne) {
    EXPECT_EQ(task_priorities(with({50, 4, 1000, 50, 8}), 80), (Priorities{47, 49, 46, 47, 48}));
}

TEST(TaskPriorities, AllAreBelowTheCycleWithAPlaceForTheWatch) {
    EXPECT_EQ(task_priorities(with({4, 8}), 30), (Priorities{28, 27}));
    EXPECT_EQ(task_priorities(with({4, 8, 16}), 4), (Priorities{2, 1, 1})) << "1 is the lowest there is";
}

TEST(TaskPriorities, WhereTheCycleIsAnOrdinaryThreadAllAre) {
    EXPECT_EQ(task_priorities(with({4, 8}), 0), (Priorities{0, 0}));
    EXPECT_EQ(task_priorities(with({4, 8}), 2), (Priorities{0, 0})) << "there is no place below the watch";
}

TEST(TaskPriorities, WhatTheFileSaysIsTakenAndDoesNotMoveTheOthers) {
    auto tasks = with({4, 8, 16});
    tasks[1].priority = 70;
    EXPECT_EQ(task_priorities(tasks, 80), (Priorities{49, 70, 48}));
    tasks[1].priority = 0;
    EXPECT_EQ(task_priorities(tasks, 80), (Priorities{49, 0, 48}));
}

}  // namespace
}  // namespace taktwerk::runtime
