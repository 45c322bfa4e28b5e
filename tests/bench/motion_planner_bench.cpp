// What a plan and a sample cost: p50, p99 and max per plan over a million different motions, mean per sample.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

#include <benchmark/benchmark.h>

#include "tests/axes/planner/random_states.hpp"

namespace taktwerk::axes {
namespace {

constexpr std::size_t million = 1'000'000;

struct TimedCase {
    StateCase motion;
    double duration = 0;
};

enum class Ends { at_rest, to_rest, any, in_time };

/// Finite limits; for fixed times twice the fastest, where that has a solution.
std::vector<TimedCase> motions(Ends ends) {
    RandomStates random{11};
    std::vector<TimedCase> cases;
    cases.reserve(million);
    while (cases.size() < million) {
        StateCase c = random.next();
        bool finite = true;
        for (const SignLimits* s : {&c.limits.positive, &c.limits.negative})
            finite =
                finite && !std::isinf(s->velocity) && !std::isinf(s->speeding_up) && !std::isinf(s->slowing_down) && !std::isinf(s->jerk);
        if (!finite || c.from.position == c.target.position) continue;
        if (ends == Ends::at_rest || ends == Ends::to_rest) c.target.velocity = c.target.acceleration = 0;
        if (ends == Ends::at_rest) c.from.velocity = c.from.acceleration = 0;
        TimedCase timed{c, 0};
        if (ends == Ends::in_time) {
            timed.duration = 2 * plan_to_state(c.from, c.target, c.limits).profile.duration();
            if (plan_in_time(c.from, c.target, timed.duration, c.limits).error != PlanError::none) continue;
        }
        cases.push_back(timed);
    }
    return cases;
}

/// Each plan is timed by itself; the clock's own cost (some 20 ns) is in the figures.
template <typename Solve>
void time_plans(benchmark::State& state, Ends ends, Solve solve) {
    const std::vector<TimedCase> cases = motions(ends);
    std::vector<double> ns;
    ns.reserve(million);
    for (auto _ : state) {
        for (const TimedCase& c : cases) {
            const auto begin = std::chrono::steady_clock::now();
            Plan plan = solve(c);
            benchmark::DoNotOptimize(plan);
            const auto end = std::chrono::steady_clock::now();
            ns.push_back(std::chrono::duration<double, std::nano>(end - begin).count());
        }
    }
    std::sort(ns.begin(), ns.end());
    state.counters["p50_ns"] = ns[ns.size() / 2];
    state.counters["p99_ns"] = ns[ns.size() * 99 / 100];
    state.counters["p99.99_ns"] = ns[ns.size() * 9999 / 10000];
    state.counters["max_ns"] = ns.back();
}

Plan to_state(const TimedCase& c) { return plan_to_state(c.motion.from, c.motion.target, c.motion.limits); }

void plan_rest_to_rest(benchmark::State& state) { time_plans(state, Ends::at_rest, to_state); }
void plan_any_state_to_rest(benchmark::State& state) { time_plans(state, Ends::to_rest, to_state); }
void plan_any_state_to_any_state(benchmark::State& state) { time_plans(state, Ends::any, to_state); }
void plan_in_given_time(benchmark::State& state) {
    time_plans(state, Ends::in_time,
               [](const TimedCase& c) { return plan_in_time(c.motion.from, c.motion.target, c.duration, c.motion.limits); });
}
BENCHMARK(plan_rest_to_rest)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(plan_any_state_to_rest)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(plan_any_state_to_any_state)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(plan_in_given_time)->Iterations(1)->Unit(benchmark::kMillisecond);

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
