// The reachability primitives against the planner: what they call reachable the planner reaches, and nothing more.

#include "axes/planner/reach.hpp"

#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include "tests/axes/planner/random_states.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes {
namespace {

constexpr std::size_t reach_cases = 20'000;

double finite_velocity(const StateCase& c, double sign) {
    const double limit = sign > 0 ? c.limits.positive.velocity : c.limits.negative.velocity;
    return std::isinf(limit) ? 1e30 : limit;
}

/// Way of the fastest change of velocity, and what it is known to. A velocity is known to its rounding, and the time that the last bit
/// of a velocity takes is itself over the acceleration, or its square root over the jerk's.
struct Way {
    double way = 0;
    double known_to = 0;
};
Way way_to_velocity(double v, double a, double to, const SignedLimits& limits) {
    const Profile profile = plan_to_velocity({0, v, a}, to, limits).profile;
    const double gentlest = std::min(limits.positive.jerk, limits.negative.jerk);
    const double last_bit =
        std::isinf(gentlest) ? 0 : std::sqrt(8 * std::numeric_limits<double>::epsilon() * profile.max_speed() / gentlest);
    const double least =
        std::min({limits.positive.speeding_up, limits.positive.slowing_down, limits.negative.speeding_up, limits.negative.slowing_down});
    const double last_gain = 8 * std::numeric_limits<double>::epsilon() * profile.max_speed() / least;
    return {profile.end().position, profile.max_speed() * (1e-9 * profile.duration() + 2 * last_bit + last_gain)};
}

TEST(ReachProperty, ReachableVelocityUsesUpTheDistanceOrIsTheLimit) {
    RandomStates random{1};
    std::size_t used_up = 0;
    for (std::size_t i = 0; i < property_cases(reach_cases) && !HasFailure(); ++i) {
        const StateCase c = random.next();
        const double distance = c.target.position - c.from.position;
        const double sign = distance < 0 ? -1 : 1;
        SCOPED_TRACE(::testing::Message() << "case " << i << " " << c);
        const double v = highest_reachable_velocity(distance, c.from.velocity, c.from.acceleration, c.limits);
        if (std::isnan(v) || std::isinf(v)) continue;
        const Way way = way_to_velocity(c.from.velocity, c.from.acceleration, v, c.limits);
        ASSERT_LE(sign * way.way, sign * distance + way.known_to);
        if (sign * v >= finite_velocity(c, sign) * (1 - 2e-6)) continue;  // next to the limit
        const Way more = way_to_velocity(c.from.velocity, c.from.acceleration, v + sign * std::abs(v) * 1e-6, c.limits);
        ASSERT_GE(sign * more.way, sign * distance - more.known_to);
        ++used_up;
    }
    EXPECT_GT(used_up, reach_cases / 10);
}

TEST(ReachProperty, EntryVelocityJustReachesTheEndVelocity) {
    RandomStates random{2};
    std::size_t used_up = 0;
    for (std::size_t i = 0; i < property_cases(reach_cases) && !HasFailure(); ++i) {
        const StateCase c = random.next();
        const double distance = c.target.position - c.from.position;
        const double sign = distance < 0 ? -1 : 1;
        const double end = random.numbers().one_of(2) == 0 ? 0 : c.target.velocity;
        SCOPED_TRACE(::testing::Message() << "case " << i << " end " << end << " " << c);
        const double v = highest_entry_velocity(distance, end, c.limits);
        if (std::isnan(v) || std::isinf(v)) continue;
        const Way way = way_to_velocity(v, 0, end, c.limits);
        ASSERT_LE(sign * way.way, sign * distance + way.known_to);
        if (sign * v >= finite_velocity(c, sign) * (1 - 2e-6)) continue;  // next to the limit
        const Way more = way_to_velocity(v + sign * std::abs(v) * 1e-6, 0, end, c.limits);
        ASSERT_GE(sign * more.way, sign * distance - more.known_to);
        ++used_up;
    }
    EXPECT_GT(used_up, reach_cases / 10);
}

TEST(ReachProperty, StoppingIsThePlainStop) {
    // v = 10, d = 2, j = 1: 2 s to build the deceleration up, 3 s, 2 s; symmetric, so half the velocity times the time.
    const SignedLimits limits{MotionLimits{10, 1, 2, 1}};
    EXPECT_NEAR(stopping(10, 0, limits).time, 7, 1e-12);
    EXPECT_NEAR(stopping(10, 0, limits).distance, 35, 1e-12);
    EXPECT_NEAR(highest_entry_velocity(35, 0, limits), 10, 1e-12);
    EXPECT_TRUE(std::isnan(stopping(std::nan(""), 0, limits).time));
}

// With a = d = j = 1 from rest: v (v + 1)/2 for the way to velocity v >= 1, so 3 u for 2 u/s, and 5 to come from there to 1 is
// symmetric about the mean 1.5 over 2 s: 3 u.
TEST(ReachProperty, HandCalculatedVelocities) {
    const SignedLimits limits{MotionLimits{100, 1, 1, 1}};
    EXPECT_NEAR(highest_reachable_velocity(3, 0, 0, limits), 2, 1e-12);
    EXPECT_NEAR(highest_reachable_velocity(-3, 0, 0, limits), -2, 1e-12);
    EXPECT_NEAR(highest_entry_velocity(3, 0, limits), 2, 1e-12);
    EXPECT_NEAR(highest_entry_velocity(3, 1, limits), 2, 1e-12);
    EXPECT_EQ(highest_reachable_velocity(1e9, 0, 0, limits), 100);
    EXPECT_TRUE(std::isnan(highest_reachable_velocity(0.1, 5, 1, limits)));  // taking the acceleration away takes 5.33 u
}

}  // namespace
}  // namespace taktwerk::axes
