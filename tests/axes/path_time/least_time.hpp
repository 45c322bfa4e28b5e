#pragma once
// A plan beside the least time that the oracle finds, and how long a limit is in use on it.

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "axes/path/path.hpp"
#include "axes/path_time/run_plan.hpp"
#include "tests/axes/path_time/least_time_oracle.hpp"
#include "tests/axes/path_time/shown_use.hpp"

namespace taktwerk::axes {

struct TimedCase {
    std::string name;
    Path path;
    std::vector<PathAxisLimits> limits;
    double velocity_factor = 1;
};

/// Part of the time in which at least one limit is used to more than 95 %.
inline double time_at_a_limit(const RunPlan& plan, const TimedCurve& curve, std::span<const PathAxisLimits> limits,
                              double velocity_factor) {
    constexpr int samples = 2000;
    int used = 0;
    std::size_t piece = 0;
    for (int i = 0; i < samples; ++i) {
        const double t = plan.duration * (i + 0.5) / samples;
        while (piece + 1 < plan.pieces.size() && plan.pieces[piece + 1].begin_time <= t) ++piece;
        const PathMotion m = plan.pieces[piece].at(t - plan.pieces[piece].begin_time);
        const LimitUse use = shown_use(curve.at(m.s, CurveSide::after), limits, velocity_factor, m);
        used += std::max({use.velocity, use.acceleration, use.jerk}) > 0.95 ? 1 : 0;
    }
    return static_cast<double>(used) / samples;
}

/// Within a hundredth, and what the oracle itself may be wrong by. TAKTWERK_SOAK_FACTOR: hundreds of cells, and from three beginnings.
inline void expect_near_least_time(const std::string& name, const TimedCurve& curve, const std::vector<PathAxisLimits>& limits,
                                   double velocity_factor = 1) {
    constexpr double most = 1.01;  // of the least time
    RunTask task;
    task.from = curve.begin();
    task.to = curve.end();
    task.velocity_factor = velocity_factor;
    RunPlanner planner;
    RunPlan plan;
    planner.plan(curve, limits, task, plan);
    ASSERT_TRUE(plan.found) << name;
    const char* factor = std::getenv("TAKTWERK_SOAK_FACTOR");
    const bool long_run = factor != nullptr;
    const int cells = long_run ? 100 * std::atoi(factor) : 400;
    double least = 1e300;
    using Beginning = LeastTimeOracle::Beginning;
    const std::vector<Beginning> beginnings =
        long_run ? std::vector{Beginning::even, Beginning::early, Beginning::late} : std::vector{Beginning::even};
    std::string found;
    for (const Beginning beginning : beginnings) {
        LeastTimeOracle oracle(curve, limits, task.from, task.to, cells, velocity_factor);
        const double one = oracle.solve(beginning);
        EXPECT_LT(oracle.most_used(), 1) << name;
        const bool stands = oracle.slowest_place() < 2;
        EXPECT_FALSE(stands && beginning == Beginning::even) << name;
        if (!stands) least = std::min(least, one);
        found += (found.empty() ? "" : ", ") + (stands ? "none" : std::to_string(one));
    }
    std::printf("%s: planned %.5f s, least %s s (%d cells): %+.2f %%; a limit in use for %.1f %% of the time\n", name.c_str(),
                plan.duration, found.c_str(), cells, 100 * (plan.duration / least - 1),
                100 * time_at_a_limit(plan, curve, limits, velocity_factor));
    const double oracles = 3.5 / cells;
    EXPECT_LE(plan.duration, least * most * (1 + oracles)) << name;
    EXPECT_GE(plan.duration, least * (1 - oracles) * (1 - 1e-4)) << name << ": who is faster than all limits allow?";
}

}  // namespace taktwerk::axes
