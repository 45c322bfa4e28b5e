// Rules every plan keeps, over random motions in all scales. Tolerances are rounding errors of the numbers that take part.

#include "axes/planner/plan.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "tests/axes/planner/random_motion.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes {
namespace {

constexpr std::size_t usual_cases = 100'000;

template <typename Rule>
void for_random_motions(std::uint64_t seed, Rule rule, std::size_t usual = usual_cases) {
    RandomMotion random{seed};
    const std::size_t cases = property_cases(usual);
    for (std::size_t i = 0; i < cases && !::testing::Test::HasFailure(); ++i) {
        const MotionCase c = random.next();
        SCOPED_TRACE(::testing::Message() << "case " << i << " " << c);
        rule(c, random);
    }
}

std::vector<Profile> all_plans(const MotionCase& c, RandomMotion& random) {
    const Plan plans[] = {plan_to_position(c.from, c.target, c.limits), plan_stop(c.from, c.limits),
                          plan_to_velocity(c.from, c.limits.velocity * random.uniform(-1, 1), c.limits)};
    std::vector<Profile> profiles;
    for (const Plan& plan : plans) {
        EXPECT_EQ(plan.error, PlanError::none);
        profiles.push_back(plan.profile);
    }
    return profiles;
}

/// Sample times: a grid, and both ends of every piece.
std::vector<double> sample_times(const Profile& profile) {
    std::vector<double> times;
    for (int i = 0; i <= 8; ++i) times.push_back(profile.duration() * i / 8);
    for (int i = 0; i < profile.piece_count(); ++i) times.push_back(profile.piece_end(i));
    std::sort(times.begin(), times.end());
    return times;
}

TEST(PlanProperty, EndsExactlyAtTheTargetAndStaysThere) {
    for_random_motions(1, [](const MotionCase& c, RandomMotion&) {
        const Plan plan = plan_to_position(c.from, c.target, c.limits);
        ASSERT_EQ(plan.error, PlanError::none);
        const double end = plan.profile.duration();
        ASSERT_TRUE(std::isfinite(end));
        ASSERT_EQ(plan.profile.at(end), (MotionState{c.target, 0, 0}));
        ASSERT_EQ(plan.profile.at(2 * end + 1), (MotionState{c.target, 0, 0}));
        ASSERT_EQ(plan.profile.at(0), end > 0 ? c.from : plan.profile.end());
    });
}

TEST(PlanProperty, PositionVelocityAndAccelerationContinueFromPieceToPiece) {
    for_random_motions(2, [](const MotionCase& c, RandomMotion& random) {
        for (const Profile& profile : all_plans(c, random)) {
            const Rounding rounding{c, profile};
            MotionState before = c.from;
            for (int i = 0; i <= profile.piece_count(); ++i) {
                const bool last = i == profile.piece_count();
                const MotionState after = last ? profile.end() : profile.on_piece(i, profile.piece_begin(i));
                ASSERT_NEAR(before.position, after.position, rounding.position) << "piece " << i;
                ASSERT_NEAR(before.velocity, after.velocity, rounding.velocity) << "piece " << i;
                if (!std::isinf(c.limits.jerk)) {
                    ASSERT_NEAR(before.acceleration, after.acceleration, rounding.acceleration) << "piece " << i;
                }
                if (!last) before = profile.on_piece(i, profile.piece_end(i));
            }
        }
    });
}

TEST(PlanProperty, KeepsTheLimitsOnceInsideThem) {
    std::size_t inside_from_the_start = 0;
    for_random_motions(3, [&](const MotionCase& c, RandomMotion& random) {
        for (const Profile& profile : all_plans(c, random)) {
            const Rounding rounding{c, profile};
            MotionState start = c.from;
            if (std::isinf(c.limits.jerk)) start.acceleration = 0;  // it jumps, so it binds nothing
            bool inside = inside_limits(start, c.limits);
            inside_from_the_start += inside;
            for (double t : sample_times(profile)) {
                const MotionState s = profile.at(t);
                if (t == 0) continue;
                if (inside) {
                    ASSERT_TRUE(inside_limits(s, c.limits, 1e-9 * c.limits.velocity + rounding.velocity,
                                              1e-9 * std::max(c.limits.acceleration, c.limits.deceleration) + rounding.acceleration))
                        << "at " << t << ": " << s.velocity << " " << s.acceleration;
                } else {
                    inside = inside_limits(s, c.limits);
                }
                ASSERT_LE(std::abs(profile.jerk_at(t)), std::isinf(c.limits.jerk) ? 0 : c.limits.jerk);
            }
        }
    });
    EXPECT_GT(inside_from_the_start, usual_cases / 2);
}

TEST(PlanProperty, AStartOutsideTheLimitsGetsNoFurtherOutside) {
    for_random_motions(4, [](const MotionCase& c, RandomMotion& random) {
        MotionState start = c.from;
        if (std::isinf(c.limits.jerk)) start.acceleration = 0;
        // What remains when the acceleration is taken away cannot be helped.
        const double released =
            std::isinf(c.limits.jerk) ? 0 : start.velocity + start.acceleration * std::abs(start.acceleration) / (2 * c.limits.jerk);
        const double fastest = std::max({c.limits.velocity, std::abs(start.velocity), std::abs(released)});
        const double hardest = std::max({c.limits.acceleration, c.limits.deceleration, std::abs(start.acceleration)});
        for (const Profile& profile : all_plans(c, random)) {
            const Rounding rounding{c, profile};
            ASSERT_LE(profile.max_speed(), fastest * (1 + 1e-9) + rounding.velocity);
            for (double t : sample_times(profile)) {
                if (t == 0) continue;
                ASSERT_LE(std::abs(profile.at(t).acceleration), hardest * (1 + 1e-9) + rounding.acceleration);
            }
        }
    });
}

// The tolerance is what correcting a rounding error costs, and that grows with its cube root near the end of a motion; elsewhere the
// times agree far better, so most must.
TEST(PlanProperty, ReplanningOnTheWayNeitherGainsNorLosesTime) {
    std::size_t replans = 0;
    std::size_t close = 0;
    for_random_motions(5, [&](const MotionCase& c, RandomMotion& random) {
        const Profile profile = plan_to_position(c.from, c.target, c.limits).profile;
        const Rounding rounding{c, profile};
        for (int i = 0; i < 4; ++i) {
            const double t = profile.duration() * random.uniform(0, 1);
            const Plan again = plan_to_position(profile.at(t), c.target, c.limits);
            ASSERT_EQ(again.error, PlanError::none);
            ASSERT_NEAR(t + again.profile.duration(), profile.duration(), rounding.time) << "from " << t;
            ++replans;
            close += std::abs(t + again.profile.duration() - profile.duration()) <= 1e-9 * profile.duration();
        }
    });
    EXPECT_GT(static_cast<double>(close), 0.95 * static_cast<double>(replans));
}

// A start 10^10 to 10^14 times beyond the velocity limit, a target about where it would come to rest: on the way nothing faster is found.
TEST(PlanProperty, FarBeyondTheVelocityLimitATargetNearTheStopIsReachedAsFastAsCanBe) {
    RandomMotion random{9};
    std::size_t before_the_stop = 0, behind = 0;
    for (std::size_t i = 0; i < property_cases(20'000) && !::testing::Test::HasFailure(); ++i) {
        const auto scale = [&](double low, double high) { return std::pow(10.0, random.uniform(low, high)); };
        const MotionLimits limits{scale(-9, -7), scale(-1, 1), scale(-1, 1), scale(-1, 1)};
        const double sense = random.one_of(2) == 0 ? 1 : -1;
        const MotionState from{0, sense * limits.velocity * scale(10, 14), 0};
        const double stop = stopping_distance(from, limits);
        const double beside = (random.one_of(2) == 0 ? 1 : -1) * scale(-16, -6);
        const MotionCase c{from, stop * (1 + beside), limits};
        SCOPED_TRACE(::testing::Message() << "case " << i << " " << c);
        (beside > 0 ? behind : before_the_stop) += 1;
        const Plan plan = plan_to_position(c.from, c.target, c.limits);
        ASSERT_EQ(plan.error, PlanError::none);
        const Profile& profile = plan.profile;
        const Rounding rounding{c, profile};
        for (const double part : {0.5, 0.9, 0.99, random.uniform(0, 1)}) {
            const double t = profile.duration() * part;
            const Plan again = plan_to_position(profile.at(t), c.target, c.limits);
            ASSERT_EQ(again.error, PlanError::none);
            ASSERT_GE(t + again.profile.duration(), profile.duration() - rounding.time) << "from " << part;
        }
    }
    EXPECT_GT(before_the_stop, 1000u);
    EXPECT_GT(behind, 1000u);
}

TEST(PlanProperty, LargerLimitsAreNeverSlower) {
    for_random_motions(6, [](const MotionCase& c, RandomMotion& random) {
        if (!inside_limits(c.from, c.limits)) return;
        MotionLimits larger = c.limits;
        switch (random.one_of(4)) {
            case 0: larger.velocity *= random.uniform(1, 3); break;
            case 1: larger.acceleration *= random.uniform(1, 3); break;
            case 2: larger.deceleration *= random.uniform(1, 3); break;
            default: larger.jerk *= random.uniform(1, 3); break;
        }
        const Profile profile = plan_to_position(c.from, c.target, c.limits).profile;
        const Profile faster = plan_to_position(c.from, c.target, larger).profile;
        ASSERT_LE(faster.duration(), profile.duration() + Rounding(c, profile).time) << MotionCase{c.from, c.target, larger};
    });
}

TEST(PlanProperty, MirroredMotionTakesTheSameTime) {
    for_random_motions(7, [](const MotionCase& c, RandomMotion&) {
        const MotionState mirrored{-c.from.position, -c.from.velocity, -c.from.acceleration};
        const Profile profile = plan_to_position(c.from, c.target, c.limits).profile;
        ASSERT_NEAR(plan_to_position(mirrored, -c.target, c.limits).profile.duration(), profile.duration(), Rounding(c, profile).time);
    });
}

TEST(PlanProperty, ShiftedMotionTakesTheSameTime) {
    for_random_motions(8, [](const MotionCase& c, RandomMotion& random) {
        const double shift = c.from.position * random.uniform(-3, 3);
        MotionCase shifted = c;
        shifted.from.position += shift;
        shifted.target += shift;
        const Profile profile = plan_to_position(c.from, c.target, c.limits).profile;
        const Profile there = plan_to_position(shifted.from, shifted.target, c.limits).profile;
        ASSERT_NEAR(there.duration(), profile.duration(), Rounding(c, profile).time + Rounding(shifted, there).time);
    });
}

// Powers of two change no digit, so nothing at all may change: this is what "no absolute tolerance" means.
TEST(PlanProperty, UnitsOfLengthAndTimeDoNotMatter) {
    for_random_motions(9, [](const MotionCase& c, RandomMotion& random) {
        const double length = std::ldexp(1.0, random.one_of(21) - 10);
        const double time = std::ldexp(1.0, random.one_of(11) - 5);
        const double velocity = length / time;
        const double acceleration = velocity / time;
        const double jerk = acceleration / time;
        const MotionCase scaled{{c.from.position * length, c.from.velocity * velocity, c.from.acceleration * acceleration},
                                c.target * length,
                                {c.limits.velocity * velocity, c.limits.acceleration * acceleration, c.limits.deceleration * acceleration,
                                 c.limits.jerk * jerk}};
        const Plan plan = plan_to_position(c.from, c.target, c.limits);
        const Plan other = plan_to_position(scaled.from, scaled.target, scaled.limits);
        ASSERT_EQ(other.error, PlanError::none);
        ASSERT_EQ(other.profile.duration(), plan.profile.duration() * time);
    });
}

TEST(PlanProperty, NoFasterThanTheVelocityLimitAllows) {
    for_random_motions(10, [](const MotionCase& c, RandomMotion&) {
        const Profile profile = plan_to_position(c.from, c.target, c.limits).profile;
        if (!inside_limits(c.from, c.limits)) return;
        const double way = std::abs(c.target - c.from.position);
        ASSERT_GE(profile.duration() * (1 + 1e-9) + Rounding(c, profile).time, way / c.limits.velocity);
        ASSERT_GE(profile.duration() * (1 + 1e-9), std::abs(c.from.velocity) / std::max(c.limits.deceleration, c.limits.acceleration));
    });
}

}  // namespace
}  // namespace taktwerk::axes
