#include "core/clock.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

namespace taktwerk {
namespace {

using namespace std::chrono_literals;

TEST(VirtualClock, TimePassesOnlyWhenSomeoneWaits) {
    VirtualClock clock{Instant{5ms}};
    EXPECT_EQ(clock.now(), Instant{5ms});

    clock.sleep_until(Instant{7ms});
    EXPECT_EQ(clock.now(), Instant{7ms});
}

TEST(VirtualClock, ADeadlineInThePastDoesNotTurnTimeBack) {
    VirtualClock clock{Instant{5ms}};
    clock.sleep_until(Instant{1ms});
    EXPECT_EQ(clock.now(), Instant{5ms});
}

TEST(SystemClock, NeverRunsBackAndWaitsAtLeastUntilTheDeadline) {
    SystemClock clock;
    const Instant before = clock.now();

    clock.sleep_until(before + 100us);

    EXPECT_GE(clock.now(), before + 100us);
}

TEST(SystemClock, ADeadlineBeforeBootReturnsAtOnce) {
    // In a process of its own, which the alarm clock ends if it waits or turns in circles.
    EXPECT_EXIT(
        {
            ::alarm(20);
            SystemClock clock;
            clock.sleep_until(Instant{-1ns});
            clock.sleep_until(Instant{});
            ::_exit(7);
        },
        testing::ExitedWithCode(7), "");
}

}  // namespace
}  // namespace taktwerk
