// What a plan costs beside another planner's cited figures: motions in metres, drawn as Ruckig's own benchmark draws them (positions normal with
// sigma 4, velocities and accelerations with 0.8, limits even between 0.1 and 12.1). Of each motion the least time of several passes: what other work on
// the machine costs is not the plan's.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "axes/planner/plan.hpp"

namespace taktwerk::axes {
namespace {

constexpr std::size_t motions = 100'000;
constexpr int passes = 9;

/// Measured in one run on one machine: both planners in turn, blocks of 1,000 motions, the least of nine passes of each motion, ns without the clock;
/// instructions per plan by callgrind. Ruckig 0.17.3 (commit 53f42b3) with g++ 12.2 -O3, Taktwerk with -O2. What travels to another machine is the ratio.
/// (The largest of any to any is of the run before; docs/performance.md.)
struct Cited {
    double p50, p99, max, instructions;
};
struct Pair {
    Cited taktwerk, ruckig;
};
constexpr Pair rest_to_rest{{174, 214, 269, 2446}, {206, 317, 468, 2737}};
constexpr Pair any_to_rest{{214, 309, 650, 2669}, {222, 483, 832, 2679}};
constexpr Pair any_to_any{{317, 499, 1283, 4127}, {412, 634, 975, 5267}};

struct Case {
    MotionState from, target;
    MotionLimits limits;
};

std::vector<Case> draw(bool from_rest, bool to_rest) {
    std::mt19937_64 random{42};
    std::normal_distribution<double> position{0, 4}, moving{0, 0.8};
    std::uniform_real_distribution<double> limit{0.1, 12.1};
    std::vector<Case> cases;
    while (cases.size() < motions) {
        Case c{{position(random), 0, 0}, {position(random), 0, 0}, {}};
        if (!from_rest) c.from.velocity = moving(random), c.from.acceleration = moving(random);
        if (!to_rest) c.target.velocity = moving(random), c.target.acceleration = moving(random);
        const double a = limit(random) + std::abs(c.target.acceleration);
        c.limits = {limit(random) + std::abs(c.target.velocity), a, a, limit(random)};
        const Plan plan = plan_to_state(c.from, c.target, c.limits);
        if (plan.error == PlanError::none) cases.push_back(c);
    }
    return cases;
}

void time_plans(benchmark::State& state, bool from_rest, bool to_rest, const Pair& cited) {
    const std::vector<Case> cases = draw(from_rest, to_rest);
    std::vector<double> ns(cases.size(), 1e9);
    double clock = 1e9;
    int looked_at = 0;
    using Clock = std::chrono::steady_clock;
    const auto since = [](Clock::time_point begin) { return std::chrono::duration<double, std::nano>(Clock::now() - begin).count(); };
    for (auto _ : state) {
        for (int i = 0; i < 100'000; ++i) clock = std::min(clock, since(Clock::now()));
        for (int pass = 0; pass < passes; ++pass) {
            for (std::size_t i = 0; i < cases.size(); ++i) {
                const auto begin = Clock::now();
                Plan plan = plan_to_state(cases[i].from, cases[i].target, cases[i].limits);
                benchmark::DoNotOptimize(plan);
                ns[i] = std::min(ns[i], since(begin) - clock);
                looked_at = std::max(looked_at, plan.looked_at);
            }
        }
    }
    std::sort(ns.begin(), ns.end());
    state.counters["p50_ns"] = ns[ns.size() / 2];
    state.counters["p99_ns"] = ns[ns.size() * 99 / 100];
    state.counters["max_ns"] = ns.back();
    state.counters["most_looked_at"] = looked_at;
    state.counters["cited_p50_ns"] = cited.taktwerk.p50;
    state.counters["cited_p99_ns"] = cited.taktwerk.p99;
    state.counters["cited_max_ns"] = cited.taktwerk.max;
    state.counters["cited_instructions"] = cited.taktwerk.instructions;
    state.counters["ruckig_p50_ns"] = cited.ruckig.p50;
    state.counters["ruckig_p99_ns"] = cited.ruckig.p99;
    state.counters["ruckig_max_ns"] = cited.ruckig.max;
    state.counters["ruckig_instructions"] = cited.ruckig.instructions;
    state.SetLabel("cited_ and ruckig_: one run on another machine, see the source");
}

void in_metres_rest_to_rest(benchmark::State& state) { time_plans(state, true, true, rest_to_rest); }
void in_metres_any_to_rest(benchmark::State& state) { time_plans(state, false, true, any_to_rest); }
void in_metres_any_to_any(benchmark::State& state) { time_plans(state, false, false, any_to_any); }
BENCHMARK(in_metres_rest_to_rest)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(in_metres_any_to_rest)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(in_metres_any_to_any)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace taktwerk::axes
