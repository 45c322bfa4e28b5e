// What an arm's kinematics cost: p50, p99 and max of each call over 50,000 different poses, singular ones among them; of each pose the least of
// seven passes, which a busy computer disturbs less.

#include <algorithm>
#include <chrono>
#include <limits>
#include <vector>

#include <benchmark/benchmark.h>

#include "tests/axes/kinematics/pose_difference.hpp"
#include "tests/axes/kinematics/random_stands.hpp"

namespace taktwerk::axes {
namespace {

constexpr std::size_t poses = 50'000;
constexpr int passes = 7;

struct TimedPose {
    Joints axes;
    Joints before;  ///< a cycle earlier
    Pose pose;
    Configuration configuration;
};

struct Timed {
    Kinematics kinematics;
    Pose tool = posed(.05, -.02, .11, .3, -.2, .9);
    std::vector<TimedPose> cases;

    explicit Timed(const PublishedArm& arm) : kinematics{made(arm)} {
        RandomStands random{23};
        while (cases.size() < poses) {
            TimedPose c;
            c.before = c.axes = random.next(arm, kinematics.rotary());
            for (double& q : c.before) q += random.uniform(-.005, .005);
            const ForwardResult there = kinematics.forward(c.axes, tool);
            if (!there.miss.ok()) continue;
            c.pose = there.pose;
            c.configuration = kinematics.configuration(c.axes);
            c.configuration.turns.fill(any_turn);
            cases.push_back(c);
        }
    }
};

/// Each call is timed by itself; the clock's own cost (20 to 40 ns) is in the figures. The pose is fetched before: a cycle has just computed it,
/// whereas these come from further away than any cache that is near.
template <class Call>
void time_calls(benchmark::State& state, const PublishedArm& arm, Call call) {
    const Timed timed{arm};
    std::vector<double> ns(poses, std::numeric_limits<double>::infinity());
    for (auto _ : state) {
        for (int pass = 0; pass < passes; ++pass)
            for (std::size_t i = 0; i < poses; ++i) {
                TimedPose pose = timed.cases[i];
                benchmark::DoNotOptimize(pose);
                const auto begin = std::chrono::steady_clock::now();
                auto result = call(timed.kinematics, timed.tool, pose);
                benchmark::DoNotOptimize(result);
                const auto end = std::chrono::steady_clock::now();
                ns[i] = std::min(ns[i], std::chrono::duration<double, std::nano>(end - begin).count());
            }
    }
    std::sort(ns.begin(), ns.end());
    state.counters["p50_ns"] = ns[ns.size() / 2];
    state.counters["p99_ns"] = ns[ns.size() * 99 / 100];
    state.counters["max_ns"] = ns.back();
}

const auto forward = [](const Kinematics& k, const Pose& tool, const TimedPose& c) { return k.forward(c.axes, tool); };
const auto all_ways = [](const Kinematics& k, const Pose& tool, const TimedPose& c) { return k.inverse_all(c.pose, tool, c.before); };
const auto one_way = [](const Kinematics& k, const Pose& tool, const TimedPose& c) {
    return k.inverse(c.pose, tool, c.configuration, c.before);
};
const auto jacobian = [](const Kinematics& k, const Pose& tool, const TimedPose& c) { return k.jacobian(c.axes, tool); };
const auto derivatives = [](const Kinematics& k, const Pose& tool, const TimedPose& c) {
    return k.derivatives(c.axes, tool, {{{{.1, .2, .3}, {.1, 0, .1}, {0, .1, 0}}}, {{{.1, .2, .3}, {.1, 0, .1}, {0, .1, 0}}}});
};

BENCHMARK_CAPTURE(time_calls, six_joints_forward, irb_120(), forward)->Iterations(1);
BENCHMARK_CAPTURE(time_calls, six_joints_all_ways, irb_120(), all_ways)->Iterations(1);
BENCHMARK_CAPTURE(time_calls, six_joints_one_way, irb_120(), one_way)->Iterations(1);
BENCHMARK_CAPTURE(time_calls, six_joints_jacobian, irb_120(), jacobian)->Iterations(1);
BENCHMARK_CAPTURE(time_calls, six_joints_path_derivatives, irb_120(), derivatives)->Iterations(1);
BENCHMARK_CAPTURE(time_calls, three_parallel_axes_all_ways, ur5e(), all_ways)->Iterations(1);
BENCHMARK_CAPTURE(time_calls, calibrated_one_way_numeric, calibrated(irb_120()), one_way)->Iterations(1);
BENCHMARK_CAPTURE(time_calls, calibrated_parallel_one_way_numeric, calibrated(ur5e()), one_way)->Iterations(1);
BENCHMARK_CAPTURE(time_calls, offset_wrist_one_way_numeric, crx_10ia(), one_way)->Iterations(1);
BENCHMARK_CAPTURE(time_calls, offset_wrist_all_ways_numeric, crx_10ia(), all_ways)->Iterations(1);
BENCHMARK_CAPTURE(time_calls, scara_one_way, epson_g10(), one_way)->Iterations(1);
BENCHMARK_CAPTURE(time_calls, palletizer_one_way, irb_460(), one_way)->Iterations(1);
BENCHMARK_CAPTURE(time_calls, rotary_delta_one_way, flexpicker(), one_way)->Iterations(1);
BENCHMARK_CAPTURE(time_calls, rotary_delta_path_derivatives, flexpicker(), derivatives)->Iterations(1);
BENCHMARK_CAPTURE(time_calls, linear_delta_one_way, linear_delta(), one_way)->Iterations(1);
BENCHMARK_CAPTURE(time_calls, core_xy_one_way, core_xy(), one_way)->Iterations(1);

}  // namespace
}  // namespace taktwerk::axes
