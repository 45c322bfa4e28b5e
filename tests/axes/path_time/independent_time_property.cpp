// Plans looked at by a stranger: whether there is a faster motion that keeps every limit, from rest and from states of motion, and whether plans keep their limits at 200 instants a piece.
// What is faster is searched for in another way than the planner and the oracle of least_time_unit.cpp work (constant_jerk_search.hpp), and looked at finely before it counts.
//
// TAKTWERK_SOAK_FACTOR takes more cases, and from 2 on finer searches; 40 has all of them. TAKTWERK_PROGRAMS_FIRST=<seed> is where the drawn ones begin.
// Tests named DISABLED_ (independent_open_property.cpp) show what does not hold today: --gtest_also_run_disabled_tests.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "axes/path_time/run_plan.hpp"
#include "tests/axes/path/points.hpp"
#include "tests/axes/path_time/constant_jerk_search.hpp"
#include "tests/axes/path_time/independent_cases.hpp"
#include "tests/axes/path_time/independent_comparison.hpp"
#include "tests/axes/path_time/path_curve.hpp"
#include "tests/axes/path_time/random_program.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes {
namespace {

// ------------------------------------------------------------------------------------------------------------------ from rest

// What the limits are looked at with: the derivatives are those of the axes' places, by differences.
TEST(IndependentTime, DerivativesAreThoseOfThePlaces) {
    for (const auto& all : {cases_of_the_project(), own_cases()})
        for (const Case& c : all) {
            if (c.path == nullptr) continue;
            const auto& curve = static_cast<const PathCurve&>(*c.curve);
            for (std::uint32_t part = 0; part < c.path->sections().size(); ++part) {
                const auto& section = c.path->sections()[part];
                const double h = 1e-3 * std::min(section.length, curve.feature(section.begin + section.length / 2, CurveSide::after));
                for (int i = 1; i < 12; ++i) {
                    const double s = section.begin + section.length * i / 12;
                    const PathAxes low = curve.axes_in(part, s - h), middle = curve.axes_in(part, s), high = curve.axes_in(part, s + h);
                    for (std::size_t x = 0; x < c.limits.size(); ++x) {
                        const double first = middle.point.first[x], second = middle.point.second[x], third = middle.point.third[x];
                        const double size = std::fabs(first) + h * std::fabs(second) + 1e-3;
                        EXPECT_NEAR((high.q[x] - low.q[x]) / (2 * h), first + h * h / 6 * third, 1e-6 * size) << c.name << ' ' << s;
                        EXPECT_NEAR((high.point.first[x] - low.point.first[x]) / 2, h * second, 2e-6 * size) << c.name << ' ' << s;
                        EXPECT_NEAR((high.point.second[x] - low.point.second[x]) * h / 2, h * h * third, 2e-6 * size) << c.name << ' ' << s;
                    }
                }
            }
        }
}

// The search itself. Of a line of 10 u with 1000 u/s2 and 20,000 u/s3 the least time is known by hand: A/J + sqrt((A/J)^2 + 4 s/A).
TEST(IndependentTime, TheSearchComesToTheKnownTimeOfALineAndNeverBelow) {
    const Case c = of_path("line of 10", polygon({at(0, 0), at(10, 0)}, 0), uneven_axes);
    const double best = 0.05 + std::sqrt(0.05 * 0.05 + 0.04);
    const FoundMotion f = faster_than(*c.curve, c.limits, {.from = 0, .to = 10}, drawn_motion(0, 0, 10, 0.31), 0.31, 120);
    EXPECT_TRUE(f.holds);
    EXPECT_GE(f.duration, best * (1 - 1e-8));
    EXPECT_LE(f.duration, best * 1.001);
}

TEST(IndependentTime, FromRestNothingMuchFasterIsFound) {
    Gaps gaps;
    const int drawn = in_depth() ? 2 : 1;
    for (const Case& c : some_of(cases_of_the_project(), property_cases(1))) from_rest(c, drawn, gaps);
    for (const Case& c : some_of(own_cases(), property_cases(1))) from_rest(c, drawn, gaps);
    gaps.report("from rest");
    ASSERT_FALSE(gaps.all.empty());
    EXPECT_LE(gaps.all.back(), promised);
}

// ------------------------------------------------------------------------------------------------------------------ from states of motion

/// v of a plan by s.
class VelocityByWay {
public:
    explicit VelocityByWay(const RunPlan& plan) : plan_(plan) {}
    double operator()(double s) const {
        std::size_t low = 0, high = plan_.pieces.size();
        while (high - low > 1) (plan_.pieces[(low + high) / 2].begin <= s ? low : high) = (low + high) / 2;
        const TimePiece& p = plan_.pieces[low];
        const double x = std::clamp(s - p.begin, 0.0, p.length);
        if (p.kind == TimePiece::Kind::from_rest) return std::cbrt(4.5 * p.slope * x * x);
        if (p.kind == TimePiece::Kind::to_rest) return std::cbrt(4.5 * p.slope * (p.length - x) * (p.length - x));
        return std::sqrt(std::max(0.0, p.velocity * p.velocity + x * (2 * p.slope + p.curvature * x)));
    }

private:
    const RunPlan& plan_;
};

struct Moving {
    Gaps same, raised, lowered, grown, to_obey;
    std::size_t not_found = 0, found = 0, not_held = 0;
    Uses uses;
    void report(const char* what) {
        std::printf("-- %s: %zu found, %zu not found, %zu without a search that held; uses 1%+.1e 1%+.1e 1%+.1e\n", what, found, not_found,
                    not_held, uses.velocity - 1, uses.acceleration - 1, uses.jerk - 1);
        same.report("   the same once more");
        raised.report("   a raised velocity factor");
        lowered.report("   a lowered one (no faster than the plan where that is above it)");
        grown.report("   an end that has moved on");
        to_obey.report("   the way until a lowered one is come to, beside the least one");
    }
};

/// Plans on from a state, and compares.
void go_on(const std::string& name, const Case& c, RunTask task, const RunPlan& former, double at, Gaps& gaps, Moving& totals,
           bool lowered = false) {
    RunPlanner planner;
    RunPlan plan;
    planner.plan(*c.curve, c.limits, task, plan, &former.shape);
    if (!plan.found) {
        ++totals.not_found;
        std::printf("   %-40s %-28s from %-9.4g v %-8.4g a %-9.3g: not found\n", c.name.c_str(), name.c_str(), task.from, task.velocity,
                    task.acceleration);
        return;
    }
    ++totals.found;
    ConstantJerkSearch::Problem problem{.from = task.from,
                                        .to = task.to,
                                        .velocity = task.velocity,
                                        .acceleration = task.acceleration,
                                        .velocity_factor = task.velocity_factor};
    double obeys = task.from;
    const VelocityByWay velocity(plan);
    const auto wanted = [&](double s) {
        return std::min(c.curve->at(s, CurveSide::before).path.velocity, c.curve->at(s, CurveSide::after).path.velocity) *
               task.velocity_factor;
    };
    if (lowered && task.velocity > wanted(task.from)) {
        // Until it has come down.
        constexpr int parts = 20'000;
        for (int i = 0; i <= parts; ++i) {
            obeys = task.from + (task.to - task.from) * i / parts;
            if (velocity(obeys) <= wanted(obeys) * (1 + 1e-4)) break;
        }
        problem.cap = [&](double s) { return s <= obeys ? std::max(wanted(s), velocity(s) * (1 + 1e-6)) : wanted(s) * (1 + 1e-6); };
    }
    const Uses u = uses_of(plan, *c.curve, c.limits, task.velocity_factor, 200, problem.cap);
    totals.uses.widen(u);
    // A lowered velocity is no limit that is never crossed (see independent_limits_property.cpp); the path's own is.
    const double hard = lowered ? uses_of(plan, *c.curve, c.limits, 1, 40).velocity : u.velocity;
    EXPECT_LE(hard, 1 + (task.velocity_factor < 1 ? 1e-3 : 1e-6)) << c.name << ' ' << name << " from " << task.from;
    EXPECT_LE(u.acceleration, 1 + 1e-6) << c.name << ' ' << name << " from " << task.from;
    EXPECT_LE(u.jerk, 1 + 1e-3) << c.name << ' ' << name << " from " << task.from;
    const FoundMotion best = faster_than(*c.curve, c.limits, problem, PlanMotion{plan}, plan.duration, cells_of_a_search());
    double least = 1e300;
    if (best.holds) least = best.duration;
    if (std::fabs(former.shape.end - task.to) < 1e-9 * task.to && !problem.cap && task.velocity_factor >= former.shape.velocity_factor) {
        least = std::min(least, former.duration - at);  // what runs is a motion too
        const FoundMotion other =
            faster_than(*c.curve, c.limits, problem, PlanMotion{former, at}, former.duration - at, cells_of_a_search());
        if (other.holds) least = std::min(least, other.duration);
    }
    if (least > 1e299) {
        ++totals.not_held;
        std::printf("   %-40s %-28s from %-9.4g v %-8.4g a %-9.3g: %9.5f s  no search held\n", c.name.c_str(), name.c_str(), task.from,
                    task.velocity, task.acceleration, plan.duration);
        return;
    }
    const double gap = plan.duration / std::min(least, plan.duration) - 1;  // it is a motion as well
    gaps.add(gap);
    std::printf("   %-40s %-28s from %-9.4g v %-8.4g a %-9.3g: %9.5f s %+6.2f %%", c.name.c_str(), name.c_str(), task.from, task.velocity,
                task.acceleration, plan.duration, 100 * gap);
    if (problem.cap && in_depth()) {
        // The least way: halved as long as a search still keeps what is wanted behind it.
        double low = task.from, high = obeys;
        for (int i = 0; i < 6; ++i) {
            const double middle = (low + high) / 2;
            auto sooner = problem;
            sooner.cap = [&, middle](double s) { return s < middle ? 1e9 : wanted(s) * (1 + 1e-6); };
            ConstantJerkSearch search(*c.curve, c.limits, sooner);
            search.begin(PlanMotion{plan}, plan.duration, 60);
            (void)search.solve(60, 1e-5);
            (search.crossed() < 1e-6 && search.look(1).gap < 1e-5 ? high : low) = middle;
        }
        std::printf("  comes down over %.4g, %.2f times the least way", obeys - task.from, (obeys - task.from) / (high - task.from));
        totals.to_obey.add((obeys - task.from) / (high - task.from) - 1);
    }
    std::printf("\n");
    std::fflush(stdout);
}

void from_states(const Case& c, const std::vector<double>& parts, Moving& totals) {
    RunPlanner planner;
    RunPlan full, slow, shorter;
    RunTask task;
    task.to = c.curve->end();
    planner.plan(*c.curve, c.limits, task, full);
    const bool fed = c.curve->at(0, CurveSide::after).path.velocity < 1e8;
    if (fed) {
        task.velocity_factor = 0.3;
        planner.plan(*c.curve, c.limits, task, slow);
    }
    RunTask half;
    half.to = 0.55 * task.to;
    planner.plan(*c.curve, c.limits, half, shorter);
    for (const double part : parts) {
        State s = state_of(full, part);
        s.task.to = task.to;
        go_on("the same", c, s.task, full, s.at, totals.same, totals);
        if (fed)
            for (const double factor : {0.6, 0.15}) {
                s.task.velocity_factor = factor;
                go_on("lowered to " + std::to_string(factor).substr(0, 4), c, s.task, full, s.at, totals.lowered, totals, true);
            }
        if (fed && slow.found) {
            State t = state_of(slow, part);
            t.task.to = task.to;
            go_on("raised from 0.3 to 1", c, t.task, slow, t.at, totals.raised, totals);
        }
        if (shorter.found) {
            State t = state_of(shorter, part);
            t.task.to = task.to;
            go_on("the end moved on", c, t.task, shorter, t.at, totals.grown, totals);
        }
    }
}

TEST(IndependentTime, FromStatesOfMotionNothingMuchFasterIsFound) {
    Moving totals;
    const bool all = in_depth();
    const std::vector<double> parts = all ? std::vector<double>{0.1, 0.3, 0.5, 0.8} : std::vector<double>{0.5};
    for (const Case& c : some_of(fed_cases(), property_cases(1))) from_states(c, parts, totals);
    if (all)
        for (const auto& others : {cases_of_the_project(), own_cases()})
            for (const Case& c : some_of(others, property_cases(1)))
                if (c.factor == 1) from_states(c, {0.12, 0.45, 0.75}, totals);
    totals.report("from states of motion");
    for (const Gaps* g : {&totals.same, &totals.raised, &totals.lowered, &totals.grown})
        if (!g->all.empty()) {
            EXPECT_LE(g->all.back(), promised);
        }
    EXPECT_GT(totals.found, 2u);
}

// ------------------------------------------------------------------------------------------------------------------ drawn

TEST(IndependentTime, DrawnFromRestNothingMuchFasterIsFound) {
    Gaps gaps;
    const std::size_t cases = property_cases(1);
    const std::uint64_t first = first_program();
    for (std::uint64_t seed = first; seed < first + cases; ++seed) from_rest(drawn_case(seed), 0, gaps);
    gaps.report("from rest, drawn");
    if (!gaps.all.empty()) {
        EXPECT_LE(gaps.all.back(), promised_drawn);
    }
}
TEST(IndependentTime, DrawnFromStatesOfMotionAreLookedAt) {
    Moving totals;
    const std::size_t cases = in_depth() ? property_cases(1) : 0;
    const std::uint64_t first = first_program();
    for (std::uint64_t seed = first; seed < first + cases; ++seed) {
        RandomProgram random(seed);
        from_states(drawn_case(seed), {random.uniform(0.05, 0.9)}, totals);
    }
    totals.report("drawn");
}

}  // namespace
}  // namespace taktwerk::axes
