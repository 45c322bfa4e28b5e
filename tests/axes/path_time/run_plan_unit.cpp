// One run along simple curves, whose times are known from the axis' planner or by hand. O-2, O-3 of the reference's oracles.

#include "axes/path_time/run_plan.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "axes/planner/plan.hpp"
#include "tests/axes/path_time/grid_oracle.hpp"
#include "tests/axes/path_time/path_curve.hpp"
#include "tests/axes/path_time/shown_use.hpp"

namespace taktwerk::axes {
namespace {

constexpr PathFeed free_feed{1e9, 1e12, 1e12, 1e15};

Path line_path(double x, double y, const PathFeed& feed = free_feed) {
    Path path;
    PathVector to = PathVector::Zero();
    to.head<2>() << x, y;
    PathMove move;
    move.element = PathElement::line(PathVector::Zero(), to);
    move.feed = feed;
    EXPECT_TRUE(path.append(move, {}).ok());
    return path;
}

RunPlan plan_of(const Path& path, const std::vector<PathAxisLimits>& limits, RunTask task = {}) {
    const PathCurve curve(path, static_cast<int>(limits.size()));
    if (task.to <= 0) task.to = path.length();
    RunPlanner planner;
    RunPlan plan;
    planner.plan(curve, limits, task, plan);
    EXPECT_TRUE(plan.found);
    EXPECT_TRUE(plan.use.inside());
    return plan;
}

// A line along one axis takes what the axis' own planner takes, over six decades of length: never less, at most 0.8 % more.
TEST(RunPlan, LineOfOneAxisAgainstTheAxisPlanner) {
    for (double length : {1e-3, 0.1, 1.0, 10.0, 100.0, 1e3}) {
        const RunPlan plan = plan_of(line_path(length, 0), {{125, 1250, 25000}, {1, 1, 1}});
        const double best = plan_to_position({}, length, MotionLimits{125, 1250, 1250, 25000}).profile.duration();

        EXPECT_GE(plan.duration, best * (1 - 1e-9)) << length;
        EXPECT_LE(plan.duration, best * 1.008) << length;
    }
}

// Cells of a run that goes on are as long as suits the run. The first one's v2 is given by the state that it begins with: were it as long, one who still speeds up would be
// carried above a lowered velocity by the cell alone (here from 34 u/s to 78, with 36 wanted).
TEST(RunPlan, AFirstCellCarriesNobodyAboveALoweredVelocity) {
    const Path path = line_path(10'000, 0, {150, 1000, 1000, 10'000});
    const PathCurve curve(path, 1);
    CellGrid grid;
    RunTask task;
    task.from = 100;
    task.to = path.length();
    task.velocity = 34;
    task.acceleration = 6;
    task.velocity_factor = 0.24;
    grid.make(curve, std::vector<PathAxisLimits>{{1e3, 1000, 10'000}}, task, CellGrid::Grain::coarse);
    const double square = task.velocity * task.velocity, behind = square + 2 * task.acceleration * (grid.nodes[1] - grid.nodes[0]);
    EXPECT_LT(std::sqrt(behind), 1.02 * task.velocity);
}

// Minutes to a day: every limit holds in every piece, the plan fits into a stretch, costs no more cells than a short one, and the ramps are as quick as
// without a cruise between them. By hand: 5 u/s with 10,000 u/s3 are come to in 2 sqrt(5/10,000) = 0.045 s.
TEST(RunPlan, LongRunsKeepEveryLimitAndCostNoMore) {
    const std::vector<PathAxisLimits> limits{{5, 1000, 10'000}};
    for (const double seconds : {60.0, 600.0, 3600.0, 86'400.0}) {
        const Path path = line_path(5 * seconds, 0);
        const PathCurve curve(path, 1);
        const RunPlan plan = plan_of(path, limits);
        EXPECT_LE(plan.pieces.size(), 3000U) << seconds;
        EXPECT_LE(plan.cells, 400) << seconds;
        EXPECT_LE(plan.steps, 400) << seconds;
        EXPECT_GE(plan.duration, seconds) << seconds;
        EXPECT_LE(plan.duration, seconds * 1.002 + 0.1) << seconds;
        LimitUse use;
        double longest = 0, after_a_tenth = 0;
        for (const TimePiece& piece : plan.pieces) {
            longest = std::max(longest, piece.duration);
            for (int k = 0; k <= 24; ++k) {
                const PathMotion m = piece.at(piece.duration * k / 24);
                use.widen(shown_use(curve.at(m.s, CurveSide::after), limits, 1, m));
                if (piece.begin_time + piece.duration * k / 24 <= 0.1) after_a_tenth = m.velocity;
            }
        }
        EXPECT_LE(use.velocity, 1 + 1e-6) << seconds;
        EXPECT_LE(use.acceleration, 1 + 1e-6) << seconds;
        EXPECT_LE(use.jerk, 1 + 1e-3) << seconds;
        EXPECT_LE(longest, std::max(0.02, plan.duration / 2500) * 1.001) << "who wants to stand waits for the end of one, " << seconds;
        EXPECT_GT(after_a_tenth, 4.5) << seconds;
    }
}

// Along (0.6, 0.8) the second axis limits: 100/0.8.
TEST(RunPlan, LineIsLimitedByItsSlowestAxis) {
    const RunPlan plan = plan_of(line_path(60, 80), {{100, 1000, 20000}, {100, 1000, 20000}});

    const double best = plan_to_position({}, 100, MotionLimits{125, 1250, 1250, 25000}).profile.duration();
    EXPECT_GE(plan.duration, best * (1 - 1e-9));
    EXPECT_LE(plan.duration, best * 1.008);
}

// The path's own limits, with a deceleration of its own.
TEST(RunPlan, PathLimitsWithTheirOwnDeceleration) {
    const RunPlan plan = plan_of(line_path(100, 0, {50, 500, 200, 8000}), {{1000, 1e5, 1e7}, {1000, 1e5, 1e7}});

    const double best = plan_to_position({}, 100, MotionLimits{50, 500, 200, 8000}).profile.duration();
    EXPECT_GE(plan.duration, best * (1 - 1e-9));
    EXPECT_LE(plan.duration, best * 1.008);
}

// Twenty rounds of a circle, a two-axis acceleration limit: both axes pass (A, 0) and (0, A) in turn, and at constant speed v^2/r = A.
TEST(RunPlan, CircleAtItsCentripetalLimit) {
    Path path;
    PathMove move;
    PathVector a = PathVector::Zero(), b = PathVector::Zero();
    a[0] = b[1] = 50;
    move.element = PathElement::arc(-a, a, b, PathVector::Zero(), 40 * std::numbers::pi);
    move.feed = {1e9, 100, 100, 1e15};  // little along the path, so that nearly all is centripetal
    ASSERT_TRUE(path.append(move, {}).ok());
    const RunPlan plan = plan_of(path, {{1e6, 800, 1e7}, {1e6, 800, 1e7}});

    double top = 0;
    for (const TimePiece& p : plan.pieces) top = std::max(top, p.velocity);
    EXPECT_LE(top, std::sqrt(800.0 * 50) * std::pow(2, 0.25));  // between the axes both share it
    EXPECT_GT(top, 0.98 * std::sqrt(800.0 * 50));
}

// Limits times k, k^2, k^3 give the same motion k times as fast.
TEST(RunPlan, ScalesWithTime) {
    const Path path = line_path(60, 80);
    const double once = plan_of(path, {{100, 1000, 20000}, {100, 1000, 20000}}).duration;
    const double twice = plan_of(path, {{200, 4000, 160000}, {200, 4000, 160000}}).duration;

    EXPECT_NEAR(once / twice, 2, 2e-3);
}

// Half the factor halves the velocity of the path, not what axes may.
TEST(RunPlan, VelocityFactorScalesTheFeed) {
    RunTask task;
    task.velocity_factor = 0.5;
    const RunPlan plan = plan_of(line_path(1000, 0, {100, 1000, 1000, 20000}), {{1000, 1e5, 1e7}, {1000, 1e5, 1e7}}, task);

    const double best = plan_to_position({}, 1000, MotionLimits{50, 1000, 1000, 20000}).profile.duration();
    EXPECT_NEAR(plan.duration, best, 2e-3 * best);
}

// Where only the axes limit, less of the feed is no less of them.
TEST(RunPlan, VelocityFactorLeavesTheAxesTheirs) {
    const std::vector<PathAxisLimits> limits{{100, 1000, 20000}, {1, 1, 1}};
    RunTask half;
    half.velocity_factor = 0.5;
    EXPECT_NEAR(plan_of(line_path(1000, 0), limits, half).duration, plan_of(line_path(1000, 0), limits).duration, 1e-3);
}

// Two corners with curves: with hardly any limit of jerk the time is that of the oracle without one. O-2.
TEST(RunPlan, WithoutJerkLimitTheOracleIsReached) {
    Path path;
    PathVector corners[4];
    for (auto& c : corners) c.setZero();
    corners[1].head<2>() << 100, 0;
    corners[2].head<2>() << 120, 70;
    corners[3].head<2>() << 20, 90;
    for (int i = 1; i < 4; ++i) {
        PathMove move;
        move.element = PathElement::line(corners[i - 1], corners[i]);
        move.feed = free_feed;
        ASSERT_TRUE(path.append(move, {BlendRule::corner_distance, 20}).ok());
    }
    const std::vector<PathAxisLimits> limits{{200, 1000, 1e7}, {150, 800, 1e7}};

    const RunPlan plan = plan_of(path, limits);
    const double bound = GridOracle::time(PathCurve(path, 2), limits, 0, path.length(), 20000);

    EXPECT_GE(plan.duration, bound * (1 - 1e-3));
    EXPECT_LE(plan.duration, bound * 1.03);
}

}  // namespace
}  // namespace taktwerk::axes
