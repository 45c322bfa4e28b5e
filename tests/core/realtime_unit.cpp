#include "core/realtime.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/prctl.h>

#include <thread>

namespace taktwerk {
namespace {

using testing::HasSubstr;

/// What is asked for a thread is asked for one of our own: it ends with it.
template <class F>
void on_a_thread(F f) {
    std::thread{f}.join();
}

TEST(Realtime, AnImpossiblePriorityIsRefusedInWords) {
    for (const int priority : {0, 100, -1}) {
        const auto result = set_fifo_priority(priority);
        ASSERT_FALSE(result.ok());
        EXPECT_EQ(result.error().code, "realtime.priority");
    }
    EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
}

TEST(Realtime, APriorityIsEitherGrantedAndThereOrRefusedWithARemedy) {
    on_a_thread([] {
        const auto result = set_fifo_priority(10);
        if (result.ok()) {
            sched_param parameters{};
            sched_getparam(0, &parameters);
            EXPECT_EQ(sched_getscheduler(0), SCHED_FIFO | SCHED_RESET_ON_FORK);
            EXPECT_EQ(parameters.sched_priority, 10);
        } else {
            EXPECT_THAT(result.error().remedy, HasSubstr("CAP_SYS_NICE"));
        }
    });
}

TEST(Realtime, ACpuThatDoesNotExistIsRefusedByNumber) {
    on_a_thread([] {
        EXPECT_THAT(pin_to_cpus({1000}).error().text(), HasSubstr("1000"));
        EXPECT_THAT(pin_to_cpus({-1}).error().text(), HasSubstr("-1"));
        EXPECT_FALSE(pin_to_cpus({100'000}).ok());
    });
}

TEST(Realtime, APinnedThreadRunsThereOnly) {
    on_a_thread([] {
        cpu_set_t before;
        ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
        int cpu = 0;
        while (!CPU_ISSET(cpu, &before)) ++cpu;

        ASSERT_TRUE(pin_to_cpus({cpu}).ok());

        cpu_set_t after;
        ASSERT_EQ(sched_getaffinity(0, sizeof after, &after), 0);
        EXPECT_EQ(CPU_COUNT(&after), 1);
        EXPECT_TRUE(CPU_ISSET(cpu, &after));
    });
}

TEST(Realtime, TimerSlackIsSetForThisThread) {
    on_a_thread([] {
        ASSERT_TRUE(set_timer_slack(Duration{1}).ok());
        EXPECT_EQ(prctl(PR_GET_TIMERSLACK), 1);
    });
    EXPECT_NE(prctl(PR_GET_TIMERSLACK), 1);
}

TEST(Realtime, MoreStackThanTheThreadHasIsAnErrorNotACrash) {
    on_a_thread([] {
        EXPECT_TRUE(prefault_stack(128 * 1024).ok());
        const auto result = prefault_stack(std::size_t{1} << 40);
        ASSERT_FALSE(result.ok());
        EXPECT_EQ(result.error().code, "realtime.stack");
    });
}

TEST(Realtime, TheLatencyHoldNamesTheFileItCannotOpen) {
    const auto result = CpuLatencyHold::acquire(Duration{0}, "/nonexistent/cpu_dma_latency");
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, "realtime.cpu_latency");
    EXPECT_THAT(result.error().text(), HasSubstr("/nonexistent/cpu_dma_latency"));
}

TEST(Realtime, EveryRefusalSaysWhyAndWhatItCostsAndNothingIsFatal) {
    on_a_thread([] {
        RealtimeRequest request;
        request.priority = 1000;
        request.cpus = {1000};

        const RealtimeReport report = prepare_cycle_thread(request);

        EXPECT_EQ(report.items.size(), 4u);  // stack, CPUs, timer slack, priority
        EXPECT_FALSE(report.all_granted());
        for (const auto& item : report.items) {
            EXPECT_EQ(item.granted, item.reason.empty()) << item.what;
            EXPECT_EQ(item.granted, item.consequence.empty()) << item.what;
        }
        EXPECT_FALSE(report.items.back().granted);
        EXPECT_THAT(report.text(), HasSubstr("refused: SCHED_FIFO priority 1000"));
        EXPECT_THAT(report.text(), HasSubstr("granted: timer slack"));
    });
}

TEST(Realtime, WhatWasNotAskedForIsNotInTheReport) {
    on_a_thread([] {
        RealtimeRequest request;
        request.priority.reset();
        request.prefault_stack = 0;
        const RealtimeReport report = prepare_cycle_thread(request);
        ASSERT_EQ(report.items.size(), 1u);
        EXPECT_THAT(report.items[0].what, HasSubstr("timer slack"));

        request.lock_memory = false;
        request.hold_cpu_latency = false;
        CpuLatencyHold hold;
        EXPECT_EQ(prepare_process(request, hold).items.size(), 1u);  // only the kernel's kind
        EXPECT_FALSE(hold.held());
    });
}

}  // namespace
}  // namespace taktwerk
