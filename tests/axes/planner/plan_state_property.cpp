// Rules every plan to a moving state keeps, over random motions in all scales, limits per sign, infinite limits.

#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include "tests/axes/planner/plan_figures.hpp"
#include "tests/axes/planner/random_states.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes {
namespace {

constexpr std::size_t state_cases = 100'000;

template <typename Rule>
void for_random_states(std::uint64_t seed, Rule rule, std::size_t usual = state_cases) {
    RandomStates random{seed};
    const std::size_t cases = property_cases(usual);
    for (std::size_t i = 0; i < cases && !::testing::Test::HasFailure(); ++i) {
        const StateCase c = random.next();
        SCOPED_TRACE(::testing::Message() << "case " << i << " " << c);
        rule(c, random.numbers());
    }
}

/// Position, velocity and, with a jerk limit, acceleration continue from piece to piece and into the target.
void expect_continuous(const StateCase& c, const Profile& profile, const Magnitudes& most) {
    const bool accelerations = !std::isinf(c.limits.positive.jerk) && !std::isinf(c.limits.negative.jerk);
    const bool velocities = accelerations || !(std::isinf(c.limits.positive.speeding_up) || std::isinf(c.limits.positive.slowing_down) ||
                                               std::isinf(c.limits.negative.speeding_up) || std::isinf(c.limits.negative.slowing_down));
    MotionState before = c.from;
    for (int i = 0; i <= profile.piece_count(); ++i) {
        const bool last = i == profile.piece_count();
        const MotionState after = last ? profile.end() : profile.on_piece(i, profile.piece_begin(i));
        ASSERT_NEAR(before.position, after.position, 256 * eps * most.position) << "piece " << i;
        if (velocities) {
            ASSERT_NEAR(before.velocity, after.velocity, 256 * eps * most.velocity) << "piece " << i;
        }
        if (accelerations) {
            ASSERT_NEAR(before.acceleration, after.acceleration, 256 * eps * most.acceleration) << "piece " << i;
        }
        if (!last) before = profile.on_piece(i, profile.piece_end(i));
    }
}

/// From a start inside them; starts that must leave them are the business of another test.
void expect_limits_kept(const StateCase& c, const Profile& profile, const Magnitudes& most) {
    constexpr double unlimited = std::numeric_limits<double>::infinity();
    const FrameLimits l = frame_limits(c.limits);
    const double dv = 256 * eps * most.velocity;
    const double da = 256 * eps * most.acceleration;
    // Next to standstill rounding decides on which side of it the state is.
    const double still = dv;
    for_extremes(profile, [&](const MotionState& s, int i) {
        ASSERT_LE(s.velocity, l.up.velocity + dv) << "piece " << i;
        ASSERT_GE(s.velocity, -l.down.velocity - dv) << "piece " << i;
        const double up = std::abs(s.velocity) <= still ? std::max(l.up.speeding_up, l.up.slowing_down)
                                                        : (s.velocity < 0 ? l.up.slowing_down : l.up.speeding_up);
        const double down = std::abs(s.velocity) <= still ? std::max(l.down.speeding_up, l.down.slowing_down)
                                                          : (s.velocity > 0 ? l.down.slowing_down : l.down.speeding_up);
        const double j = std::min(l.up.jerk, l.down.jerk);
        const double slack = da + (j < unlimited ? 4 * std::sqrt(j * dv) : 0);
        ASSERT_LE(s.acceleration, up + slack) << "piece " << i << " at velocity " << s.velocity;
        ASSERT_GE(s.acceleration, -down - slack) << "piece " << i << " at velocity " << s.velocity;
        ASSERT_LE(profile.piece_jerk(i), std::isinf(l.up.jerk) ? 0 : l.up.jerk * (1 + 4 * eps)) << "piece " << i;
        ASSERT_GE(profile.piece_jerk(i), std::isinf(l.down.jerk) ? 0 : -l.down.jerk * (1 + 4 * eps)) << "piece " << i;
    });
}

bool starts_inside(const StateCase& c) {
    const FrameLimits l = frame_limits(c.limits);
    const double a = l.jerk_free() ? 0 : c.from.acceleration;
    return is_inside(c.from.velocity, a, l, 0) && keeps_limits(c.from.velocity, a, l, 0);
}

/// The plan takes `time` or less, or does so from a start that differs by rounding. (Next to an end that moves, a motion that misses it
/// by a rounding error may have to come round again: then the durations differ and both are right.)
bool not_slower_within_rounding(const StateCase& c, double time, const Magnitudes& most) {
    const double enough = time * (1 + 1e-9) + 64 * eps * most.time;
    if (plan_to_state(c.from, c.target, c.limits).profile.duration() <= enough) return true;
    // First by roundings of the start itself, then by those of everything that takes part.
    const double own = std::max(std::abs(c.from.position), std::abs(c.target.position));
    const MotionState scales[] = {{own, std::abs(c.from.velocity), std::abs(c.from.acceleration)},
                                  {most.position, most.velocity, most.acceleration}};
    for (const MotionState& s : scales) {
        for (double ulps : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 256.0, 1024.0, 4096.0}) {
            for (int i = 0; i < 27; ++i) {
                const auto side = [&](int k) { return (k % 3 - 1) * ulps * eps; };
                const MotionState from{c.from.position + side(i) * s.position, c.from.velocity + side(i / 3) * s.velocity,
                                       c.from.acceleration + side(i / 9) * s.acceleration};
                if (plan_to_state(from, c.target, c.limits).profile.duration() <= enough) return true;
            }
        }
    }
    return false;
}
bool not_slower_within_rounding(const StateCase& c, double time) {
    return not_slower_within_rounding(c, time, Magnitudes{c, plan_to_state(c.from, c.target, c.limits).profile});
}

TEST(PlanStateProperty, ArrivesContinuouslyInsideTheLimits) {
    std::size_t inside = 0;
    for_random_states(1, [&](const StateCase& c, RandomMotion&) {
        const Plan plan = plan_to_state(c.from, c.target, c.limits);
        ASSERT_EQ(plan.error, PlanError::none);
        ASSERT_TRUE(std::isfinite(plan.profile.duration()));
        ASSERT_EQ(plan.profile.at(plan.profile.duration()), c.target);

        const Magnitudes most{c, plan.profile};
        expect_continuous(c, plan.profile, most);
        if (!starts_inside(c)) return;
        ++inside;
        expect_limits_kept(c, plan.profile, most);
    });
    EXPECT_GT(inside, state_cases / 3);
}

TEST(PlanStateProperty, MirroredMotionTakesTheSameTime) {
    for_random_states(
        2,
        [](const StateCase& c, RandomMotion&) {
            const StateCase mirrored{{-c.from.position, -c.from.velocity, -c.from.acceleration},
                                     {-c.target.position, -c.target.velocity, -c.target.acceleration},
                                     {c.limits.negative, c.limits.positive}};
            const Profile profile = plan_to_state(c.from, c.target, c.limits).profile;
            const Profile other = plan_to_state(mirrored.from, mirrored.target, mirrored.limits).profile;
            if (std::abs(other.duration() - profile.duration()) <= 8 * eps * profile.duration()) return;
            // A way that the positions leave open (it is less than their rounding) may be gone either way round.
            ASSERT_TRUE(not_slower_within_rounding(c, other.duration()));
            ASSERT_TRUE(not_slower_within_rounding(mirrored, profile.duration()));
        },
        20'000);
}

TEST(PlanStateProperty, UnitsOfLengthAndTimeDoNotMatter) {
    for_random_states(
        3,
        [](const StateCase& c, RandomMotion& random) {
            // Powers of two change no digit, so nothing at all may change.
            const double length = std::ldexp(1.0, random.one_of(21) - 10);
            const double time = std::ldexp(1.0, random.one_of(11) - 5);
            const double v = length / time;
            const double a = v / time;
            const double j = a / time;
            const auto state = [&](const MotionState& s) { return MotionState{s.position * length, s.velocity * v, s.acceleration * a}; };
            const auto sign = [&](const SignLimits& l) {
                return SignLimits{l.velocity * v, l.speeding_up * a, l.slowing_down * a, l.jerk * j};
            };
            const Profile profile = plan_to_state(c.from, c.target, c.limits).profile;
            const Plan other = plan_to_state(state(c.from), state(c.target), {sign(c.limits.positive), sign(c.limits.negative)});
            ASSERT_EQ(other.error, PlanError::none);
            ASSERT_EQ(other.profile.duration(), profile.duration() * time);
        },
        20'000);
}

TEST(PlanStateProperty, BackwardsInTimeItTakesTheSameTime) {
    std::size_t compared = 0;
    for_random_states(
        4,
        [&](const StateCase& c, RandomMotion&) {
            if (!starts_inside(c)) return;
            const auto backwards = [](const SignLimits& own, const SignLimits& other) {
                return SignLimits{other.velocity, own.slowing_down, own.speeding_up, other.jerk};
            };
            const Profile profile = plan_to_state(c.from, c.target, c.limits).profile;
            const StateCase reversed{{c.target.position, -c.target.velocity, c.target.acceleration},
                                     {c.from.position, -c.from.velocity, c.from.acceleration},
                                     {backwards(c.limits.positive, c.limits.negative), backwards(c.limits.negative, c.limits.positive)}};
            const Plan other = plan_to_state(reversed.from, reversed.target, reversed.limits);
            ASSERT_EQ(other.error, PlanError::none);
            ++compared;
            if (std::abs(other.profile.duration() - profile.duration()) <= 1e-9 * profile.duration()) return;
            // Not the same to that: then the difference is what rounding the ends costs.
            ASSERT_TRUE(not_slower_within_rounding(reversed, profile.duration())) << other.profile.duration() << " " << profile.duration();
            ASSERT_TRUE(not_slower_within_rounding(c, other.profile.duration())) << other.profile.duration() << " " << profile.duration();
        },
        20'000);
    EXPECT_GT(compared, 5'000u);
}

TEST(PlanStateProperty, ReplanningOnTheWayTakesNoLonger) {
    for_random_states(
        5,
        [](const StateCase& c, RandomMotion& random) {
            const Profile profile = plan_to_state(c.from, c.target, c.limits).profile;
            const double t = profile.duration() * random.uniform(0, 1);
            if (!(t < profile.duration())) return;
            const StateCase rest{profile.at(t), c.target, c.limits};
            ASSERT_TRUE(not_slower_within_rounding(rest, profile.duration() - t, Magnitudes{c, profile}))
                << "from " << t << " of " << profile.duration() << ": " << rest << " takes "
                << plan_to_state(rest.from, rest.target, rest.limits).profile.duration();
        },
        50'000);
}

TEST(PlanStateProperty, LargerLimitsAreNeverSlower) {
    for_random_states(
        6,
        [](const StateCase& c, RandomMotion& random) {
            if (!starts_inside(c)) return;
            StateCase larger = c;
            SignLimits& l = random.one_of(2) == 0 ? larger.limits.positive : larger.limits.negative;
            const double factor = random.uniform(1, 3);
            switch (random.one_of(4)) {
                case 0: l.velocity *= factor; break;
                case 1: l.speeding_up *= factor; break;
                case 2: l.slowing_down *= factor; break;
                default: l.jerk *= factor; break;
            }
            if (!starts_inside(larger)) return;
            const Profile profile = plan_to_state(c.from, c.target, c.limits).profile;
            ASSERT_TRUE(not_slower_within_rounding(larger, profile.duration(), Magnitudes{c, profile})) << larger;
        },
        20'000);
}

// Of the positions only the difference counts; what is left of it after rounding at the place where it is.
TEST(PlanStateProperty, ShiftedMotionTakesNoLonger) {
    for_random_states(
        7,
        [](const StateCase& c, RandomMotion& random) {
            const double shift = c.from.position * random.uniform(-3, 3);
            StateCase shifted = c;
            shifted.from.position += shift;
            shifted.target.position += shift;
            StateCase here = shifted;
            here.target.position -= shifted.from.position;
            here.from.position = 0;
            const Profile profile = plan_to_state(here.from, here.target, here.limits).profile;
            ASSERT_TRUE(not_slower_within_rounding(shifted, profile.duration(), Magnitudes{shifted, profile}));
        },
        20'000);
}

}  // namespace
}  // namespace taktwerk::axes
