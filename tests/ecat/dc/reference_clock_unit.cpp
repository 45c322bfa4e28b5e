#include "ecat/dc/reference_clock.hpp"

#include <gtest/gtest.h>

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;

/// The reference runs `offset` ahead of machine time when sampled at `sent`.
bool sample(ReferenceClock& clock, Instant sent, Duration offset) { return clock.take(sent, (sent.time_since_epoch() + offset).count()); }

TEST(ReferenceClock, KnowsNothingBeforeItsFirstSample) {
    ReferenceClock clock;
    clock.miss();
    EXPECT_FALSE(clock.offset());
    EXPECT_EQ(clock.samples(), 0u);
    EXPECT_EQ(clock.rejected(), 1u);
}

TEST(ReferenceClock, TakesTheFirstSampleAsItIs) {
    ReferenceClock clock;
    EXPECT_TRUE(sample(clock, Instant{} + 5s, -3s));
    EXPECT_EQ(clock.offset(), -3'000'000'000);
    EXPECT_EQ(clock.samples(), 1u);
}

// 20 ppm are 20 ns a millisecond. A line through exact samples is the line itself.
TEST(ReferenceClock, FollowsADriftWithoutLag) {
    ReferenceClock clock;
    Instant now{};
    for (int i = 0; i < 1000; ++i, now += 1ms) {
        ASSERT_TRUE(sample(clock, now, 1us + i * 20ns));
        ASSERT_NEAR(static_cast<double>(*clock.offset()), 1000.0 + 20 * i, 1) << i;
    }
    EXPECT_NEAR(static_cast<double>(clock.drift_ppb()), 20'000, 1);
    EXPECT_NEAR(static_cast<double>(clock.drift_in(1ms)) / ReferenceClock::fine, 20.0, 0.001);
}

// The samples stop after 1 s at 1 us + 20 us; 10 s later the offset is another 200 us on.
TEST(ReferenceClock, GoesOnWithTheLearnedDriftWhileSamplesAreMissing) {
    ReferenceClock clock;
    Instant now{};
    for (int i = 0; i <= 1000; ++i, now += 1ms) ASSERT_TRUE(sample(clock, now, 1us + i * 20ns));
    EXPECT_NEAR(static_cast<double>(clock.offset_at(Instant{} + 11s)), 221'000, 50);
}

// Samples of 3 us too much and 3 us too little in turns.
TEST(ReferenceClock, SmoothsNoise) {
    ReferenceClock clock;
    Instant now{};
    for (int i = 0; i < 2000; ++i, now += 1ms) {
        ASSERT_TRUE(sample(clock, now, 1us + (i % 2 == 0 ? 3us : -3us)));
        if (i < 256) continue;
        ASSERT_NEAR(static_cast<double>(*clock.offset()), 1000.0, 100) << i;
    }
}

TEST(ReferenceClock, IsSettledAfterAQuarterOfItsMemory) {
    ReferenceClock clock;
    Instant now{};
    for (int i = 0; i < 64; ++i, now += 1ms) {
        EXPECT_FALSE(clock.settled());
        ASSERT_TRUE(sample(clock, now, 1us));
    }
    EXPECT_TRUE(clock.settled());
}

// Two quartzes of 100 ppm are at most 200 ppm apart: a reference that seems faster than 500 ppm is not believed to be.
TEST(ReferenceClock, NeverLearnsAnImpossibleDrift) {
    ReferenceClock clock;
    Instant now{};
    for (int i = 0; i < 1000; ++i, now += 1ms) (void)sample(clock, now, i * 2us);  // 2000 ppm
    EXPECT_EQ(clock.drift_ppb(), 500'000);
}

// After 292 years of system time 64 bits are still counted right.
TEST(ReferenceClock, KeepsItsPrecisionWithLargeSystemTimes) {
    ReferenceClock clock;
    Instant now{};
    for (int i = 0; i < 300; ++i, now += 1ms) ASSERT_TRUE(clock.take(now, 9'000'000'000'000'000'000 + i * 1'000'050));
    EXPECT_NEAR(static_cast<double>(clock.drift_ppb()), 50'000, 1);
}

TEST(ReferenceClock, DoesNotBelieveASingleOutlier) {
    ReferenceClock clock;
    Instant now{};
    for (int i = 0; i < 100; ++i, now += 1ms) ASSERT_TRUE(sample(clock, now, 1us));
    EXPECT_FALSE(sample(clock, now, 1us + 101us));
    EXPECT_EQ(clock.offset(), 1000);
    EXPECT_EQ(clock.rejected(), 1u);
    EXPECT_EQ(clock.drift_ppb(), 0);
    EXPECT_TRUE(sample(clock, now + 1ms, 1us));
}

// It was power-cycled, say: 19 cycles of doubt, then its new time counts at once and completely.
TEST(ReferenceClock, BelievesAJumpThatStays) {
    ReferenceClock clock;
    Instant now{};
    for (int i = 0; i < 100; ++i, now += 1ms) ASSERT_TRUE(sample(clock, now, 1us));
    for (int i = 0; i < 19; ++i, now += 1ms) ASSERT_FALSE(sample(clock, now, 7s));
    EXPECT_TRUE(sample(clock, now, 7s));
    EXPECT_EQ(clock.offset(), 7'000'000'000);
}

TEST(ReferenceClock, ForgetsOutliersThatWereNotInARow) {
    ReferenceClock clock;
    Instant now{};
    ASSERT_TRUE(sample(clock, now, 0us));
    for (int i = 0; i < 100; ++i) {
        now += 1ms;
        ASSERT_FALSE(sample(clock, now, 7s));
        now += 1ms;
        ASSERT_TRUE(sample(clock, now, 0us));
    }
    EXPECT_EQ(clock.offset(), 0);
}

}  // namespace
}  // namespace taktwerk::ecat
