#include "core/cyclic_thread.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace taktwerk {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

/// Wakes late by what the test says, once.
class LateClock final : public Clock {
public:
    Instant now() const noexcept override { return inner.now(); }
    void sleep_until(Instant deadline) noexcept override {
        inner.sleep_until(deadline);
        inner.advance(late);
        late = 0ns;
    }
    VirtualClock inner;
    Duration late{0};
};

struct Trace {
    std::vector<Instant> scheduled;
    std::vector<std::uint64_t> missed, cycle;
    void add(const CycleTiming& t) {
        scheduled.push_back(t.scheduled);
        missed.push_back(t.missed);
        cycle.push_back(t.cycle);
    }
};

const std::atomic<bool> never{false};

TEST(CyclicThread, InVirtualTimeEveryCycleIsOnTheGridAndPunctual) {
    VirtualClock clock{Instant{10ms}};
    CyclicThread thread{clock, {.period = 1ms}};
    Trace trace;
    Duration lateness{0};

    const auto end = thread.run(
        [&](const CycleTiming& t) {
            trace.add(t);
            lateness += t.lateness;
            return t.cycle == 2 ? CycleVerdict::stop : CycleVerdict::carry_on;
        },
        never);

    EXPECT_EQ(end, CycleEnd::step);
    EXPECT_THAT(trace.scheduled, ElementsAre(Instant{11ms}, Instant{12ms}, Instant{13ms}));
    EXPECT_EQ(lateness, 0ns);
    EXPECT_EQ(thread.counters().cycles, 3u);
    EXPECT_EQ(thread.counters().missed, 0u);
}

TEST(CyclicThread, TheFirstCycleIsAtTheGivenInstantWhenThatIsStillAhead) {
    VirtualClock clock;
    CyclicThread thread{clock, {.period = 1ms, .first = Instant{2500us}}};
    Trace trace;
    thread.run([&](const CycleTiming& t) { return trace.add(t), t.cycle == 1 ? CycleVerdict::stop : CycleVerdict::carry_on; }, never);
    EXPECT_THAT(trace.scheduled, ElementsAre(Instant{2500us}, Instant{3500us}));
}

// Cycle 1 takes 2.3 periods: instants 3 and 4 are gone, the next cycle is at instant 5, and no cycle runs in between.
TEST(CyclicThread, MissedInstantsAreCountedAndSkippedNeverCaughtUp) {
    VirtualClock clock;
    CyclicThread thread{clock, {.period = 1ms}};
    Trace trace;

    thread.run(
        [&](const CycleTiming& t) {
            trace.add(t);
            if (t.cycle == 1) clock.advance(2300us);
            return t.cycle == 3 ? CycleVerdict::stop : CycleVerdict::carry_on;
        },
        never);

    EXPECT_THAT(trace.scheduled, ElementsAre(Instant{1ms}, Instant{2ms}, Instant{5ms}, Instant{6ms}));
    EXPECT_THAT(trace.missed, ElementsAre(0, 0, 2, 0));
    EXPECT_THAT(trace.cycle, ElementsAre(0, 1, 2, 3));
    EXPECT_EQ(thread.counters().missed, 2u);
    EXPECT_EQ(thread.counters().overruns, 1u);
    EXPECT_EQ(thread.counters().consecutive, 0u);
    EXPECT_EQ(thread.counters().worst_run, 1u);
}

TEST(CyclicThread, AStepThatEndsExactlyAtTheNextInstantDoesNotOverrun) {
    VirtualClock clock;
    CyclicThread thread{clock, {.period = 1ms}};
    thread.run([&](const CycleTiming& t) { return clock.advance(1ms), t.cycle == 4 ? CycleVerdict::stop : CycleVerdict::carry_on; }, never);
    EXPECT_EQ(thread.counters().overruns, 0u);
    EXPECT_EQ(clock.now(), Instant{6ms});
}

TEST(CyclicThread, ALateWakeUpIsReportedAndDoesNotMoveTheGrid) {
    LateClock clock;
    CyclicThread thread{clock, {.period = 1ms}};
    Trace trace;
    std::vector<Duration> lateness;
    clock.late = 400us;

    thread.run(
        [&](const CycleTiming& t) {
            trace.add(t);
            lateness.push_back(t.lateness);
            return t.cycle == 1 ? CycleVerdict::stop : CycleVerdict::carry_on;
        },
        never);

    EXPECT_THAT(lateness, ElementsAre(400us, 0us));
    EXPECT_THAT(trace.scheduled, ElementsAre(Instant{1ms}, Instant{2ms}));
    EXPECT_EQ(thread.counters().overruns, 0u);
}

struct Judge {
    std::vector<std::uint32_t> asked;
    std::uint32_t stop_at = 0;
    static CycleVerdict decide(void* self, const CycleTiming&, std::uint32_t consecutive) noexcept {
        auto& judge = *static_cast<Judge*>(self);
        judge.asked.push_back(consecutive);
        return consecutive >= judge.stop_at ? CycleVerdict::stop : CycleVerdict::carry_on;
    }
};

TEST(CyclicThread, AfterNOverrunsInARowThePolicyDecides) {
    VirtualClock clock;
    Judge judge{{}, 6};
    CyclicThread thread{clock, {.period = 1ms, .on_overruns = {3, &Judge::decide, &judge}}};

    const auto end = thread.run([&](const CycleTiming&) { clock.advance(1500us); }, never);

    EXPECT_EQ(end, CycleEnd::overruns);
    EXPECT_THAT(judge.asked, ElementsAre(3u, 6u));
    EXPECT_EQ(thread.counters().cycles, 6u);
}

TEST(CyclicThread, APunctualCycleBreaksTheRowOfOverruns) {
    VirtualClock clock;
    Judge judge{{}, 0};
    CyclicThread thread{clock, {.period = 1ms, .on_overruns = {3, &Judge::decide, &judge}}};

    const auto end = thread.run(
        [&](const CycleTiming& t) {
            if (t.cycle % 3 != 2) clock.advance(1500us);
            return t.cycle == 20 ? CycleVerdict::stop : CycleVerdict::carry_on;
        },
        never);

    EXPECT_EQ(end, CycleEnd::step);
    EXPECT_TRUE(judge.asked.empty());
    EXPECT_EQ(thread.counters().worst_run, 2u);
}

TEST(CyclicThread, TheGridShiftsByAtMostHalfAPeriodAndStaysShifted) {
    VirtualClock clock;
    CyclicThread thread{clock, {.period = 1ms}};
    Trace trace;

    thread.run(
        [&](const CycleTiming& t) {
            trace.add(t);
            if (t.cycle == 0) thread.shift_grid(20us);
            if (t.cycle == 2) thread.shift_grid(-5ms);
            return t.cycle == 4 ? CycleVerdict::stop : CycleVerdict::carry_on;
        },
        never);

    EXPECT_THAT(trace.scheduled, ElementsAre(Instant{1ms}, Instant{2020us}, Instant{3020us}, Instant{3520us}, Instant{4520us}));
}

TEST(CyclicThread, TheStopFlagEndsItBeforeTheNextCycle) {
    VirtualClock clock;
    std::atomic<bool> stop{false};
    CyclicThread thread{clock, {.period = 1ms}};

    const auto end = thread.run([&](const CycleTiming& t) { stop = t.cycle == 1; }, stop);

    EXPECT_EQ(end, CycleEnd::asked);
    EXPECT_EQ(thread.counters().cycles, 2u);
}

TEST(CyclicThread, OnTheSystemClockNoCycleStartsBeforeItsInstant) {
    SystemClock clock;
    CyclicThread thread{clock, {.period = 200us}};
    int early = 0;
    thread.run(
        [&](const CycleTiming& t) { return early += t.woken < t.scheduled, t.cycle == 20 ? CycleVerdict::stop : CycleVerdict::carry_on; },
        never);
    EXPECT_EQ(early, 0);
}

}  // namespace
}  // namespace taktwerk
