// The servo by itself, and in a loop with a reference clock that drifts, jumps, stands still or disappears.
#include "ecat/dc/cycle_servo.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <random>

#include "ecat/dc/reference_clock.hpp"

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;

constexpr std::int64_t ns = ReferenceClock::fine;

TEST(CycleServo, LeavesAPerfectCycleAlone) {
    CycleServo servo{1ms};
    for (int i = 0; i < 100; ++i) EXPECT_EQ(servo.step({0, 0, true}), 0ns);
    EXPECT_EQ(servo.lock(), DcLock::locked);
}

// 50 ppm of 1 ms: the reference gains 50 ns a cycle, so each period has to be 50 ns shorter. (Slew: 1 us a cycle, no matter here.)
TEST(CycleServo, FollowsTheDriftOfTheReference) {
    CycleServo servo{1ms};
    EXPECT_EQ(servo.step({0, 50 * ns, true}), -50ns);
}

// 123 ppb are 0.123 ns a cycle: 123 ns in 1000 cycles, however the ns fall.
TEST(CycleServo, CarriesPartsOfANanosecond) {
    CycleServo servo{1ms};
    Duration sum{};
    for (int i = 0; i < 1000; ++i) sum += servo.step({0, 123 * ns / 1000, true});
    EXPECT_NEAR(static_cast<double>(sum.count()), -123, 2);
}

// A sixteenth of 800 ns is 50 ns: too late in the reference's time, so shorter.
TEST(CycleServo, TakesASixteenthOfTheErrorOut) {
    CycleServo servo{1ms};
    EXPECT_EQ(servo.step({800, 0, true}), -50ns);
    EXPECT_EQ(servo.step({-800, 0, true}), 50ns);
}

TEST(CycleServo, ChangesThePeriodByAThousandthACycleAndByAHundredthInAll) {
    CycleServo servo{1ms};
    Duration before{};
    for (int i = 0; i < 40; ++i) {
        const Duration now = servo.step({500'000, 0, true});
        EXPECT_GE(now, before - 1us);
        before = now;
    }
    EXPECT_EQ(before, -10us);
}

TEST(CycleServo, LocksAfter32CyclesInsideTheWindowAndNotBefore) {
    CycleServo servo{1ms};
    for (int i = 0; i < 31; ++i) (void)servo.step({5'000, 0, true});
    EXPECT_EQ(servo.lock(), DcLock::acquiring);
    (void)servo.step({5'001, 0, true});
    for (int i = 0; i < 31; ++i) (void)servo.step({5'000, 0, true});
    EXPECT_EQ(servo.lock(), DcLock::acquiring) << "one cycle outside counts from the beginning";
    (void)servo.step({5'000, 0, true});
    EXPECT_EQ(servo.lock(), DcLock::locked);
}

TEST(CycleServo, StaysLockedThroughAShortDisturbance) {
    CycleServo servo{1ms};
    for (int i = 0; i < 32; ++i) (void)servo.step({0, 0, true});
    for (int i = 0; i < 7; ++i) (void)servo.step({40'001, 0, true});
    EXPECT_EQ(servo.lock(), DcLock::locked);
    (void)servo.step({40'001, 0, true});
    EXPECT_EQ(servo.lock(), DcLock::acquiring);
}

TEST(CycleServo, CoastsWithoutSamplesAndIsLostAfterTwoSeconds) {
    CycleServo servo{1ms};
    for (int i = 0; i < 32; ++i) (void)servo.step({0, 50 * ns, true});
    for (int i = 0; i < 7; ++i) (void)servo.step({0, 50 * ns, false});
    EXPECT_EQ(servo.lock(), DcLock::locked);
    EXPECT_EQ(servo.step({0, 50 * ns, false}), -50ns) << "on with the speed learned last";
    EXPECT_EQ(servo.lock(), DcLock::coasting);
    for (int i = 0; i < 1991; ++i) (void)servo.step({0, 50 * ns, false});
    EXPECT_EQ(servo.lock(), DcLock::coasting);
    (void)servo.step({0, 50 * ns, false});
    EXPECT_EQ(servo.lock(), DcLock::lost);
}

TEST(CycleServo, DoesNotLockOnAPhaseThatIsOnlyExtrapolated) {
    CycleServo servo{1ms};
    for (int i = 0; i < 100; ++i) (void)servo.step({0, 0, false});
    EXPECT_EQ(servo.lock(), DcLock::acquiring);
    (void)servo.step({0, 0, true});
    EXPECT_EQ(servo.lock(), DcLock::locked) << "one that was measured says that the phase was right all along";
}

TEST(CycleServo, WaitsWithTheNominalPeriod) {
    CycleServo servo{1ms};
    for (int i = 0; i < 100; ++i) (void)servo.step({800, 0, true});
    EXPECT_EQ(servo.wait(), 0ns);
    EXPECT_EQ(servo.lock(), DcLock::none);
}

/// A master's cycle and a reference: one iteration is one cycle, as ProcessDataCycle runs it.
struct Loop : testing::Test {
    static constexpr Duration cycle = 1ms;

    /// The reference's time at machine time `t`.
    [[nodiscard]] std::int64_t reference(Instant t) const {
        const std::int64_t passed = (t - drift_from).count();
        return began + passed + passed / 1'000'000 * drift_ppm + passed % 1'000'000 * drift_ppm / 1'000'000;
    }
    [[nodiscard]] std::int64_t true_error() const {
        const std::int64_t period = cycle.count(), into = ((reference(now) - target) % period + period) % period;
        return into > period / 2 ? into - period : into;
    }
    void run(int cycles) {
        for (int i = 0; i < cycles; ++i) {
            now += cycle + correction;
            const bool fresh = answers && in_flight && clock.take(*in_flight, stamped);
            if (!fresh) clock.miss();
            // As the cycle does it: nothing to steer by before the clock has settled.
            if (!clock.settled()) {
                correction = servo.wait();
            } else {
                if (!started) target = reference(now) % cycle.count(), started = true;
                const std::int64_t period = cycle.count();
                const std::int64_t system = now.time_since_epoch().count() + clock.offset_at(now);
                const std::int64_t into = ((system - target) % period + period) % period;
                correction = servo.step({into > period / 2 ? into - period : into, clock.drift_in(cycle), fresh});
            }
            worst_correction = std::max(worst_correction, std::chrono::abs(correction));
            worst_error = std::max(worst_error, std::abs(true_error()));
            const Duration noise{jitter > 0ns ? std::uniform_int_distribution<std::int64_t>{0, jitter.count()}(random) : 0};
            in_flight = now;
            stamped = stands ? stamped : reference(now + noise);
        }
    }
    void lock() {
        run(1000);
        ASSERT_EQ(servo.lock(), DcLock::locked);
        worst_correction = 0ns;
        worst_error = 0;
    }

    ReferenceClock clock;
    CycleServo servo{cycle};
    std::mt19937 random{7};
    Instant now{Duration{123'456'789}}, drift_from{};
    std::int64_t began = 5'000'000'000, drift_ppm = 50, target = 0, stamped = 0, worst_error = 0;
    std::optional<Instant> in_flight;
    Duration correction{}, worst_correction{}, jitter{};
    bool answers = true, stands = false, started = false;
};

// 50 ppm: 50 us a second, were it not for the servo.
TEST_F(Loop, HoldsThePhaseAgainst50PpmWithinNanoseconds) {
    lock();
    run(60'000);
    EXPECT_LE(worst_error, 5);
    EXPECT_LE(worst_correction, 60ns);
}

// Frames that leave up to 20 us late: the phase follows their mean, not each of them. 20 us / sqrt(12) is 5.8 us for one sample;
// the filter's memory of 256 makes it sqrt(4 / 256) of that, 0.7 us, times 5 for the worst of 10,000.
TEST_F(Loop, DoesNotFollowTheJitterOfSingleFrames) {
    jitter = 20us;
    run(2000);
    ASSERT_EQ(servo.lock(), DcLock::locked);
    worst_correction = 0ns;
    std::int64_t low = 1'000'000, high = -1'000'000;
    for (int i = 0; i < 10'000; ++i) {
        run(1);
        low = std::min(low, true_error());
        high = std::max(high, true_error());
    }
    EXPECT_LE(high - low, 7'000);
    EXPECT_LE(worst_correction, 1us);
    EXPECT_EQ(servo.lock(), DcLock::locked);
}

// The master stood for 20.3 ms: where it sends again is known at once, and 300 us are made up at 10 us a cycle.
TEST_F(Loop, MakesUpForAStallOfTheMaster) {
    lock();
    now += 19'300us;
    run(1);
    EXPECT_NEAR(static_cast<double>(true_error()), 300'000, 2'000);
    run(8);
    EXPECT_EQ(servo.lock(), DcLock::acquiring);
    run(400);
    EXPECT_EQ(servo.lock(), DcLock::locked);
    EXPECT_LE(std::abs(true_error()), 100);
    EXPECT_LE(worst_correction, 10us);
}

TEST_F(Loop, DoesNotNoticeLostFrames) {
    lock();
    for (int i = 0; i < 200; ++i) {
        answers = i % 3 != 0;
        run(1);
        EXPECT_EQ(servo.lock(), DcLock::locked);
    }
    EXPECT_LE(worst_error, 5);
}

// 400 us all at once and for good: 20 cycles of doubt, then the clock has to settle anew, then the phase is made up.
TEST_F(Loop, FollowsAJumpOfTheReferenceSlowly) {
    lock();
    began += 400'000;
    run(19);
    EXPECT_LE(worst_correction, 60ns) << "not believed yet";
    EXPECT_EQ(servo.lock(), DcLock::coasting);
    run(100);
    EXPECT_NE(servo.lock(), DcLock::locked);
    run(500);
    EXPECT_EQ(servo.lock(), DcLock::locked);
    EXPECT_LE(std::abs(true_error()), 100);
    EXPECT_LE(worst_correction, 10us);
}

// What SOEM's sample met (its cycle went from 1.0 to 0.54 ms): a time that stands still.
TEST_F(Loop, NeverRunsAwayWithAReferenceThatStandsStill) {
    lock();
    stands = true;
    run(12'000);
    EXPECT_NE(servo.lock(), DcLock::locked);
    EXPECT_LE(worst_correction, 10us);
}

// Gone for a second: the drift was known to some ppb, so the phase is off by some ns.
TEST_F(Loop, CoastsThroughASecondWithoutReference) {
    lock();
    answers = false;
    run(1000);
    EXPECT_EQ(servo.lock(), DcLock::coasting);
    EXPECT_LE(worst_error, 100);
    answers = true;
    run(2);
    EXPECT_EQ(servo.lock(), DcLock::locked);
}

TEST_F(Loop, IsLostWithAReferenceThatNeverReturnsAndKeepsItsSpeed) {
    lock();
    answers = false;
    run(10'000);
    EXPECT_EQ(servo.lock(), DcLock::lost);
    EXPECT_LE(worst_correction, 60ns);
    EXPECT_LE(worst_error, 1'000);
}

// A drift that changes by 10 ppm at once (another quartz takes over): no more than the window.
TEST_F(Loop, FollowsAChangeOfTheDrift) {
    lock();
    began = reference(now);
    drift_from = now;
    drift_ppm = 40;
    run(3000);
    EXPECT_EQ(servo.lock(), DcLock::locked);
    EXPECT_LE(worst_error, 5'000);
    EXPECT_LE(std::abs(true_error()), 10);
}

}  // namespace
}  // namespace taktwerk::ecat
