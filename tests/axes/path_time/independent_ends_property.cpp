// Ends of runs on curves, beside what a search of another make finds: there the piece at constant jerk may be a slow one.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "axes/path_time/run_plan.hpp"
#include "tests/axes/path/points.hpp"
#include "tests/axes/path_time/independent_cases.hpp"
#include "tests/axes/path_time/independent_comparison.hpp"

namespace taktwerk::axes {
namespace {

/// An arc that ends heading so far beyond the first axis' direction, where the second one, of little velocity, acceleration and jerk, has q' = 0.
struct ArcEnd {
    double radius, weak, past;
    [[nodiscard]] std::vector<PathAxisLimits> limits() const { return {{200, 1000, 20'000}, {200, 1000 * weak, 20'000 * weak}}; }
    [[nodiscard]] double turn() const { return std::numbers::pi / 4 + past; }
    [[nodiscard]] PathElement there() const { return plane_arc(at(0, 0), radius, past - turn(), turn(), 1); }
    [[nodiscard]] Case heading(bool back) const {
        Path path;
        const PathElement way = there();
        append_element(path, back ? plane_arc(way.at(way.length()).at, radius, past + std::numbers::pi, turn(), -1) : way);
        return of_path(
            "arc of " + std::to_string(radius) + ", " + std::to_string(weak) + ", " + std::to_string(past) + (back ? " back" : ""), path,
            limits());
    }
};

std::vector<ArcEnd> ends() {
    std::vector<ArcEnd> all;
    for (const double radius : {0.5, 5.0})
        for (const double weak : {0.1, 0.03, 0.01})
            for (const double past : {-0.05, 0.0, 0.05, 0.2}) all.push_back({radius, weak, past});
    return all;
}

// Limits are the same in both directions, so the way back takes as long as the way there. 0.529 s there, 0.508 s back (4.1 %), when the piece to rest lasted 50 ms.
TEST(IndependentTime, TheWayBackTakesAsLong) {
    RunPlanner planner;
    for (const ArcEnd& end : ends()) {
        std::array<double, 2> durations{};
        for (const bool back : {false, true}) {
            const Case c = end.heading(back);
            RunPlan plan;
            RunTask task;
            task.to = c.curve->end();
            planner.plan(*c.curve, c.limits, task, plan);
            ASSERT_TRUE(plan.found) << c.name;
            durations[back ? 1 : 0] = plan.duration;
        }
        EXPECT_NEAR(durations[0] / durations[1], 1, 0.006) << end.heading(false).name;
    }
}

// Both may be slow: 5 % above what is found where that piece lasted 12 ms whatever the curve did.
TEST(IndependentTime, AnEndOnAnArcIsComeToSoon) {
    Gaps gaps;
    for (const ArcEnd& end : in_depth() ? ends() : std::vector<ArcEnd>{{0.5, 0.1, 0.05}, {0.5, 0.03, 0}, {5, 0.01, -0.05}})
        for (const bool back : {false, true}) from_rest(end.heading(back), 0, gaps);
    gaps.report("ends on arcs");
    EXPECT_LE(gaps.all.back(), 0.0095);  // 1.05 % where the piece is looked at no further than it goes
}

// Drawn 33 was 11 % above what is found, 378 3.8 %: its way to rest comes out of a narrow place.
TEST(IndependentTime, DrawnEndsOnArcsAreComeToSoon) {
    Gaps gaps;
    for (const std::uint64_t seed : {2, 33, 61, 225, 378}) from_rest(drawn_case(seed), 0, gaps);
    gaps.report("drawn ends on arcs");
    EXPECT_LE(gaps.all.back(), in_depth() ? 0.025 : 0.015);  // 3.8 and 2.05 % where that piece lasted 12 ms
}

/// Limits as a stranger drew them: exponents of velocity, of its times, and of the second axis' shares.
std::vector<PathAxisLimits> drawn_limits(double v, double a, double j, double v2, double a2, double j2) {
    const double velocity = 10 * std::exp(v), acceleration = 10 * velocity / std::exp(a), jerk = 50 * acceleration / std::exp(j);
    return {{velocity, acceleration, jerk}, {velocity * std::exp(v2), acceleration * std::exp(a2), jerk * std::exp(j2)}};
}

/// An axis whose q' goes from -1 to 1 around `middle` (tanh), beside one that goes along.
Case step_of_slope(const std::string& name, double middle, double width, bool back, const std::vector<PathAxisLimits>& limits) {
    return of_axes(name, 1, 0.2 * width, no_path_limits, limits, [=](const Jet& s) {
        const Jet way = back ? Jet{1} - s : s, x = (1 / width) * (way - Jet{middle});
        const double slope = std::tanh(x.v), bend = 1 - slope * slope;
        return std::vector<Jet>{way, width * chain(x, std::log(std::cosh(x.v)), slope, bend, -2 * slope * bend)};
    });
}

// What somebody who wrote none of it found when the piece took its length from the first peak of velocity alone, though the end allowed much less (8.3 and 3.8 %), from one that
// did not know what the third derivative costs (5.8 %), and when an end without curvature that has one beside it counted as straight (3.4 %). Each feasible in the time given, by his formulas.
// (The second is slow on his cells alone: here it shows that it stays so. Before any of it the last was late, not the others.)
TEST(IndependentTime, EndsThatSomebodyElseFoundAreComeToSoon) {
    struct Known {
        Case c;
        double feasible;
    };
    Path quarter;
    append_element(quarter, plane_arc(at(0, 0), 0.2, -0.05, std::numbers::pi / 2, 1));
    const double narrow = 0.05 * std::exp(-0.4147), wide = 0.05 * std::exp(1.8961), cubed = std::exp(4.5750);
    std::vector<Known> all;
    all.push_back({of_path("quarter of 0.2, second axis slow", quarter, {{200, 1000, 20'000}, {0.6, 1000, 20'000}}), 0.344793});
    all.push_back({step_of_slope("slow at its beginning", 1 - 0.3413 * wide, wide, true,
                                 drawn_limits(1.9841, -2.4920, 1.9998, -5.1291, -0.5131, -0.3609)),
                   1.591});
    all.push_back({step_of_slope("third derivative near the end", 1 - 2.7831 * narrow, narrow, false,
                                 drawn_limits(1.1317, -3.7754, 3.7397, 0.3174, 2.2467, -0.0968)),
                   0.161364});
    all.push_back(
        {of_axes("no curvature at the end", 1, 0.02, no_path_limits, drawn_limits(2.5448, -1.3834, -0.3434, 0.2066, 1.4004, -5.3464),
                 [=](const Jet& s) {
                     const Jet x = s - Jet{1};
                     return std::vector<Jet>{s, cubed * (x * x * x)};
                 }),
         1.23739});
    RunPlanner planner;
    for (const Known& known : all) {
        RunPlan plan;
        RunTask task;
        task.to = known.c.curve->end();
        planner.plan(*known.c.curve, known.c.limits, task, plan);
        ASSERT_TRUE(plan.found) << known.c.name;
        EXPECT_LE(plan.duration, known.feasible * (1 + promised)) << known.c.name;
        EXPECT_GE(plan.duration, known.feasible * (1 - promised)) << known.c.name << ": not the case that was found";
        const Uses u = uses_of(plan, *known.c.curve, known.c.limits, 1);
        EXPECT_LE(u.velocity, 1 + 1e-6) << known.c.name;
        EXPECT_LE(u.acceleration, 1 + 1e-6) << known.c.name;
        EXPECT_LE(u.jerk, 1 + 1e-3) << known.c.name;
    }
}

}  // namespace
}  // namespace taktwerk::axes
