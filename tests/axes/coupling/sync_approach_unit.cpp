// The way to a sync point, which of several points is taken, the shift of phasing, and masters that are measured.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "axes/coupling/master_track.hpp"
#include "axes/coupling/phase_shift.hpp"
#include "axes/coupling/sync_approach.hpp"

namespace taktwerk::axes {
namespace {

using namespace std::chrono_literals;

// x^5 from 1 to 3, as a way of length 2.
TEST(SyncApproach, IsThePolynomialOfFifthOrderThroughBothStates) {
    SyncApproach approach;
    approach.set({0, 4}, 10, 2, {1, 5, 20}, {243, 405, 540});
    const auto middle = approach.at({{0, 5}, 3, 7});  // x = 2, master 3 u/s and 7 u/s2
    EXPECT_NEAR(middle.position, 32, 1e-11);
    EXPECT_NEAR(middle.velocity, 80 * 3, 1e-10);
    EXPECT_NEAR(middle.acceleration, 80 * 7 + 160 * 9, 1e-9);
    EXPECT_FALSE(approach.passed({0, 5.99}));
    EXPECT_TRUE(approach.passed({1, -4}));
    EXPECT_NEAR(approach.at({{0, 3}, 3, 0}).position, 1 - 5, 1e-12);  // before the start: the tangent
    EXPECT_NEAR(approach.peaks(2).velocity, 810, 1e-9);
    EXPECT_NEAR(approach.peaks(2).acceleration, 540 * 4, 1e-8);
}

TEST(SyncApproach, RunsBackwardsToo) {
    SyncApproach approach;
    approach.set({0, 0}, 10, -2, {0, 0, 0}, {-1, 1, 0});
    // Half way: -10/8 + 15/16 - 6/32 of the position, and (4/8 - 7/16 + 3/32) * 2 of the slope.
    EXPECT_NEAR(approach.at({{0, -1}, -1, 0}).position, -1.25 + 0.9375 - 0.1875 + 0.3125, 1e-12);
    EXPECT_FALSE(approach.passed({0, -1.9}));
    EXPECT_TRUE(approach.passed({0, -2}));
    const auto end = approach.at({{0, -2}, -5, 0});
    EXPECT_NEAR(end.position, -1, 1e-12);
    EXPECT_NEAR(end.velocity, -5, 1e-12);
}

TEST(SyncApproach, AMotionBecomesACurveByTheMastersVelocity) {
    const auto curve = as_curve({{}, 6, 10}, 2, 3, 1);
    EXPECT_EQ(curve.position, 2);
    EXPECT_EQ(curve.slope, 2);
    EXPECT_NEAR(curve.curvature, (10 - 2 * 1) / 9.0, 1e-15);
    EXPECT_EQ(as_curve({{}, 6, 0}, 2, 0, 0).slope, 0);  // the master stands
}

// Images of 100 on a turn of 360, from where the slave would come to (P1, figure 46).
// P1-288
TEST(SyncApproach, ImagesAheadBehindAndNearest) {
    EXPECT_EQ(choose_image(100, 360, 800, 1, mcCatchUp), 820);
    EXPECT_EQ(choose_image(100, 360, 800, 1, mcSlowDown), 460);
    EXPECT_EQ(choose_image(100, 360, 800, 1, mcShortest), 820);
    EXPECT_EQ(choose_image(100, 360, 500, 1, mcShortest), 460);
    EXPECT_EQ(choose_image(100, 360, -500, -1, mcCatchUp), -620);
    EXPECT_EQ(choose_image(100, 360, -500, -1, mcSlowDown), -260);
    EXPECT_EQ(choose_image(100, 0, -500, -1, mcSlowDown), 100);
}

// The first sync point farther away than the start distance; a nearer one is skipped.
// P1-288
TEST(SyncApproach, ANearSyncPointOfAModuloMasterIsSkipped) {
    EXPECT_EQ(choose_sync_point(90, 360, 20, 50, 1), 90);
    EXPECT_EQ(choose_sync_point(90, 360, 50, 50, 1), 450);
    EXPECT_EQ(choose_sync_point(90, 360, 1000, 50, 1), 1170);
    EXPECT_EQ(choose_sync_point(90, 360, 100, 5, -1), 90);
    EXPECT_EQ(choose_sync_point(90, 360, 94, 5, -1), -270);
    EXPECT_EQ(choose_sync_point(90, 0, 1000, 50, 1), 90);
}

// 10 u at 1000 u/s2 without jerk limit: up in 0.1 s to 100 u/s and down again.
// P1-294
TEST(PhaseShift, GoesWithItsOwnDynamicsAndStays) {
    PhaseShift shift;
    const MotionLimits limits{200, 1000, 1000, std::numeric_limits<double>::infinity()};
    ASSERT_TRUE(shift.begin(10, limits));
    for (int i = 0; i < 100; ++i) shift.advance(1ms);
    EXPECT_NEAR(shift.state().position, 5, 1e-9);
    EXPECT_NEAR(shift.state().velocity, 100, 1e-6);
    for (int i = 0; i < 101; ++i) shift.advance(1ms);
    EXPECT_FALSE(shift.running());
    EXPECT_EQ(shift.state(), (MotionState{10, 0, 0}));
    ASSERT_TRUE(shift.begin(25, limits));
    shift.advance(1s);
    EXPECT_EQ(shift.state().position, 25);
    EXPECT_EQ(shift.covered(), 15);
}

MasterTrack::Reading reading(double position, double velocity) {
    return {.motion = {{0, position}, velocity, 0}, .usable = true, .planned = false, .feed = 10, .largest_velocity = 100};
}

TEST(MasterTrack, SetPointsComeAsTheyAre) {
    MasterTrack track;
    auto in = reading(3, 4);
    in.planned = true;
    in.motion.acceleration = 5;
    in.age = 1;
    ASSERT_TRUE(track.next(in, 0.001));
    EXPECT_EQ(track.motion().place.local, 3);
    EXPECT_EQ(track.motion().velocity, 4);
    EXPECT_EQ(track.motion().acceleration, 5);
}

// At constant velocity the filter does not lag, and the dead time is made up.
TEST(MasterTrack, AMeasuredMasterIsExtrapolatedOverTheDeadTime) {
    MasterTrack track;
    for (int i = 0; i < 400; ++i) {
        auto in = reading(0.05 * i, 0);  // 50 u/s; its own velocity is not used
        in.age = 0.003;
        ASSERT_TRUE(track.next(in, 0.001));
    }
    EXPECT_NEAR(track.motion().velocity, 50, 1e-6);
    EXPECT_NEAR(track.motion().place.local, 0.05 * 399 + 50 * 0.003, 1e-7);
}

TEST(MasterTrack, NoiseIsDampedAndGapsAreBridged) {
    MasterTrack track;
    std::mt19937 random(3);
    double worst = 0, raw = 0, last = 0, last_raw = 0;
    for (int i = 0; i < 2000; ++i) {
        const double noise = (static_cast<double>(random() % 2001) - 1000) * 1e-5;  // +-0.01 u
        auto in = reading(0.02 * i + noise, 0);
        in.fresh = i % 50 != 7 && i % 50 != 8;
        in.age = i % 50 == 7 ? 0.001 : i % 50 == 8 ? 0.002 : 0;
        ASSERT_TRUE(track.next(in, 0.001));
        const double seen = track.motion().place.local;
        if (i > 300)
            worst = std::max(worst, std::abs(seen - last - 0.02)), raw = std::max(raw, std::abs(in.motion.place.local - last_raw - 0.02));
        last = seen;
        last_raw = in.motion.place.local;
    }
    EXPECT_LT(worst, raw / 2);
    EXPECT_NEAR(last, 0.02 * 1999, 0.01);
}

TEST(MasterTrack, AJumpOrNoPositionIsTheEnd) {
    MasterTrack track;
    ASSERT_TRUE(track.next(reading(0, 0), 0.001));
    ASSERT_TRUE(track.next(reading(0.19, 0), 0.001));  // 190 u/s: not nice, but possible
    EXPECT_FALSE(track.next(reading(0.4, 0), 0.001));  // 210 u/s
    MasterTrack other;
    auto gone = reading(0, 0);
    ASSERT_TRUE(other.next(gone, 0.001));
    gone.usable = false;
    EXPECT_FALSE(other.next(gone, 0.001));
}

}  // namespace
}  // namespace taktwerk::axes
