// What a moving group costs the cycle: time along the path, the arm's inverse with two derivatives, and six set-points that their axes check;
// beside it the tool's point for who reads it. Virtual time; what is measured is AxisGroup::plan() alone.

#include <algorithm>
#include <chrono>
#include <numbers>
#include <vector>

#include <benchmark/benchmark.h>

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr double degree = std::numbers::pi / 180;

std::vector<AxisConfig> turning(std::size_t count) {
    std::vector<AxisConfig> axes;
    for (std::size_t i = 0; i < count; ++i)
        axes.push_back(group_axis("a" + std::to_string(i), {.velocity = 360, .acceleration = 3600, .deceleration = 3600, .jerk = 72000}));
    return axes;
}

/// A usual robot of six joints, in mm and degrees.
Arm six_joints() {
    SixJoints six;
    six.geometry = WristArmLengths{.a1 = 100, .a2 = -100, .b = 0, .c1 = 600, .c2 = 600, .c3 = 600, .c4 = 100};
    KinematicsDescription description{.arm = six};
    for (auto& joint : description.joints) joint.unit = degree;
    return arm_of(description);
}

void run(benchmark::State& state, const Arm& arm, std::size_t count, const JointVector& stand, const JointVector& way) {
    // Each run has the same cycles: of each the least over all runs, so that the greatest is the work's and not the computer's.
    std::vector<double> seconds;
    for (auto _ : state) {
        std::size_t cycle = 0;
        GroupRig rig(turning(count), arm);
        rig.enable();
        const auto there = rig.give({.kind = GroupCommandKind::direct_absolute, .target = stand});
        (void)rig.until([&] { return rig.status(there.id) == CommandStatus::done; }, 5000);
        rig.run(3);
        GroupCommand move = line_by(way, 200);
        move.frame = mcMCS;
        const auto id = rig.give(move).id;
        for (int i = 0; i < 5000 && rig.status(id) != CommandStatus::done; ++i) {
            rig.now += GroupRig::cycle;
            for (auto& one : rig.axes) one.update(rig.now);
            rig.groups.update(rig.now);
            const auto begin = std::chrono::steady_clock::now();
            rig.groups.plan(rig.now, GroupRig::cycle);
            const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
            if (cycle == seconds.size()) seconds.push_back(took);
            seconds[cycle] = std::min(seconds[cycle], took);
            ++cycle;
            plan_axes(rig.axes, rig.now, GroupRig::cycle);
            for (auto& one : rig.axes) one.encode(rig.now);
            rig.groups.service();
        }
        if (rig.status(id) != CommandStatus::done) state.SkipWithError("the way was not gone");
    }
    std::sort(seconds.begin(), seconds.end());
    state.counters["p50_ns"] = 1e9 * seconds[seconds.size() / 2];
    state.counters["p99_ns"] = 1e9 * seconds[seconds.size() * 99 / 100];
    state.counters["max_ns"] = 1e9 * seconds.back();
}

void group_of_a_scara(benchmark::State& state) {
    KinematicsDescription description{.arm = ScaraLengths{.first = 200, .second = 150, .height = 0}};
    description.joints[0].unit = description.joints[1].unit = description.joints[3].unit = degree;
    run(state, arm_of(description), 4, {-30, 80, 0, 0}, {-20, 150, 5});
}
BENCHMARK(group_of_a_scara)->Unit(benchmark::kMillisecond);

void group_of_six_joints(benchmark::State& state) { run(state, six_joints(), 6, {10, 40, 70, 20, 50, 30}, {0, 300, 50}); }
BENCHMARK(group_of_six_joints)->Unit(benchmark::kMillisecond);

void group_of_a_portal(benchmark::State& state) {
    KinematicsDescription description{.arm = CartesianAxes{}};
    run(state, arm_of(description), 3, {1, 1, 1}, {200, 100, 50});
}
BENCHMARK(group_of_a_portal)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace taktwerk::axes::test
