// What coordinated motion costs: planning per segment of a stretch of 1,000 short lines, as G-code has them, and one cycle along a path.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "axes/path_time/path_player.hpp"
#include "axes/path_time/path_service.hpp"
#include "tests/axes/path_time/path_curve.hpp"
#include "tests/axes/path_time/random_program.hpp"

namespace taktwerk::axes {
namespace {

const std::vector<PathAxisLimits> limits(3, PathAxisLimits{500, 5000, 100000});  // mm: 0.5 m/s, 5 m/s2, 100 m/s3

/// A wavy contour in lines of about 1 mm, corners rounded within 0.01 mm; every hundredth corner is sharp.
Path contour(int segments) {
    Path path;
    PathVector at = PathVector::Zero();
    double heading = 0;
    for (int i = 0; i < segments; ++i) {
        heading += 0.1 * std::sin(0.05 * i) + (i % 100 == 99 ? 1.3 : 0);
        PathVector next = at;
        next.head<2>() += Eigen::Vector2d(std::cos(heading), std::sin(heading));
        PathMove move;
        move.element = PathElement::line(at, next);
        move.feed = {200, 3000, 3000, 60000};
        if (!path.append(move, {BlendRule::corner_deviation, 0.01}).ok()) break;
        at = next;
    }
    return path;
}

void set_times(benchmark::State& state, std::vector<double>& seconds) {
    std::sort(seconds.begin(), seconds.end());
    state.counters["p50_ns"] = 1e9 * seconds[seconds.size() / 2];
    state.counters["p99_ns"] = 1e9 * seconds[seconds.size() * 99 / 100];
    state.counters["max_ns"] = 1e9 * seconds.back();
}

/// 1,000 segments in one plan; each is a line and the curve behind it.
void plan_thousand_segments(benchmark::State& state) {
    const Path path = contour(1000);
    const PathCurve curve(path, 3);
    RunPlanner planner;
    RunPlan plan;
    double duration = 0;
    for (auto _ : state) {
        planner.plan(curve, limits, {0, path.length(), 0, 0, 1}, plan);
        duration = plan.duration;
    }
    state.counters["us_per_segment"] =
        benchmark::Counter(1e3, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert, benchmark::Counter::kIs1000);
    state.counters["cells"] = plan.cells;
    state.counters["steps"] = plan.steps;
    state.counters["found"] = plan.found;
    state.counters["path_s"] = duration;
}
BENCHMARK(plan_thousand_segments)->Unit(benchmark::kMillisecond);

/// The same path as it is fed to a machine that runs: 200 segments ahead of where it is, 20 more at a time. The cycles are
/// counted with it: some 2 us a segment.
void feed_thousand_segments(benchmark::State& state) {
    const Path path = contour(1000);
    const PathCurve curve(path, 3);
    constexpr std::size_t ahead = 200, batch = 20;
    double duration = 0;
    std::size_t stretches = 0;
    for (auto _ : state) {
        const auto exchange = std::make_unique<StretchExchange>();
        PathPlayer player(*exchange);
        PathService service(limits, *exchange, 0.02);
        std::size_t known = std::min(ahead, path.sections().size());
        double time = 0;
        for (bool arrived = false; !arrived && time < 600; time += 0.01) {
            if (path.index_at(player.now().s) + ahead >= known + batch) known = std::min(known + batch, path.sections().size());
            stretches += service.step(curve, path.sections()[known - 1].end(), {}) == PathAnswer::offered ? 1 : 0;
            for (int i = 0; i < 10; ++i) (void)player.step(1e-3);
            arrived = player.standing() && player.now().s >= path.length() * (1 - 1e-9);
        }
        duration = time;
    }
    state.counters["us_per_segment"] =
        benchmark::Counter(1e3, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert, benchmark::Counter::kIs1000);
    state.counters["stretches"] = static_cast<double>(stretches) / static_cast<double>(state.iterations());
    state.counters["path_s"] = duration;
}
BENCHMARK(feed_thousand_segments)->Unit(benchmark::kMillisecond);

void accept_a_move(benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(contour(1000));
    state.counters["us_per_move"] = benchmark::Counter(1e3, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(accept_a_move)->Unit(benchmark::kMillisecond);

/// s(t) and the point of the path with three derivatives, per cycle of 1 ms.
void one_cycle(benchmark::State& state) {
    const Path path = contour(400);
    const PathCurve curve(path, 3);
    RunPlanner planner;
    RunPlan plan;
    planner.plan(curve, limits, {0, path.length(), 0, 0, 1}, plan);
    std::vector<double> seconds;
    for (auto _ : state) {
        const auto exchange = std::make_unique<StretchExchange>();
        PathPlayer player(*exchange);
        TimeStretch* stretch = exchange->free_stretch();
        stretch->id = 1;
        stretch->count = static_cast<int>(std::min<std::size_t>(plan.pieces.size(), TimeStretch::most_pieces));
        std::copy_n(plan.pieces.begin(), stretch->count, stretch->pieces.begin());
        exchange->offer();
        do {
            const auto begin = std::chrono::steady_clock::now();
            const PathMotion& m = player.step(1e-3);
            benchmark::DoNotOptimize(path.sections()[player.part()].at(m.s));
            seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
        } while (!player.standing());
    }
    set_times(state, seconds);
}
BENCHMARK(one_cycle)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace taktwerk::axes
