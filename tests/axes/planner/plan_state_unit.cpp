// Motions to a moving state, short enough to calculate by hand.

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "axes/planner/plan.hpp"
#include "tests/axes/planner/plan_figures.hpp"

namespace taktwerk::axes {
namespace {

const MotionLimits unit_limits{.velocity = 10, .acceleration = 1, .deceleration = 1, .jerk = 1};

TEST(PlanToState, PassesTheTargetAtItsVelocity) {
    // 0 to 2 with a = j = 1: 1 s, 1 s, 1 s over the mean 1 u/s, 3 u. That is the fastest change of velocity: it ends there.
    const Plan plan = plan_to_state({}, {3, 2, 0}, unit_limits);

    ASSERT_EQ(plan.error, PlanError::none);
    EXPECT_NEAR(plan.profile.duration(), 3, tight);
    EXPECT_EQ(plan.profile.at(plan.profile.duration()), (MotionState{3, 2, 0}));
    EXPECT_NEAR(plan.profile.at(4).position, 5, tight);  // and moves on
}

TEST(PlanToState, ATargetJustBehindAMovingStartIsApproachedAgain) {
    // At 1 u/s, the target 0 u away is met at once; 1e-3 u behind it must be passed again from below: back and round.
    const MotionState start{0, 1, 0};
    EXPECT_EQ(plan_to_state(start, {0, 1, 0}, unit_limits).profile.duration(), 0);
    EXPECT_GT(plan_to_state(start, {-1e-3, 1, 0}, unit_limits).profile.duration(), 4);
    // 1e-3 u ahead: at most the 1e-3 s that going on takes.
    EXPECT_LE(plan_to_state(start, {1e-3, 1, 0}, unit_limits).profile.duration(), 1e-3);
}

TEST(PlanToState, AccelerationOfOneSignIsKeptWhereThatIsFastest) {
    // a from 1 to 2 with j = 1: 1 s, v grows by 1.5, p by v0 + 1/2 + 1/6. Taking it away and building it up again would be slower.
    const MotionLimits limits{.velocity = 10, .acceleration = 5, .deceleration = 5, .jerk = 1};
    const Plan plan = plan_to_state({0, 1, 1}, {1 + 2.0 / 3, 2.5, 2}, limits);

    EXPECT_NEAR(plan.profile.duration(), 1, 1e-9);
    EXPECT_NEAR(plan.profile.at(0.5).acceleration, 1.5, 1e-9);
}

TEST(PlanToState, LimitsPerSignAreKeptEachOnItsSide) {
    // Up with a <= 1, down with a >= -2, no jerk limit, 12 u from rest to rest, v <= 4: 4 s over 8 u, 2 s over 4 u.
    const SignedLimits limits{{4, 1, 1, unlimited}, {9, 2, 2, unlimited}};
    const Plan plan = plan_to_state({}, {12, 0, 0}, limits);

    EXPECT_NEAR(plan.profile.duration(), 6, tight);
    EXPECT_NEAR(plan.profile.at(4).velocity, 4, tight);
    EXPECT_NEAR(plan.profile.at(5).acceleration, -2, tight);
}

TEST(PlanToState, WithoutAccelerationLimitTheVelocityJumps) {
    // 10 u at 4 u/s.
    const SignedLimits limits{MotionLimits{4, unlimited, unlimited, unlimited}};
    const Plan plan = plan_to_state({}, {10, 0, 0}, limits);

    ASSERT_EQ(plan.error, PlanError::none);
    EXPECT_NEAR(plan.profile.duration(), 2.5, tight);
    EXPECT_NEAR(plan.profile.at(1).position, 4, tight);
    EXPECT_NEAR(plan.profile.at(1).velocity, 4, tight);
    EXPECT_EQ(plan.profile.at(2.5), (MotionState{10, 0, 0}));
}

TEST(PlanToState, WithoutVelocityAndAccelerationLimitOnlyTheJerkCounts) {
    // 2 j t^3 = 2 u in 4 t.
    const Plan plan = plan_to_state({}, {2, 0, 0}, MotionLimits{unlimited, unlimited, unlimited, 1});

    EXPECT_NEAR(plan.profile.duration(), 4, tight);
}

TEST(PlanToState, EncoderCountsFarOutMoveByOneCount) {
    // 2 j t^3 = 1 count with j = 5e10: t = 1e-11^(1/3), and the same at p = 1e9.
    const MotionLimits counts{4e8, 2e9, 2e9, 5e10};
    const double t = 4 * std::cbrt(1.0 / (2 * 5e10));
    EXPECT_NEAR(plan_to_position({1e9, 0, 0}, 1e9 + 1, counts).profile.duration() / t, 1, tight);
    EXPECT_NEAR(plan_to_position({-1e9, 0, 0}, -1e9 - 1, counts).profile.duration() / t, 1, tight);
}

TEST(PlanToState, AJumpOfTheAccelerationIsNoRoundingErrorHoweverSmallItIs) {
    // Upwards there is no jerk limit. Start and target lie on one parabola of -0.21 u/s2 but for 4.2e-8 u/s2: a jump to take exactly, else the
    // motion begins at another velocity than the start's.
    const MotionState from{54.589336490690471, 1.6638484683181414, -0.21045798792946541};
    const MotionState to{54.620954324746918, 1.6598443528718785, -0.21045793374667865};
    const SignedLimits limits{{unlimited, 0.19657713275963634, 0.71994492653116149, unlimited},
                              {unlimited, 0.21045798792946541, 0.29729784701647166, 1.5592683290894588e-05}};
    const Plan plan = plan_to_state(from, to, limits);

    ASSERT_EQ(plan.error, PlanError::none);
    EXPECT_NEAR(plan.profile.at(0).velocity, from.velocity, 1e-13);
    EXPECT_NEAR(plan.profile.at(0).position, from.position, 1e-13);
    EXPECT_NEAR(plan.profile.at(1e-15).velocity, from.velocity, 1e-13);
    EXPECT_EQ(plan.profile.at(plan.profile.duration()), to);
}

TEST(PlanToState, ARiseOfTheAccelerationTakesItsTimeThoughTheVelocityDoesNotShowIt) {
    // Same place and velocity, the start's acceleration higher by 5.3e-5 u/s2: falling by that takes 5.3e-5/3643730 s or more, in which the
    // motion goes on by 4e-10 u and more: too far for the target, that has to be approached again.
    const MotionState from{0.0028727206154464178, 27.195542751017054, 5.3482711321579472e-05};
    const MotionState to{0.0028727206154464178, 27.195542751017054, 4.8808086740571001e-08};
    const SignedLimits limits{{27.195542751017054, 13967.880397946863, 13967.880397946863, 3643730.8650983591},
                              {20.149660788200141, 41180.921967568269, 41180.921967568269, 1692798.8900263209}};
    const Plan plan = plan_to_state(from, to, limits);

    ASSERT_EQ(plan.error, PlanError::none);
    EXPECT_GT(plan.profile.duration(), 27.2 / 13968);  // at least to standstill
    EXPECT_NEAR(plan.profile.at(0).acceleration, from.acceleration, 1e-18);
    EXPECT_EQ(plan.profile.at(plan.profile.duration()), to);
}

TEST(PlanToState, ATargetOutsideTheLimitsIsRefused) {
    EXPECT_EQ(plan_to_state({}, {1, 11, 0}, unit_limits).error, PlanError::target_outside_limits);
    EXPECT_EQ(plan_to_state({}, {1, 0, 2}, unit_limits).error, PlanError::target_outside_limits);
    // At the velocity limit with acceleration -1: before that the velocity was higher.
    EXPECT_EQ(plan_to_state({}, {1, 10, -1}, unit_limits).error, PlanError::target_outside_limits);
    EXPECT_EQ(plan_to_state({}, {std::nan(""), 0, 0}, unit_limits).error, PlanError::invalid_input);
    EXPECT_EQ(plan_to_state({}, {0, 0, 1e31}, unit_limits).error, PlanError::out_of_bounds);
    EXPECT_EQ(plan_to_state({}, {1, 0, 0}, MotionLimits{unlimited, unlimited, unlimited, unlimited}).error, PlanError::invalid_input);
}

TEST(PlanInTime, TheSameWayInALongerTimeIsSlower) {
    // From rest to rest 6 u in 3 + 3 s at least (to 2 u/s and back); in 60 s at one velocity of a little more than 0.1 u/s.
    EXPECT_NEAR(plan_to_position({}, 6, unit_limits).profile.duration(), 6, tight);
    EXPECT_EQ(plan_in_time({}, {6, 0, 0}, 5.9, unit_limits).error, PlanError::no_solution);
    EXPECT_NEAR(plan_in_time({}, {6, 0, 0}, 6, unit_limits).profile.max_speed(), 2, 1e-6);

    const Plan plan = plan_in_time({}, {6, 0, 0}, 60, unit_limits);
    ASSERT_EQ(plan.error, PlanError::none);
    EXPECT_NEAR(plan.profile.duration(), 60, 1e-9);
    // v (60 - 2 sqrt(v)) = 6: both ramps of 2 sqrt(v/j) at half the velocity.
    const double v = plan.profile.max_speed();
    EXPECT_NEAR(v * (60 - 2 * std::sqrt(v)), 6, 1e-9);
}

TEST(PlanInTime, AMovingTargetMayBeTooFastToWaitForAndTooSlowToComeRoundTo) {
    // At 9 of 10 u/s, 9 u ahead at 9 u/s: 1 s as it is. In 1.05 s a dip of up to (1.05/4)^2 u/s will do: 0.036 u less than 9.45. Four u ahead and 9 u/s: too near
    // to be there after 1 s, and coming round takes far longer.
    const MotionState start{0, 9, 0};
    EXPECT_EQ(plan_in_time(start, {9, 9, 0}, 1, unit_limits).error, PlanError::none);
    EXPECT_EQ(plan_in_time(start, {9.43, 9, 0}, 1.05, unit_limits).error, PlanError::none);
    EXPECT_EQ(plan_in_time(start, {4, 9, 0}, 1, unit_limits).error, PlanError::no_solution);
    EXPECT_EQ(plan_in_time(start, {9, 9, 0}, -1, unit_limits).error, PlanError::invalid_input);
}

TEST(PlanInTime, AnUnlimitedDirectionDoesNotHideThatTheTimeIsTooShort) {
    // Without a velocity limit downwards the least far motion of this time is some 1e32 u away; its rounding errors say nothing of the other
    // end of what can be reached: at most 37998.4 u/s upwards, which takes 9.2e13 s for the 3.5e18 u that braking costs first.
    const MotionState from{-140010864.90628955, -1158751.9899248963, -1137636.9373533665};
    const MotionState to{-140010864.90628955, 0, 11496.251321505601};
    const SignedLimits limits{{37998.403684232551, 137578.12656430079, 20577.614955079251, 1.7464556770239876},
                              {std::numeric_limits<double>::infinity(), 1148512.2218943115, 70913.392445067162, 1.3465549743825092}};
    const double fastest = plan_to_state(from, to, limits).profile.duration();
    EXPECT_NEAR(fastest, 3.499e18 / 37998.4, 0.01 * fastest);
    EXPECT_EQ(plan_in_time(from, to, 0.97 * fastest, limits).error, PlanError::no_solution);
}

}  // namespace
}  // namespace taktwerk::axes
