// Fixed time: a solution where there is one, inside the limits, in exactly that time; and none where the fastest motion takes longer.

#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include "tests/axes/planner/plan_figures.hpp"
#include "tests/axes/planner/random_states.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes {
namespace {

void expect_arrival_inside_limits(const StateCase& c, const Profile& profile) {
    // Times are parts of the given one and known to its rounding; what that makes of a velocity adds up over the time.
    const Magnitudes most{c, profile};
    const double time = profile.duration();
    const FrameLimits l = frame_limits(c.limits);
    ASSERT_EQ(profile.at(profile.duration()), c.target);
    MotionState before = c.from;
    for (int i = 0; i <= profile.piece_count(); ++i) {
        const bool last = i == profile.piece_count();
        const MotionState after = last ? profile.end() : profile.on_piece(i, profile.piece_begin(i));
        ASSERT_NEAR(before.position, after.position, 1024 * eps * (most.position + most.velocity * time)) << "piece " << i;
        ASSERT_NEAR(before.velocity, after.velocity, 1024 * eps * most.velocity) << "piece " << i;
        if (!last) before = profile.on_piece(i, profile.piece_end(i));
    }
    const double dv = 1024 * eps * most.velocity;
    const double da = 1024 * eps * most.acceleration;
    for_extremes(profile, [&](const MotionState& s, int i) {
        ASSERT_LE(s.velocity, l.up.velocity + dv) << "piece " << i;
        ASSERT_GE(s.velocity, -l.down.velocity - dv) << "piece " << i;
        ASSERT_LE(s.acceleration, std::max(l.up.speeding_up, l.up.slowing_down) + da) << "piece " << i;
        ASSERT_GE(s.acceleration, -std::max(l.down.speeding_up, l.down.slowing_down) - da) << "piece " << i;
        ASSERT_LE(profile.piece_jerk(i), std::isinf(l.up.jerk) ? 0 : l.up.jerk * (1 + 1e-12)) << "piece " << i;
        ASSERT_GE(profile.piece_jerk(i), std::isinf(l.down.jerk) ? 0 : -l.down.jerk * (1 + 1e-12)) << "piece " << i;
    });
}

/// Of a way that the positions leave open both take what suits them.
bool fast_enough_from_next_to(const StateCase& c, double time) {
    for (double ulps = -4; ulps <= 4; ulps += 0.25) {
        MotionState from = c.from;
        from.position += ulps * eps * std::max(std::abs(c.from.position), std::abs(c.target.position));
        if (plan_to_state(from, c.target, c.limits).profile.duration() <= time * (1 + 1e-7)) return true;
    }
    return false;
}

/// Starts inside limits that are finite, jerk included.
bool is_plain(const StateCase& c) {
    const FrameLimits l = frame_limits(c.limits);
    for (const SignLimits* s : {&c.limits.positive, &c.limits.negative})
        if (std::isinf(s->jerk) || std::isinf(s->speeding_up) || std::isinf(s->slowing_down)) return false;
    return is_inside(c.from.velocity, c.from.acceleration, l, 0) && keeps_limits(c.from.velocity, c.from.acceleration, l, 0);
}

TEST(PlanInTimeProperty, EveryTimeAtRestFromTheFastestOnHasASolution) {
    RandomStates random{1};
    std::size_t solved = 0;
    const std::size_t cases = property_cases(30'000);
    for (std::size_t i = 0; i < cases && !HasFailure(); ++i) {
        StateCase c = random.next();
        if (!is_plain(c) || !frame_limits(c.limits).convex()) continue;
        c.target.velocity = c.target.acceleration = 0;  // then every longer time will do
        const double fastest = plan_to_state(c.from, c.target, c.limits).profile.duration();
        const double time = fastest * (1 + random.numbers().decades(-6, 1));
        SCOPED_TRACE(::testing::Message() << "case " << i << " in " << time << " fastest " << fastest << " " << c);
        const Plan plan = plan_in_time(c.from, c.target, time, c.limits);
        ASSERT_EQ(plan.error, PlanError::none);
        ASSERT_NEAR(plan.profile.duration(), time, 1e-9 * time);
        expect_arrival_inside_limits(c, plan.profile);
        ++solved;
    }
    EXPECT_GT(solved, 3'000u);
}

TEST(PlanInTimeProperty, AnyMovingEndIsReachedInTheFastestTimeAndNotSooner) {
    RandomStates random{2};
    std::size_t solved = 0, refused = 0;
    const std::size_t cases = property_cases(30'000);
    for (std::size_t i = 0; i < cases && !HasFailure(); ++i) {
        const StateCase c = random.next();
        if (!is_plain(c)) continue;
        const double fastest = plan_to_state(c.from, c.target, c.limits).profile.duration();
        const double time = fastest * random.numbers().uniform(0.9, 3);
        SCOPED_TRACE(::testing::Message() << "case " << i << " in " << time << " fastest " << fastest << " " << c);
        const Plan plan = plan_in_time(c.from, c.target, time, c.limits);
        if (plan.error != PlanError::none) {
            ASSERT_EQ(plan.error, PlanError::no_solution);
            ++refused;
            continue;
        }
        ASSERT_TRUE(time >= fastest * (1 - 1e-7) || fast_enough_from_next_to(c, time));
        ASSERT_NEAR(plan.profile.duration(), time, 1e-9 * time);
        expect_arrival_inside_limits(c, plan.profile);
        ++solved;
    }
    EXPECT_GT(solved, 3'000u);
    EXPECT_GT(refused, 500u);
}

}  // namespace
}  // namespace taktwerk::axes
