// Limits, continuity and exactness of plans over random programs, and how near to a limit they run.

#include "axes/path_time/run_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "tests/axes/path_time/path_curve.hpp"
#include "tests/axes/path_time/random_program.hpp"
#include "tests/axes/path_time/shown_use.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes {
namespace {

constexpr double velocity_promise = 1 + 1e-6, acceleration_promise = 1 + 1e-6, jerk_promise = 1 + 1e-3;

struct Totals {
    std::size_t programs = 0, runs = 0, lost = 0, samples = 0, at_a_limit = 0;
    LimitUse worst;
};

/// Every piece meets the next one in s, velocity and acceleration; samples between keep all limits, by exact derivatives.
void look_at(const RunPlan& plan, const PathCurve& curve, const std::vector<PathAxisLimits>& limits, const RunTask& task, Totals& totals) {
    constexpr int per_piece = 23;  // no multiple of what the planner looks at
    PathMotion last{task.from, task.velocity, task.acceleration, 0};
    for (const TimePiece& p : plan.pieces) {
        const PathMotion begin = p.at(0);
        const double scale = std::max(last.velocity, begin.velocity);
        ASSERT_NEAR(begin.s, last.s, 1e-12 * std::max(1e-3, std::fabs(curve.end())));
        ASSERT_NEAR(begin.velocity, last.velocity, 1e-9 * scale);
        ASSERT_NEAR(begin.acceleration, last.acceleration, 1e-7 * std::max(std::fabs(last.acceleration), scale * scale / p.length));
        for (int i = 0; i <= per_piece; ++i) {
            const PathMotion m = p.at(p.duration * i / per_piece);
            const double inside = std::clamp(m.s, p.begin, p.begin + p.length);
            const LimitUse use =
                shown_use(curve.at(inside, i == per_piece ? CurveSide::before : CurveSide::after), limits, task.velocity_factor, m);
            totals.worst.widen(use);
            ASSERT_LE(use.velocity, velocity_promise) << m.s;
            ASSERT_LE(use.acceleration, acceleration_promise) << m.s;
            ASSERT_LE(use.jerk, jerk_promise) << m.s;
        }
        last = p.at(p.duration);
    }
    ASSERT_NEAR(last.s, task.to, 1e-12 * std::max(1e-3, std::fabs(task.to)));
    ASSERT_EQ(last.velocity, 0);
    ASSERT_EQ(last.acceleration, 0);
    std::size_t piece = 0;
    constexpr int samples = 500;
    for (int i = 0; i < samples; ++i) {
        const double t = plan.duration * (i + 0.5) / samples;
        while (piece + 1 < plan.pieces.size() && plan.pieces[piece + 1].begin_time <= t) ++piece;
        const PathMotion m = plan.pieces[piece].at(t - plan.pieces[piece].begin_time);
        const LimitUse use = shown_use(curve.at(m.s, CurveSide::after), limits, task.velocity_factor, m);
        totals.samples += 1;
        totals.at_a_limit += std::max({use.velocity, use.acceleration, use.jerk}) > 0.95 ? 1 : 0;
    }
}

void plan_all(const Path& path, const PathCurve& curve, const std::vector<PathAxisLimits>& limits, Totals& totals) {
    RunPlanner planner;
    RunPlan plan;
    ++totals.programs;
    double from = 0;
    const auto& sections = path.sections();
    for (std::size_t i = 1; i <= sections.size(); ++i) {
        if (i < sections.size() && !sections[i].stop_before) continue;
        RunTask task;
        task.from = from;
        task.to = sections[i - 1].end();
        planner.plan(curve, limits, task, plan);
        ++totals.runs;
        if (!plan.found) ++totals.lost;
        else look_at(plan, curve, limits, task, totals);
        if (::testing::Test::HasFailure()) return;
        from = task.to;
    }
}

void report_plans(const char* what, const Totals& t) {
    std::printf(
        "%s: %zu programs, %zu runs, %zu not planned; worst use: velocity 1%+.1e, acceleration 1%+.1e, jerk 1%+.1e; %.1f %% of time at a "
        "limit\n",
        what, t.programs, t.runs, t.lost, t.worst.velocity - 1, t.worst.acceleration - 1, t.worst.jerk - 1,
        100.0 * static_cast<double>(t.at_a_limit) / static_cast<double>(std::max<std::size_t>(t.samples, 1)));
}

TEST(RunPlanProperty, CartesianProgramsKeepEveryLimit) {
    Totals totals;
    RandomProgram random(1);
    const std::size_t cases = property_cases(60);
    for (std::size_t i = 0; i < cases && !HasFailure(); ++i) {
        SCOPED_TRACE(::testing::Message() << "program " << i);
        const double size = random.between_decades(0.1, 1000), velocity = size * random.between_decades(0.3, 10);
        const int axes = random.whole(1, 3);
        const Path path = random.path(random.whole(1, 12), size, axes, velocity);
        plan_all(path, PathCurve(path, axes), random.limits(axes, velocity), totals);
    }
    report_plans("cartesian", totals);
    EXPECT_EQ(totals.lost, 0u);
}

// From one move to 200, every length as likely as its double: long runs are planned window by window, and more coarsely. With a factor of 5,000
// this is 10^5 programs. TAKTWERK_PROGRAMS_FIRST=<seed> begins there.
TEST(RunPlanProperty, ProgramsOfEveryLengthKeepEveryLimit) {
    Totals totals;
    const std::size_t cases = property_cases(20);
    const std::uint64_t first = first_program();
    for (std::uint64_t seed = first; seed < first + cases && !HasFailure(); ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        RandomProgram random(seed);
        const double size = random.between_decades(0.1, 1000), velocity = size * random.between_decades(0.3, 10);
        const int axes = random.whole(1, 3), moves = static_cast<int>(random.between_decades(1, 201));
        const Path path = random.path(moves, size, axes, velocity, random.uniform(0.8, 1));
        plan_all(path, PathCurve(path, axes), random.limits(axes, velocity), totals);
    }
    report_plans(("every length, from seed " + std::to_string(first)).c_str(), totals);
    EXPECT_EQ(totals.lost, 0u);
}

// A curve between an arc and a line that leads back: it has a cusp, narrower than the places in which a cell was looked at (jerk 49 % beyond).
TEST(RunPlanProperty, ACuspBetweenThePlacesThatAreLookedAtKeepsEveryLimit) {
    Totals totals;
    RandomProgram random(3974);
    const double size = random.between_decades(0.1, 1000), velocity = size * random.between_decades(0.3, 10);
    const int axes = random.whole(1, 3), moves = static_cast<int>(random.between_decades(1, 201));
    const Path path = random.path(moves, size, axes, velocity, random.uniform(0.8, 1));
    const PathCurve curve(path, axes);
    double sharpest = 0;
    for (double s = 0; s < curve.end(); s += 1e-6) sharpest = std::max(sharpest, 1 / curve.feature(s, CurveSide::after));
    EXPECT_GT(sharpest, 1e5 / size) << "there is no cusp any more: this shows nothing";
    plan_all(path, curve, random.limits(axes, velocity), totals);
    EXPECT_EQ(totals.lost, 0u);
}

// In a cell of eight of the curve's features a jerk rose and fell within a thirtieth of the cell: 0.2 % beyond its limit, between two places that were looked at.
TEST(RunPlanProperty, AJerkThatIsNoParabolaIsLookedAtMoreClosely) {
    Totals totals;
    RandomProgram random(10108);
    const double size = random.between_decades(0.1, 1000), velocity = size * random.between_decades(0.3, 10);
    const int axes = random.whole(1, 3), moves = static_cast<int>(random.between_decades(1, 201));
    const Path path = random.path(moves, size, axes, velocity, random.uniform(0.8, 1));
    plan_all(path, PathCurve(path, axes), random.limits(axes, velocity), totals);
    EXPECT_EQ(totals.lost, 0u);
}

// Through the inverse of an arm of two links, which bends every line: joints' limits hold as well as axes' do.
TEST(RunPlanProperty, ProgramsThroughAKinematicsKeepEveryLimit) {
    Totals totals;
    RandomProgram random(3);
    const std::size_t cases = property_cases(15);
    for (std::size_t i = 0; i < cases && !HasFailure(); ++i) {
        SCOPED_TRACE(::testing::Message() << "program " << i);
        const Path path = random.path(random.whole(1, 4), random.between_decades(1, 25), 2, random.between_decades(50, 500));
        plan_all(path, PathCurve(path, 2, PathCurve::Machine::arm), random.limits(2, random.between_decades(0.5, 5)), totals);
    }
    report_plans("arm", totals);
    EXPECT_EQ(totals.lost, 0u);
}

}  // namespace
}  // namespace taktwerk::axes
