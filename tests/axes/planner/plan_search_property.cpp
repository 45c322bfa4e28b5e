// How the fastest motion is looked for: the quick ways of the search against the members of the families themselves, and what a plan costs,
// counted in members looked at.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "axes/planner/climb_polynomial.hpp"
#include "axes/planner/families.hpp"
#include "axes/planner/plan.hpp"
#include "tests/axes/planner/random_states.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Each problem in the four frames in which the families are used.
template <typename Rule>
void for_random_problems(std::uint64_t seed, std::size_t usual, Rule rule) {
    RandomStates random{seed};
    const std::size_t cases = property_cases(usual);
    for (std::size_t i = 0; i < cases && !::testing::Test::HasFailure(); ++i) {
        const StateCase c = random.next();
        const Problem p = ReducedProblem{c.from, c.target, c.limits}.problem;
        SCOPED_TRACE(::testing::Message() << "case " << i << " " << c);
        for (const Problem& frame : {p, p.mirrored(), p.reversed(), p.reversed().mirrored()}) rule(frame, random.numbers());
    }
}

TEST(PlanSearchProperty, AMeasuredClimbIsTheClimbToTheLastBit) {
    std::size_t holds = 0, legs = 0;
    for_random_problems(31, 30'000, [&](const Problem& p, RandomMotion& numbers) {
        const PeakFamily family{p};
        const double x = numbers.one_of(4) == 0 ? family.widest() : std::min(family.widest(), 1e30) * numbers.decades(-6, 0);
        const PeakFamily::Motion m = family.at(x);
        const PeakFamily::Measured measured = family.measured(x);
        if (!std::isfinite(m.up.path() + m.back.path())) return;  // no limit of the velocity: no search goes there
        ASSERT_EQ(measured.peak_velocity, m.peak_velocity);
        for (const auto& [quick, ramp] : {std::pair{&measured.up, &m.up}, std::pair{&measured.back, &m.back}}) {
            ASSERT_EQ(quick->travel, ramp->travel());
            ASSERT_EQ(quick->path, ramp->path());
            ASSERT_EQ(quick->duration, ramp->duration());
            ASSERT_EQ(quick->peak, ramp->peak());
            if (ramp->stretches().size() == 3) ++holds;
            if (ramp->stretches().size() > 3) ++legs;
        }
    });
    EXPECT_GT(holds, 1'000u);
    EXPECT_GT(legs, 1'000u);
}

// In metres, so that nothing cancels. On one side of velocity 0 the polynomial is the way of the climb, and its slope is the slope.
TEST(PlanSearchProperty, APolynomialIsTheWayOfTheClimb) {
    RandomMotion numbers{35};
    std::size_t holds = 0;
    const std::size_t cases = property_cases(10'000);
    for (std::size_t i = 0; i < cases && !HasFailure(); ++i) {
        const auto limit = [&]() { return numbers.uniform(0.5, 5); };
        const double most = limit();
        const FrameLimits l = frame_limits({SignLimits{10, most, most, limit()}, SignLimits{10, most, most, limit()}});
        const double v = numbers.uniform(-3, 3);
        const double a = numbers.uniform(-most, most);
        const double excess = numbers.decades(-3, 1);
        SCOPED_TRACE(::testing::Message() << "case " << i << " v " << v << " a " << a << " excess " << excess);
        const Ramp ramp{climb_above_release(v, a, released_velocity(v, a, l), excess, l), l};
        if (ramp.stretches().size() == 3) ++holds;
        const double lowest = a > 0 ? a * a : 0;
        const double square = 2 * excess / (l.up.ease + l.down.ease);
        const ClimbPolynomial way{v, a, lowest, l};
        ASSERT_NEAR(way.at(square).way, ramp.travel(), 1e-10 * (1 + ramp.path()));
        const double step = 1e-6 * square;
        const double slope = (way.at(square + step).way - way.at(square - step).way) / (2 * step);
        ASSERT_NEAR(way.at(square).slope, slope, 1e-4 * (std::abs(slope) + 1e-2));
    }
    EXPECT_GT(holds, 1'000u);
}

// Above the floor's velocity 0 the way grows with the parameter: over the way of a member the search has to find this member.
TEST(PlanSearchProperty, APeakIsFoundAgainByItsWay) {
    std::size_t found_again = 0;
    for_random_problems(32, 20'000, [&](Problem p, RandomMotion& numbers) {
        const double x = std::min(PeakFamily{p}.widest(), 1e30) * numbers.decades(-2, 0);
        const PeakFamily::Motion m = PeakFamily{p}.at(x);
        const double path = m.up.path() + m.back.path();
        p.way = m.up.travel() + m.back.travel();
        const PeakFamily family{p};
        const bool beyond_first = p.way - family.measured(0).travel() > 1e-6 * path;
        if (!(m.peak_velocity > 0 && beyond_first) || !std::isfinite(path)) return;
        const Found found = family.over_way(0, infinity);
        ASSERT_TRUE(found.found);
        // What the way is known to, in time.
        const double known_to = 1e-12 * path / m.peak_velocity;
        ASSERT_NEAR(found.duration, m.up.duration() + m.back.duration(), 1e-9 * found.duration + known_to) << "x " << x;
        ++found_again;
    });
    EXPECT_GT(found_again, 10'000u);
}

// Where the way of a trough grows with the time, the search finds the member or an earlier one, also where later ones turn back before the
// target and the last one is short of it.
TEST(PlanSearchProperty, ATroughIsFoundByAWayThatGrows) {
    std::size_t grows = 0, turns_back = 0;
    for_random_problems(33, 60'000, [&](Problem p, RandomMotion& numbers) {
        const TroughFamily any_way{p};
        if (!any_way.exists()) return;
        const double u = any_way.widest() * numbers.decades(-3, 0);
        // Accelerations are known to their rounding, and so is a trough a little below one of them: here to nine digits.
        if (eps * std::max(std::abs(p.a0), p.a1) > 1e-9 * u) return;
        const TroughFamily::Motion m = any_way.at(u);
        p.way = m.travel();
        const TroughFamily family{p};
        const double growth = family.rate(m) * m.duration();
        const double start = family.at(0).travel();
        if (!(growth > 1e-5 * m.path()) || !(m.travel() - start > 1e-7 * m.path())) return;
        ++grows;
        if (family.at(family.widest()).travel() < p.way - 1e-7 * m.path()) ++turns_back;
        const Found found = family.over_way(0, infinity);
        ASSERT_TRUE(found.found) << "u " << u << " of " << any_way.widest();
        ASSERT_LE(found.duration, m.duration() * (1 + 1e-7)) << "u " << u << " of " << any_way.widest();
    });
    EXPECT_GT(grows, 5'000u);
    EXPECT_GT(turns_back, 100u);
}

// The cost of a plan on whatever machine. Ends at rest have a member in closed form, the others one that polynomials point to; hostile
// scales and limits cost more, but never many times more.
TEST(PlanSearchProperty, LooksAtFewMembers) {
    struct Class {
        const char* name;
        bool from_rest, to_rest;
        int median, of_100, most;
    };
    for (const Class& k : {Class{"rest to rest", true, true, 2, 9, 30}, Class{"any to rest", false, true, 2, 10, 80},
                           Class{"any to any", false, false, 6, 17, 200}}) {
        SCOPED_TRACE(k.name);
        RandomStates random{34};
        std::vector<int> looked_at(property_cases(50'000));
        for (int& n : looked_at) {
            StateCase c = random.next();
            if (k.from_rest) c.from.velocity = c.from.acceleration = 0;
            if (k.to_rest) c.target.velocity = c.target.acceleration = 0;
            n = plan_to_state(c.from, c.target, c.limits).looked_at;
        }
        std::sort(looked_at.begin(), looked_at.end());
        EXPECT_LE(looked_at[looked_at.size() / 2], k.median);
        EXPECT_LE(looked_at[looked_at.size() * 99 / 100], k.of_100);
        EXPECT_LE(looked_at.back(), k.most);
    }
}

}  // namespace
}  // namespace taktwerk::axes
