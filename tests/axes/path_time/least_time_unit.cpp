// How near a plan comes to the least time there is, with every limit of jerk, on curves: against an oracle of another make. O-2.

#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "axes/path_time/run_plan.hpp"
#include "axes/planner/plan.hpp"
#include "tests/axes/path/points.hpp"
#include "tests/axes/path_time/least_time.hpp"
#include "tests/axes/path_time/path_curve.hpp"

namespace taktwerk::axes {
namespace {

using std::numbers::pi;

const PathFeed no_feed{1e9, 1e12, 1e12, 1e15};
const std::vector<PathAxisLimits> two_axes{{200, 1000, 20'000}, {150, 800, 16'000}};

void append(Path& path, const PathElement& element, const PathFeed& feed = no_feed, const BlendRequest& blend = {}) {
    PathMove move;
    move.element = element;
    move.feed = feed;
    ASSERT_TRUE(path.append(move, blend).ok());
}
Path corner(double distance, double angle, const PathFeed& feed = no_feed) {
    Path path;
    append(path, PathElement::line(at(0, 0), at(100, 0)), feed);
    append(path, PathElement::line(at(100, 0), at(100 + 100 * std::cos(angle), 100 * std::sin(angle))), feed,
           {BlendRule::corner_distance, distance});
    return path;
}
/// From the origin along x, curving to the left (sense 1) or to the right (-1).
PathElement arc(const PathVector& from, double radius, double heading, double angle, double sense) {
    const PathVector out = sense * radius * at(std::sin(heading), -std::cos(heading)),
                     along = radius * at(std::cos(heading), std::sin(heading));
    return PathElement::arc(from - out, out, along, at(0, 0), angle);
}

// Of a line the optimum is known: the oracle is never better than it, and comes as near as it says.
TEST(LeastTime, TheOracleKnowsALine) {
    for (const double length : {0.3, 10.0, 200.0}) {
        Path path;
        append(path, PathElement::line(at(0, 0), at(length, 0)));
        const double best = plan_to_position({}, length, MotionLimits{200, 1000, 1000, 20'000}).profile.duration();
        using Beginning = LeastTimeOracle::Beginning;
        for (const int cells : {200, 800})
            for (const Beginning beginning : {Beginning::even, Beginning::early, Beginning::late}) {
                LeastTimeOracle oracle(PathCurve(path, 1), std::span(two_axes).first(1), 0, length, cells);
                const double found = oracle.solve(beginning);
                EXPECT_LT(oracle.most_used(), 1);
                EXPECT_GT(oracle.slowest_place(), 2);
                EXPECT_GE(found, best * (1 - 3.5 / cells)) << length << ' ' << cells;
                EXPECT_LE(found, best * (1 + 3.5 / cells)) << length << ' ' << cells;
            }
    }
}

TEST(LeastTime, PlansOnCurvesComeNear) {
    std::vector<TimedCase> cases;
    cases.push_back({"corner of 90 degrees, curve of 20", corner(20, pi / 2), two_axes});
    cases.push_back({"corner of 90 degrees, curve of 5", corner(5, pi / 2), two_axes});
    cases.push_back({"corner of 90 degrees, curve of 2", corner(2, pi / 2), two_axes});
    cases.push_back({"corner of 30 degrees, curve of 10", corner(10, pi / 6), two_axes});
    cases.push_back({"corner of 140 degrees, curve of 20", corner(20, 7 * pi / 9), two_axes});
    cases.push_back({"corner with the path's own limits", corner(20, pi / 2, {120, 700, 500, 9'000}), two_axes});
    cases.push_back({"corner at a tenth of the velocity", corner(20, pi / 2, {120, 700, 500, 9'000}), two_axes, 0.1});
    cases.push_back({"corner at half the velocity", corner(20, pi / 2, {120, 700, 500, 9'000}), two_axes, 0.5});
    Path quarter, circle, slalom;
    append(quarter, arc(at(0, 0), 50, 0, pi / 2, 1));
    append(circle, arc(at(0, 0), 50, 0, 2 * pi, 1));
    cases.push_back({"quarter of a circle", quarter, two_axes});
    cases.push_back({"circle", circle, two_axes});
    // Two arcs whose curvature jumps where they meet: a curve of its own leads over.
    append(slalom, arc(at(0, 0), 50, 0, pi / 2, 1));
    append(slalom, arc(at(50, 50), 50, pi / 2, pi / 2, -1), no_feed, {BlendRule::corner_distance, 15});
    ASSERT_EQ(slalom.sections().size(), 3u);
    cases.push_back({"S of two arcs", slalom, two_axes});
    for (const TimedCase& one : cases) {
        SCOPED_TRACE(one.name);
        expect_near_least_time(one.name, PathCurve(one.path, 2), one.limits, one.velocity_factor);
    }
}

// Through an arm of two links, whose inverse bends each line.
TEST(LeastTime, PlansThroughAnArmComeNear) {
    const std::vector<PathAxisLimits> joints{{3, 20, 400}, {4, 30, 600}};
    Path line, rounded;
    append(line, PathElement::line(at(0, 0), at(-150, 200)));
    append(rounded, PathElement::line(at(0, 0), at(150, 100)));
    append(rounded, PathElement::line(at(150, 100), at(0, 200)), no_feed, {BlendRule::corner_distance, 30});
    for (const auto* path : {&line, &rounded})
        expect_near_least_time(path == &line ? "line through two links" : "corner through two links",
                               PathCurve(*path, 2, PathCurve::Machine::arm), joints);
}

}  // namespace
}  // namespace taktwerk::axes
