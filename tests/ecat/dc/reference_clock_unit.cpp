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

// 20 ppm are 20 ns a millisecond, 20 us a second.
TEST(ReferenceClock, MeasuresTheDriftOverASecond) {
    ReferenceClock clock;
    Instant now{};
    for (int i = 0; i < 3000; ++i, now += 1ms) ASSERT_TRUE(sample(clock, now, 1us + i * 20ns));
    EXPECT_NEAR(static_cast<double>(clock.drift_ppb()), 20'000, 20);
}

TEST(ReferenceClock, DoesNotBelieveASingleOutlier) {
    ReferenceClock clock;
    Instant now{};
    for (int i = 0; i < 100; ++i, now += 1ms) ASSERT_TRUE(sample(clock, now, 1us));
    EXPECT_FALSE(sample(clock, now, 1us + 101us));
    EXPECT_EQ(clock.offset(), 1000);
    EXPECT_EQ(clock.rejected(), 1u);
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
