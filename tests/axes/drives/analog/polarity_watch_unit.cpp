// Whether a motor runs where it is sent, from each enabling on. Distances by hand: the watch bears 100 counts.

#include <gtest/gtest.h>

#include "axes/drives/analog/polarity_watch.hpp"
#include "axes/drives/analog/slope.hpp"

namespace taktwerk::axes::analog {
namespace {

using namespace std::chrono_literals;

TEST(PolarityWatch, StopsAMotorThatRunsAgainstItsSetpointAfterItsDistance) {
    for (const double sense : {1.0, -1.0}) {
        PolarityWatch watch(100);
        watch.begin();
        for (int i = 0; i < 10; ++i) EXPECT_FALSE(watch.step(-sense * 10, sense * 500)) << i;
        EXPECT_TRUE(watch.step(-sense, sense * 500)) << "101 counts";
        EXPECT_EQ(watch.against(), 101);
    }
}

TEST(PolarityWatch, BelievesWhoRanTheDistanceWithItsSetpoint) {
    PolarityWatch watch(100);
    watch.begin();
    EXPECT_FALSE(watch.step(100, 1));
    EXPECT_FALSE(watch.step(-1000, 1)) << "a load that drags it is not the wiring";
}

TEST(PolarityWatch, AnEnablingIsWatchedAnew) {
    PolarityWatch watch(100);
    watch.begin();
    EXPECT_FALSE(watch.step(100, 1));
    watch.begin();
    EXPECT_TRUE(watch.step(-101, 1));
}

// Forth and back at standstill, as a loop with drift does: neither proof nor runaway, however long.
TEST(PolarityWatch, NothingIsSaidOfWhatGoesForthAndBack) {
    PolarityWatch watch(100);
    watch.begin();
    for (int i = 0; i < 1000; ++i) {
        EXPECT_FALSE(watch.step(-30, 1));
        EXPECT_FALSE(watch.step(30, 1));
    }
    EXPECT_TRUE(watch.step(-101, 1)) << "it was not proven either";
}

TEST(PolarityWatch, AMotorThatIsNotSentProvesNothing) {
    PolarityWatch watch(100);
    watch.begin();
    EXPECT_FALSE(watch.step(-1000, 0));
    EXPECT_FALSE(watch.step(1000, 0));
    EXPECT_TRUE(watch.step(-101, 1));
}

// 8 samples a millisecond apart: a step of one count is 1/7 of a count a millisecond, then gone.
TEST(Slope, ACountMoreIsNoMotion) {
    Slope slope;
    Instant at{};
    EXPECT_EQ(slope.add(at, 100), 0);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(slope.add(at += 1ms, 100), 0);
    double most = 0, last = 0;
    for (int i = 0; i < 8; ++i) most = std::max(most, last = slope.add(at += 1ms, 101));
    EXPECT_NEAR(most, 1000.0 / 7, 1e-9);
    EXPECT_EQ(last, 0);
}

TEST(Slope, ASteadyMotionIsItsVelocity) {
    Slope slope;
    Instant at{};
    double velocity = 0;
    for (int i = 0; i < 30; ++i) velocity = slope.add(at += 2ms, 50 * i);
    EXPECT_NEAR(velocity, 25000, 1e-9);
    slope.clear();
    EXPECT_EQ(slope.add(at += 2ms, 0), 0) << "another zero is no motion";
}

}  // namespace
}  // namespace taktwerk::axes::analog
