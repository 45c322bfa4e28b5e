// What a plan and a sample cost: p50, p99 and max per plan over many different motions, mean per sample.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

#include <benchmark/benchmark.h>

#include "tests/axes/planner/random_motion.hpp"

namespace taktwerk::axes {
namespace {

std::vector<MotionCase> motions(bool at_rest) {
    RandomMotion random{11};
    std::vector<MotionCase> cases;
    while (cases.size() < 4096) {
        MotionCase c = random.next();
        if (at_rest) c.from.velocity = c.from.acceleration = 0;
        if (!std::isinf(c.limits.jerk) && c.from.position != c.target) cases.push_back(c);
    }
    return cases;
}

/// Each plan is timed by itself; the clock's own cost (some 20 ns) is in the figures.
void time_plans(benchmark::State& state, const std::vector<MotionCase>& cases) {
    std::vector<double> ns;
    ns.reserve(std::size_t{1} << 22);
    std::size_t i = 0;
    for (auto _ : state) {
        const MotionCase& c = cases[i++ % cases.size()];
        const auto begin = std::chrono::steady_clock::now();
        Plan plan = plan_to_position(c.from, c.target, c.limits);
        benchmark::DoNotOptimize(plan);
        const auto end = std::chrono::steady_clock::now();
        if (ns.size() < ns.capacity()) ns.push_back(std::chrono::duration<double, std::nano>(end - begin).count());
    }
    std::sort(ns.begin(), ns.end());
    state.counters["p50_ns"] = ns[ns.size() / 2];
    state.counters["p99_ns"] = ns[ns.size() * 99 / 100];
    state.counters["max_ns"] = ns.back();
}

void plan_rest_to_rest(benchmark::State& state) { time_plans(state, motions(true)); }
void plan_from_any_state(benchmark::State& state) { time_plans(state, motions(false)); }
BENCHMARK(plan_rest_to_rest);
BENCHMARK(plan_from_any_state);

void sample_profile(benchmark::State& state) {
    const Profile profile = plan_to_position({}, 10, {10, 20, 40, 200}).profile;  // all seven pieces
    const double step = profile.duration() / 1000;
    double t = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(profile.at(t));
        t = t < profile.duration() ? t + step : 0;
    }
}
BENCHMARK(sample_profile);

}  // namespace
}  // namespace taktwerk::axes
