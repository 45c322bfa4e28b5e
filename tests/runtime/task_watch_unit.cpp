// When a slower task has not kept its time, counted in cycles. The sensitivity is that of CODESYS' task watchdog: so many runs in a row that take
// longer, or one that takes so many times as long.

#include "runtime/tasks/task_watch.hpp"

#include <gtest/gtest.h>

namespace taktwerk::runtime {
namespace {

using namespace std::chrono_literals;

struct Watch : ::testing::Test {
    TaskConfig config;
    MachineConfig machine;  // 1 ms
    std::uint64_t now = 100;
    Watch() { config.overrun = OverrunReaction::count; }
    /// A run of so many cycles; the verdict behind it, and whether it had come before.
    TaskVerdict run(TaskWatch& watch, std::uint64_t cycles) {
        watch.begin(now);
        auto verdict = TaskVerdict::in_time;
        for (std::uint64_t i = 1; i <= cycles && verdict == TaskVerdict::in_time; ++i) verdict = watch.verdict(now + i);
        early = verdict != TaskVerdict::in_time;
        now += cycles;
        watch.end(now);
        return watch.verdict(now);
    }
    bool early = false;
};

TEST_F(Watch, AFractionOfACycleIsAWholeOne) {
    config.watchdog = 2500us;
    EXPECT_EQ((TaskWatch{config, machine}.watchdog()), 3u);
    config.watchdog = 2ms;
    EXPECT_EQ((TaskWatch{config, machine}.watchdog()), 2u);
    config.watchdog = 0ms;
    EXPECT_EQ((TaskWatch{config, machine}.watchdog()), 250u) << "none, but behind the stop of its program (docs/tasks.md)";
}

TEST_F(Watch, BitesWithinTheRunThatTakesLonger) {
    config.watchdog = 8ms;
    TaskWatch watch{config, machine};
    EXPECT_EQ(run(watch, 8), TaskVerdict::in_time);
    EXPECT_EQ(run(watch, 9), TaskVerdict::watchdog);
    EXPECT_TRUE(early);
    EXPECT_EQ(watch.cycles_taken(now), 9u);
    watch.forgive();
    EXPECT_EQ(watch.verdict(now), TaskVerdict::in_time);
}

TEST_F(Watch, SensitivityBearsSingleLongRuns) {
    config.watchdog = 8ms;
    config.watchdog_sensitivity = 3;
    TaskWatch watch{config, machine};
    EXPECT_EQ(run(watch, 10), TaskVerdict::in_time);
    EXPECT_EQ(run(watch, 10), TaskVerdict::in_time);
    EXPECT_EQ(run(watch, 8), TaskVerdict::in_time) << "one in time begins anew";
    EXPECT_EQ(run(watch, 10), TaskVerdict::in_time);
    EXPECT_EQ(run(watch, 10), TaskVerdict::in_time);
    EXPECT_EQ(run(watch, 10), TaskVerdict::watchdog) << "three in a row";
    EXPECT_FALSE(early) << "known when it has ended";
    watch.forgive();
    EXPECT_EQ(run(watch, 24), TaskVerdict::in_time) << "three times 8 ms";
    watch.forgive();
    EXPECT_EQ(run(watch, 25), TaskVerdict::watchdog) << "one that takes more";
    EXPECT_TRUE(early);
}

TEST_F(Watch, WithoutALimitNothingIsTooLong) {
    config.watchdog = 0ms;
    TaskWatch watch{config, machine};
    EXPECT_EQ(run(watch, 100'000), TaskVerdict::in_time);
}

// A host or network without real time: what it does to a thread is nobody's fault. What the file says of a watchdog holds.
TEST_F(Watch, RelaxedSupervisionIsMorePatient) {
    config.overruns_allowed = 3;
    config.divisor = 8;
    EXPECT_EQ(TaskWatch::watchdog_of(config, machine), 250ms);
    EXPECT_EQ(TaskWatch::overruns_allowed(config, machine), 3u);
    machine.simulation.supervision = Supervision::relaxed;
    EXPECT_EQ(TaskWatch::watchdog_of(config, machine), 2500ms);
    EXPECT_EQ(TaskWatch::overruns_allowed(config, machine), 300u);
    config.watchdog = 20ms;
    EXPECT_EQ(TaskWatch::watchdog_of(config, machine), 20ms);
}

TEST_F(Watch, MissedReleasesCountInARowAndOnlyWhereTheyStopTheProgram) {
    for (const auto reaction : {OverrunReaction::stop_program, OverrunReaction::count, OverrunReaction::stop_machine}) {
        config.overrun = reaction;
        config.overruns_allowed = 2;
        TaskWatch watch{config, machine};
        watch.missed();
        watch.missed();
        watch.in_time();
        watch.missed();
        watch.missed();
        EXPECT_EQ(watch.verdict(now), TaskVerdict::in_time);
        watch.missed();
        EXPECT_EQ(watch.overruns(), 3u);
        EXPECT_EQ(watch.verdict(now), reaction == OverrunReaction::stop_program ? TaskVerdict::late : TaskVerdict::in_time);
    }
}

}  // namespace
}  // namespace taktwerk::runtime
