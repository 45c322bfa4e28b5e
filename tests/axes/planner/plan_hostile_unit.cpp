// Starts, ways and limits chosen to hurt: every one of them gets a finite, continuous plan that ends exactly at the target.

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include "tests/axes/planner/plan_figures.hpp"
#include "tests/axes/planner/random_motion.hpp"

namespace taktwerk::axes {
namespace {

constexpr double smallest = std::numeric_limits<double>::denorm_min();

const MotionLimits limits_to_try[] = {
    {1, 1, 1, 1},
    {1, 1, 1, unlimited},
    {1, 1, 1, 1e7},                  // jerk / acceleration 1e7
    {1, 1e-7, 1, 1},                 // creeping up, ordinary stop
    {1, 1, 1e-7, 1},                 // the other way round
    {1e9, 1e9, 1e9, 1},              // jerk so small that no other limit counts
    {1e-9, 1, 1, 1},                 // velocity reached at once
    {4e8, 2e9, 3e9, 1e12},           // encoder counts
    {PlanBounds::largest, 1, 1, 1},  // the bounds themselves
    {PlanBounds::smallest_limit, 1, 1, 1},
    {1, PlanBounds::smallest_limit, PlanBounds::largest, 1},
    {1, 1, 1, PlanBounds::smallest_limit},
    {1, 1, 1, PlanBounds::largest},
};

void expect_sound(const MotionCase& c) {
    SCOPED_TRACE(::testing::Message() << c);
    const Plan plan = plan_to_position(c.from, c.target, c.limits);
    const Profile& profile = plan.profile;

    ASSERT_EQ(plan.error, PlanError::none);
    ASSERT_TRUE(std::isfinite(profile.duration()));
    ASSERT_EQ(profile.at(profile.duration()), (MotionState{c.target, 0, 0}));

    const Rounding rounding{c, profile};
    MotionState before = c.from;
    for (int i = 0; i < profile.piece_count(); ++i) {
        const MotionState after = profile.on_piece(i, profile.piece_begin(i));
        ASSERT_NEAR(before.position, after.position, rounding.position + PlanBounds::negligible) << "piece " << i;
        ASSERT_NEAR(before.velocity, after.velocity, rounding.velocity + PlanBounds::negligible) << "piece " << i;
        before = profile.on_piece(i, profile.piece_end(i));
    }
    ASSERT_NEAR(before.position, c.target, rounding.position + PlanBounds::negligible);
    ASSERT_NEAR(before.velocity, 0, rounding.velocity + PlanBounds::negligible);
}

void try_everything() {
    for (const MotionLimits& l : limits_to_try) {
        for (double v : {0.0, smallest, 1e-300, 2e-150, 0.5 * l.velocity, l.velocity, l.velocity * (1 + eps), 3 * l.velocity}) {
            if (v > PlanBounds::largest) continue;
            for (double a : {0.0, -1e-300, 2e-150, l.acceleration, -l.acceleration, l.deceleration, -l.deceleration,
                             2 * std::min(l.acceleration, 1e9), -2 * std::min(l.deceleration, 1e9)}) {
                const double stop = stopping_distance({0, v, a}, l);
                for (double way : {0.0, smallest, -smallest, 1e-300, 2e-150, -1e-140, 1e-12, -1e-12, stop, stop * (1 + eps),
                                   stop * (1 - eps), -stop, 2 * stop, 1.0, -1.0, 1e9, -1e9}) {
                    if (std::abs(way) > PlanBounds::largest) continue;
                    expect_sound({{0, v, a}, way, l});
                    if (::testing::Test::HasFatalFailure()) return;
                }
            }
        }
    }
}

TEST(PlanHostile, EveryCombinationIsSound) { try_everything(); }

#ifdef __SSE2__
// The threads that step the machine flush subnormal numbers to zero.
TEST(PlanHostile, EveryCombinationIsSoundWithSubnormalsFlushed) {
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | 0x8040u);  // flush results to zero, read subnormals as zero
    try_everything();
    _mm_setcsr(before);
}
#endif

TEST(PlanHostile, OneUnitInTheLastPlaceOfALargePositionIsAMove) {
    const double next = std::nextafter(1e9, 2e9);
    const Plan plan = plan_to_position({1e9, 0, 0}, next, {1, 1, 1, 1});

    EXPECT_EQ(plan.profile.at(plan.profile.duration()).position, next);
    EXPECT_GT(plan.profile.duration(), 0);
}

TEST(PlanHostile, AccelerationAgainstTheWayIsTurnedRoundWithoutStopping) {
    // v = 0, a = -1, j = 1, way 10: the acceleration is given back and passes through 0 on its way up; 2 s to a = 1.
    const Profile profile = plan_to_position({0, 0, -1}, 10, {100, 1, 1, 1}).profile;

    EXPECT_EQ(profile.jerk_at(0), 1);
    EXPECT_EQ(profile.jerk_at(1.9), 1);
    EXPECT_NEAR(profile.at(1).velocity, -0.5, 1e-12);
    EXPECT_NEAR(profile.at(2).acceleration, 1, 1e-12);
}

TEST(PlanHostile, EncoderCountsAreAsGoodAsMetres) {
    // 1 m = 4e8 counts: the same motion in both units, end to end.
    const Profile metres = plan_to_position({0, 0.3, -1}, 4, {1, 5, 5, 50}).profile;
    const Profile counts = plan_to_position({0, 0.3 * 4e8, -1 * 4e8}, 4 * 4e8, {4e8, 5 * 4e8, 5 * 4e8, 50 * 4e8}).profile;

    EXPECT_NEAR(counts.duration() / metres.duration(), 1, 1e-13);
    EXPECT_NEAR(counts.at(1).position / metres.at(1).position, 4e8, 1e-4);
}

}  // namespace
}  // namespace taktwerk::axes
