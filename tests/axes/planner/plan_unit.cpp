// Motions short enough to calculate by hand. Rest to rest over a way w: the acceleration takes v/a + a/j where the acceleration limit is
// reached and 2 sqrt(v/j) where it is not; while it lasts the mean velocity is v/2.

#include "axes/planner/plan.hpp"
#include "tests/axes/planner/plan_figures.hpp"

#include <cmath>
#include <limits>
#include <type_traits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace taktwerk::axes {
namespace {

static_assert(std::is_trivially_copyable_v<Profile>);
static_assert(noexcept(plan_to_position({}, 0, {})));

void expect_state(const MotionState& actual, const MotionState& expected) {
    EXPECT_NEAR(actual.position, expected.position, tight);
    EXPECT_NEAR(actual.velocity, expected.velocity, tight);
    EXPECT_NEAR(actual.acceleration, expected.acceleration, tight);
}

TEST(PlanToPosition, ReachesVelocityAndBothAccelerations) {
    // Up: 10/20 + 20/200 = 0.6 s over 3 u; down: 10/40 + 40/200 = 0.45 s over 2.25 u; the other 4.75 u take 0.475 s.
    const Plan plan = plan_to_position({}, 10, {.velocity = 10, .acceleration = 20, .deceleration = 40, .jerk = 200});

    ASSERT_EQ(plan.error, PlanError::none);
    EXPECT_NEAR(plan.profile.duration(), 1.525, tight);
    EXPECT_EQ(plan.profile.piece_count(), 7);
    EXPECT_NEAR(plan.profile.max_speed(), 10, tight);
    expect_state(plan.profile.at(0.1), {200 * 0.001 / 6, 1, 20});
    expect_state(plan.profile.at(0.6), {3, 10, 0});
    expect_state(plan.profile.at(1.075), {7.75, 10, 0});
    expect_state(plan.profile.at(1.275), {7.75 + 2 - 200 * 0.008 / 6, 6, -40});
}

TEST(PlanToPosition, ReachesAccelerationButNotVelocity) {
    // With a = d = j = 1 the way is v (v + 1): 6 for v = 2. Twice 2 + 1 s.
    const Plan plan = plan_to_position({}, 6, {.velocity = 10, .acceleration = 1, .deceleration = 1, .jerk = 1});

    EXPECT_NEAR(plan.profile.duration(), 6, tight);
    EXPECT_NEAR(plan.profile.max_speed(), 2, tight);
    expect_state(plan.profile.at(3), {3, 2, 0});
}

TEST(PlanToPosition, ReachesVelocityButNotAcceleration) {
    // 2 sqrt(1/1) = 2 s over 1 u, up and down; 3 u at velocity 1.
    const Plan plan = plan_to_position({}, 5, {.velocity = 1, .acceleration = 10, .deceleration = 10, .jerk = 1});

    EXPECT_NEAR(plan.profile.duration(), 7, tight);
    expect_state(plan.profile.at(1), {1.0 / 6, 0.5, 1});
    expect_state(plan.profile.at(2), {1, 1, 0});
}

TEST(PlanToPosition, ReachesNoLimit) {
    // Four stretches of equal length t, way 2 j t^3: t = 1.
    const Plan plan = plan_to_position({}, 2, {.velocity = 10, .acceleration = 10, .deceleration = 10, .jerk = 1});

    EXPECT_NEAR(plan.profile.duration(), 4, tight);
    expect_state(plan.profile.at(1), {1.0 / 6, 0.5, 1});
    expect_state(plan.profile.at(2), {1, 1, 0});
    expect_state(plan.profile.at(3), {2 - 1.0 / 6, 0.5, -1});
}

TEST(PlanToPosition, ReachesOnlyTheDeceleration) {
    // j = 1, d = 0.5, speed v = 1: up 2 s over 1 u; down 1/0.5 + 0.5/1 = 2.5 s over 1.25 u.
    const Plan plan = plan_to_position({}, 2.25, {.velocity = 10, .acceleration = 10, .deceleration = 0.5, .jerk = 1});

    EXPECT_NEAR(plan.profile.duration(), 4.5, tight);
    EXPECT_NEAR(plan.profile.max_speed(), 1, tight);
}

TEST(PlanToPosition, TinyMoveTakesFourCubeRoots) {
    // Way 2 j t^3 = 2e-27: t = 1e-9.
    const Plan plan = plan_to_position({}, 2e-27, {.velocity = 10, .acceleration = 10, .deceleration = 10, .jerk = 1});

    EXPECT_NEAR(plan.profile.duration() / 4e-9, 1, tight);
    EXPECT_EQ(plan.profile.end().position, 2e-27);
}

TEST(PlanToPosition, NegativeWayIsTheMirrorImage) {
    const MotionLimits limits{.velocity = 10, .acceleration = 20, .deceleration = 40, .jerk = 200};
    const Profile there = plan_to_position({1, 2, 3}, 9, limits).profile;
    const Profile back = plan_to_position({-1, -2, -3}, -9, limits).profile;

    EXPECT_EQ(there.duration(), back.duration());
    EXPECT_EQ(there.at(0.5).position, -back.at(0.5).position);
}

TEST(PlanToPosition, NoWayTakesNoTime) {
    const Plan plan = plan_to_position({7, 0, 0}, 7, {1, 1, 1, 1});

    EXPECT_EQ(plan.profile.duration(), 0);
    EXPECT_EQ(plan.profile.at(0), (MotionState{7, 0, 0}));
    EXPECT_EQ(plan.profile.at(5), (MotionState{7, 0, 0}));
}

TEST(PlanToPosition, TargetAtTheEndOfTheStopIsTheStop) {
    // From velocity 1 with j = 1: 1 s down to a = -1, 1 s back, over 1 u.
    const Plan plan = plan_to_position({0, 1, 0}, 1, {.velocity = 2, .acceleration = 9, .deceleration = 9, .jerk = 1});

    EXPECT_NEAR(plan.profile.duration(), 2, tight);
    EXPECT_EQ(plan.profile.piece_count(), 2);
}

TEST(PlanToPosition, TooFastPassesTheTargetAndReturns) {
    // Without jerk: from 2 at d = 1 the stop takes 2 s and 2 u. Back 1 u with a = 2, d = 1: v^2 (1/4 + 1/2) = 1, time v/2 + v.
    const Plan plan = plan_to_position({0, 2, 0}, 1, {.velocity = 9, .acceleration = 2, .deceleration = 1, .jerk = unlimited});

    EXPECT_NEAR(plan.profile.duration(), 2 + 1.5 * std::sqrt(4.0 / 3), tight);
    expect_state(plan.profile.at(2), {2, 0, -2});
}

TEST(PlanToPosition, TooFastWithJerkPassesTheTargetWithoutStoppingBetweenTheLegs) {
    // j = 1, no other limit reached, from velocity 1 back to where it started: push down for s, up for m, down for e. The
    // acceleration ends at 0 if m = s + e; the velocity ends at 0 if the three parabolas add up.
    const MotionLimits limits{.velocity = 9, .acceleration = 9, .deceleration = 9, .jerk = 1};
    const Profile profile = plan_to_position({0, 1, 0}, 0, limits).profile;

    ASSERT_EQ(profile.piece_count(), 3);
    const double s = profile.piece_end(0);
    const double m = profile.piece_end(1) - s;
    const double e = profile.duration() - m - s;
    EXPECT_NEAR(s + e, m, tight);
    EXPECT_NEAR(1 - s * s / 2 - s * m + m * m / 2 + (m - s) * e - e * e / 2, 0, tight);
    EXPECT_EQ(profile.at(profile.duration()), (MotionState{0, 0, 0}));
    // Where it turns round it does not rest.
    EXPECT_LT(profile.at(s).acceleration, 0);
}

TEST(PlanToPosition, AboveTheVelocityLimitBrakesIntoItFirst) {
    // From 2 to 1 with j = 1: 2 s over 3 u; 6 u at 1; 2 s over 1 u.
    const Plan plan = plan_to_position({0, 2, 0}, 10, {.velocity = 1, .acceleration = 9, .deceleration = 9, .jerk = 1});

    EXPECT_NEAR(plan.profile.duration(), 10, tight);
    expect_state(plan.profile.at(2), {3, 1, 0});
    expect_state(plan.profile.at(8), {9, 1, 0});
}

TEST(PlanToPosition, AboveTheAccelerationLimitTakesItAwayWithFullJerk) {
    // a = 3 above the limit 1 with j = 1: 2 s to the limit, then as usual.
    const Profile profile = plan_to_position({0, 0, 3}, 1000, {.velocity = 50, .acceleration = 1, .deceleration = 1, .jerk = 1}).profile;

    EXPECT_EQ(profile.jerk_at(0), -1);
    expect_state(profile.at(2), {0 + 3 * 2 - 8.0 / 6 + 0, 4, 1});
    EXPECT_EQ(profile.jerk_at(2.5), 0);
}

TEST(PlanToVelocity, ReversalSwapsDecelerationForASmallerAcceleration) {
    // 8 to -8 with j = 1, d = 2, a = 1. Slowing: build 2 s (2 u/s), hold 2.25 s at 2, give back to 1 in 1 s (1.5 u/s): velocity 0 at
    // 5.25 s with acceleration -1. Speeding up: 7.5 s at 1, 1 s to 0.
    const Profile profile = plan_to_velocity({0, 8, 0}, -8, {.velocity = 8, .acceleration = 1, .deceleration = 2, .jerk = 1}).profile;

    EXPECT_NEAR(profile.duration(), 13.75, tight);
    EXPECT_NEAR(profile.at(5.25).velocity, 0, tight);
    EXPECT_NEAR(profile.at(5.25).acceleration, -1, tight);
    EXPECT_NEAR(profile.at(4.25).acceleration, -2, tight);
    EXPECT_NEAR(profile.at(12.75).acceleration, -1, tight);
}

TEST(PlanToVelocity, ReversalSwapsDecelerationForALargerAcceleration) {
    // The same with d = 1, a = 2, the other way round: velocity 0 after 1 + 7.5 s, then 1 s to 2, 2.25 s, 2 s.
    const Profile profile = plan_to_velocity({0, 8, 0}, -8, {.velocity = 8, .acceleration = 2, .deceleration = 1, .jerk = 1}).profile;

    EXPECT_NEAR(profile.duration(), 13.75, tight);
    EXPECT_NEAR(profile.at(8.5).velocity, 0, tight);
    EXPECT_NEAR(profile.at(8.5).acceleration, -1, tight);
    EXPECT_NEAR(profile.at(9.5).acceleration, -2, tight);
}

TEST(PlanToVelocity, MovesOnAtTheTargetVelocity) {
    const Profile profile = plan_to_velocity({5, 0, 0}, -2, {.velocity = 3, .acceleration = 2, .deceleration = 2, .jerk = 2}).profile;

    // 2/2 + 2/2 = 2 s at a mean of 1.
    EXPECT_NEAR(profile.duration(), 2, tight);
    EXPECT_EQ(profile.at(2).velocity, -2);
    EXPECT_EQ(profile.at(2).acceleration, 0);
    EXPECT_NEAR(profile.at(12).position, 5 - 2 - 20, tight);
    EXPECT_EQ(profile.at(1e6).velocity, -2);
}

TEST(PlanToVelocity, WithoutJerkLimitTheAccelerationJumps) {
    const Profile profile =
        plan_to_velocity({0, 4, 1}, -4, {.velocity = 8, .acceleration = 1, .deceleration = 2, .jerk = unlimited}).profile;

    EXPECT_NEAR(profile.duration(), 4.0 / 2 + 4.0 / 1, tight);
    expect_state(profile.at(1), {4 - 1, 2, -2});
    expect_state(profile.at(3), {4 - 0.5, -1, -1});
    EXPECT_EQ(profile.at(6), (MotionState{profile.end().position, -4, 0}));
}

TEST(PlanToPosition, WithoutJerkLimitTheWayIsATrapezoid) {
    // v = 2: 1 s over 1 u up (a = 2), 2 s over 2 u down (d = 1), 7 u at 2.
    const Profile profile =
        plan_to_position({0, 0, 0}, 10, {.velocity = 2, .acceleration = 2, .deceleration = 1, .jerk = unlimited}).profile;

    EXPECT_NEAR(profile.duration(), 1 + 3.5 + 2, tight);
    expect_state(profile.at(0.5), {0.25, 1, 2});
    expect_state(profile.at(3), {5, 2, 0});
    expect_state(profile.at(5.5), {9.5, 1, -1});
    EXPECT_EQ(profile.at(6.5), (MotionState{10, 0, 0}));
}

TEST(PlanStop, AccelerationStillPushingIsTakenAwayFirst) {
    // v = 0.5, a = 1, j = 1: 2 s from a = 1 to a = -1 (velocity 0.5 again), 1 s to rest.
    // Way: 0.5*2 + 1*2 - 8/6 in the first, 0.5 - 0.5 + 1/6 in the second.
    const MotionLimits limits{.velocity = 9, .acceleration = 9, .deceleration = 9, .jerk = 1};
    const Profile profile = plan_stop({0, 0.5, 1}, limits).profile;

    EXPECT_NEAR(profile.duration(), 3, tight);
    EXPECT_NEAR(profile.end().position, 3 - 8.0 / 6 + 1.0 / 6, tight);
    EXPECT_NEAR(stopping_distance({0, 0.5, 1}, limits), 11.0 / 6, tight);
}

TEST(PlanStop, AtTheDecelerationLimit) {
    // v = 10, d = 2, j = 1: 2 s, 3 s, 2 s; symmetric, so half the velocity times the time.
    EXPECT_NEAR(stopping_distance({0, 10, 0}, {.velocity = 10, .acceleration = 1, .deceleration = 2, .jerk = 1}), 5 * 7, tight);
    EXPECT_NEAR(stopping_distance({3, -10, 0}, {.velocity = 10, .acceleration = 1, .deceleration = 2, .jerk = 1}), -5 * 7, tight);
}

TEST(PlanStop, RestIsAlreadyStopped) {
    const Plan plan = plan_stop({4, 0, 0}, {1, 1, 1, 1});

    EXPECT_EQ(plan.profile.duration(), 0);
    EXPECT_EQ(plan.profile.end(), (MotionState{4, 0, 0}));
}

TEST(PlanErrors, BadInputIsRefusedAndTheProfileStaysFinite) {
    const MotionLimits good{1, 1, 1, 1};
    const double nan = std::numeric_limits<double>::quiet_NaN();

    for (const MotionLimits& bad :
         {MotionLimits{0, 1, 1, 1}, MotionLimits{1, -1, 1, 1}, MotionLimits{1, 1, 0, 1}, MotionLimits{1, 1, 1, 0},
          MotionLimits{nan, 1, 1, 1}, MotionLimits{1, 1, 1, nan}, MotionLimits{unlimited, unlimited, unlimited, unlimited}}) {
        EXPECT_EQ(plan_to_position({}, 1, bad).error, PlanError::invalid_input);
        EXPECT_EQ(plan_to_velocity({}, 1, bad).error, PlanError::invalid_input);
        EXPECT_EQ(plan_stop({}, bad).error, PlanError::invalid_input);
        EXPECT_TRUE(std::isnan(stopping_distance({}, bad)));
    }
    EXPECT_EQ(plan_to_position({nan, 0, 0}, 1, good).error, PlanError::invalid_input);
    EXPECT_EQ(plan_to_position({}, nan, good).error, PlanError::invalid_input);
    EXPECT_EQ(plan_to_position({}, unlimited, good).error, PlanError::invalid_input);
    EXPECT_EQ(plan_to_position({}, 1e31, good).error, PlanError::out_of_bounds);
    EXPECT_EQ(plan_to_position({}, 1, {1, 1, 1e-31, 1}).error, PlanError::out_of_bounds);
    EXPECT_EQ(plan_to_position({}, 1, {1, 1e31, 1, 1}).error, PlanError::out_of_bounds);
    EXPECT_EQ(plan_to_position({}, 1, {1, 1, 1, 1e31}).error, PlanError::out_of_bounds);
    EXPECT_EQ(plan_to_velocity({}, 1.5, good).error, PlanError::out_of_bounds);
    EXPECT_EQ(plan_to_position({3, 0, 0}, unlimited, good).profile.at(1).position, 3);
}

// 10 u at 2 u/s with 1 u/s2: top speed until 5 s, then down to 0 at 7 s.
TEST(PlannedProfile, TheTopVelocityFromATimeOnForgetsWhatIsOver) {
    const auto profile = plan_to_position({}, 10, MotionLimits{2, 1, 1, std::numeric_limits<double>::infinity()}).profile;
    EXPECT_NEAR(profile.top_velocity(1), 2, 1e-12);
    EXPECT_NEAR(profile.top_velocity(1, 5), 2, 1e-12);
    EXPECT_NEAR(profile.top_velocity(1, 6), 1, 1e-12);
    EXPECT_NEAR(profile.top_velocity(1, 6.5), 0.5, 1e-12);
    EXPECT_EQ(profile.top_velocity(1, 9), 0);
    EXPECT_EQ(profile.top_velocity(-1, 6), 0);
}

}  // namespace
}  // namespace taktwerk::axes
