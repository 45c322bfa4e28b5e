#pragma once
// What must hold of every plan: pieces that meet, limits at instants between them by exact derivatives, the end. And how much of its time a limit is in use.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <gtest/gtest.h>

#include "axes/path_time/run_plan.hpp"
#include "tests/axes/path_time/shown_use.hpp"

namespace taktwerk::axes {

inline constexpr double velocity_promise = 1 + 1e-6, acceleration_promise = 1 + 1e-6, jerk_promise = 1 + 1e-3;

struct PlanTotals {
    std::size_t programs = 0, runs = 0, lost = 0;
    double part_at_a_limit = 0;  // of the time of each run, added up
    LimitUse worst;
};

/// Every piece meets the next one in s, velocity and acceleration; at so many instants of each all limits are kept, by exact derivatives. Their number is no multiple of what the
/// planner looks at.
inline void look_at(const RunPlan& plan, const TimedCurve& curve, const std::vector<PathAxisLimits>& limits, const RunTask& task,
                    PlanTotals& totals, int per_piece = 23) {
    double at_a_limit = 0;  // s
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
            if (i > 0 && std::max({use.velocity, use.acceleration, use.jerk}) > 0.95) at_a_limit += p.duration / per_piece;
        }
        last = p.at(p.duration);
    }
    ASSERT_NEAR(last.s, task.to, 1e-12 * std::max(1e-3, std::fabs(task.to)));
    ASSERT_EQ(last.velocity, 0);
    ASSERT_EQ(last.acceleration, 0);
    totals.part_at_a_limit += at_a_limit / plan.duration;
}

inline void report_plans(const char* what, const PlanTotals& t) {
    std::printf(
        "%s: %zu programs, %zu runs, %zu not planned; worst use: velocity 1%+.1e, acceleration 1%+.1e, jerk 1%+.1e; %.1f %% of time at a "
        "limit\n",
        what, t.programs, t.runs, t.lost, t.worst.velocity - 1, t.worst.acceleration - 1, t.worst.jerk - 1,
        100 * t.part_at_a_limit / static_cast<double>(std::max<std::size_t>(t.runs - t.lost, 1)));
}

}  // namespace taktwerk::axes
