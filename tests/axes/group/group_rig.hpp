#pragma once
// A group of axes on fake drives in virtual time, as a machine runs them, with an oracle of what must hold of every member in every cycle.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "axes/axis/plan_order.hpp"
#include "axes/group/axis_groups.hpp"
#include "axes/group/workspace.hpp"
#include "axes/kinematics/kinematics.hpp"
#include "tests/axes/axis/axis_rig.hpp"
#include "tests/axes/axis/motion_oracle.hpp"

namespace taktwerk::axes::test {

/// 1000 counts per u; 100 u/s, 1000 u/s2, 10000 u/s3: hand calculations stay short.
inline AxisConfig group_axis(const std::string& name,
                             AxisLimits limits = {.velocity = 100, .acceleration = 1000, .deceleration = 1000, .jerk = 10000}) {
    auto config = plain_axis();
    config.name = name;
    config.limits = limits;
    config.require_homed = false;
    return config;
}

using Arm = std::shared_ptr<const Kinematics>;
/// Rooms of a group's tool; none: it may be anywhere.
using Rooms = std::vector<WorkspaceRoom>;
inline Arm arm_of(const KinematicsDescription& description) {
    auto made = Kinematics::make(description);
    EXPECT_TRUE(made.ok());
    return made.ok() ? std::make_shared<const Kinematics>(made.value()) : nullptr;
}
/// Members 1 to 3 are X, Y, Z.
inline Arm cartesian_arm() { return arm_of({.arm = CartesianAxes{}}); }

struct GroupRig {
    static constexpr Duration cycle = 1ms;
    static constexpr GroupRef ref{0};

    /// One group "g" of all axes; it is not enabled yet.
    explicit GroupRig(std::vector<AxisConfig> configs, Arm kinematics = {}, const Rooms& rooms = {})
        : GroupRig(configs, all_of(configs, kinematics, rooms)) {}
    explicit GroupRig(std::size_t count, Arm kinematics = {}) : GroupRig(named(count), kinematics) {}
    GroupRig(const std::vector<AxisConfig>& configs, const std::vector<AxisGroupConfig>& grouped,
             std::vector<std::unique_ptr<PathMaker>> paths = {}) {
        for (std::size_t i = 0; i < configs.size(); ++i) drives.push_back(std::make_unique<FakeDrive>(cycle));
        axes.reserve(configs.size());
        for (std::size_t i = 0; i < configs.size(); ++i) {
            axes.emplace_back(configs[i], *drives[i], cycle, static_cast<std::uint16_t>(i));
            oracles.emplace_back(configs[i], cycle);
        }
        for (auto& axis : axes) axis.bind({axes.data(), axes.size(), nullptr, {}});
        powered.assign(configs.size(), true);
        before.resize(configs.size());
        groups.build(grouped, axes, cycle, std::move(paths));
        for (int i = 0; i < 30; ++i) step();
        for (std::size_t i = 0; i < axes.size(); ++i)
            EXPECT_EQ(axis(i).state, axes[i].config().encoder ? AxisState::Disabled : AxisState::Standstill) << i;
    }
    GroupRig(const GroupRig&) = delete;
    GroupRig& operator=(const GroupRig&) = delete;
    /// Whatever a test is about: what must always hold held.
    ~GroupRig() {
        for (const auto& oracle : oracles) EXPECT_TRUE(oracle.clean()) << oracle.report();
    }

    static std::vector<AxisConfig> named(std::size_t count) {
        std::vector<AxisConfig> configs;
        for (std::size_t i = 0; i < count; ++i) configs.push_back(group_axis("a" + std::to_string(i)));
        return configs;
    }
    static std::vector<AxisGroupConfig> all_of(const std::vector<AxisConfig>& configs, Arm kinematics, const Rooms& rooms = {}) {
        AxisGroupConfig group{.name = "g", .members = {}, .kinematics = kinematics};
        if (!rooms.empty()) group.workspace = std::make_shared<const Workspace>(Workspace{rooms});
        for (const auto& config : configs) group.members.push_back(config.name);
        return {group};
    }

    /// One cycle; `program` runs where tasks do.
    void step(const std::function<void()>& program = {}) {
        now += cycle;
        for (auto& one : axes) one.update(now);
        for (auto& one : axes) one.supervise(now);
        for (auto& one : axes)
            for (AlarmFact fact; one.fetch_alarm(fact);) {}
        groups.update(now);
        for (std::size_t i = 0; i < axes.size(); ++i)
            if (powered[i] && !axes[i].config().encoder) (void)axes[i].power(true, true, true, Owner::program);
        if (program) program();
        groups.plan(now, cycle);
        plan_axes(axes, now, cycle);
        for (std::size_t i = 0; i < axes.size(); ++i) {
            axes[i].encode(now);
            oracles[i].observe(axes[i].view(), axes[i].drive_command(), axes[i].config().limits);
            look(i);
        }
        path.push_back(point());
        if (path.size() % served_every == 0) groups.service();
    }
    bool until(const std::function<bool()>& condition, int most) {
        for (int i = 0; i < most && !condition(); ++i) step();
        return condition();
    }
    void run(int cycles) {
        for (int i = 0; i < cycles; ++i) step();
    }

    /// Stricter than the oracle, for set-points of a group: continuous in position, velocity and acceleration, inside the axis' limits.
    void look(std::size_t i) {
        const auto& view = axis(i);
        const auto& limits = axes[i].config().limits;
        const double t = to_seconds(cycle);
        const MotionState now_at{view.set_position, view.set_velocity, view.set_acceleration};
        auto& last = before[i];
        const bool led = view.active_kind == CommandKind::group_motion && groups[0].view().has(i);  // by the first group
        if (led && last.led) {
            const auto& from = last.at;
            const double grain = 1e-9;
            EXPECT_LE(std::abs(now_at.velocity), limits.velocity * (1 + 1e-6)) << view_of(i);
            EXPECT_LE(std::abs(now_at.acceleration), std::max(limits.acceleration, limits.deceleration) * (1 + 1e-6)) << view_of(i);
            // What trembles has whatever jerk it has: then the velocity is held to the acceleration, and the place to the velocity.
            const double most = std::max(limits.acceleration, limits.deceleration);
            const double jerk = trembles ? 2 * most / t : limits.jerk;
            EXPECT_LE(std::abs(now_at.velocity - from.velocity), most * t * (1 + 1e-6) + grain) << view_of(i);
            EXPECT_LE(std::abs(now_at.acceleration - from.acceleration), jerk * t * (1 + 1e-3) + grain) << view_of(i);
            EXPECT_LE(std::abs(now_at.velocity - from.velocity - t * (now_at.acceleration + from.acceleration) / 2),
                      jerk * t * t / 2 + grain)
                << view_of(i);
            EXPECT_LE(std::abs(now_at.position - from.position - t * (now_at.velocity + from.velocity) / 2), jerk * t * t * t / 4 + grain)
                << view_of(i);
            // Told is shown: the group's view, the axis' view, and (by its oracle) the drive.
            // But for the last digit that the axis' own coordinates cost.
            EXPECT_NEAR(groups[0].view().set_position[i], now_at.position, 1e-15 * std::max(100.0, std::abs(now_at.position)))
                << view_of(i);
            EXPECT_EQ(groups[0].view().set_velocity[i], now_at.velocity) << view_of(i);
        }
        last = {now_at, led};
    }
    std::string view_of(std::size_t i) const { return "axis " + std::to_string(i) + " in cycle " + std::to_string(path.size()); }

    Submitted submit(const GroupCommand& command) { return groups.submit(ref, command, Owner::program); }
    ErrorId set(const GroupSetting& setting) { return groups.set(ref, setting, Owner::program); }
    void enable() { ASSERT_EQ(set(EnableGroup{}), ErrorId::none); }
    /// Runs one cycle in which it is submitted.
    Submitted give(const GroupCommand& command) {
        Submitted answer;
        step([&] { answer = submit(command); });
        return answer;
    }
    CommandStatus status(CommandId id) const { return view().status(id); }
    ErrorId error_of(CommandId id) const {
        ErrorId error = ErrorId::none;
        (void)view().status(id, &error);
        return error;
    }

    const GroupView& view() const { return *groups.view(ref); }
    const AxisView& axis(std::size_t i) const { return axes[i].view(); }
    JointVector point() const {
        JointVector at{};
        for (std::size_t i = 0; i < axes.size(); ++i) at[i] = axes[i].view().set_position;
        return at;
    }
    /// Largest distance of the members' places since `from` (a cycle of `path`) from the straight line a..b.
    double deviation(const JointVector& a, const JointVector& b, std::size_t from = 0) const {
        double worst = 0;
        double length2 = 0;
        for (std::size_t k = 0; k < axes.size(); ++k) length2 += (b[k] - a[k]) * (b[k] - a[k]);
        for (std::size_t n = from; n < path.size(); ++n) {
            double along = 0, square = 0;
            for (std::size_t k = 0; k < axes.size(); ++k) along += (path[n][k] - a[k]) * (b[k] - a[k]) / length2;
            for (std::size_t k = 0; k < axes.size(); ++k) {
                const double off = path[n][k] - (a[k] + along * (b[k] - a[k]));
                square += off * off;
            }
            worst = std::max(worst, std::sqrt(square));
        }
        return worst;
    }

    std::size_t served_every = 1;  ///< cycles
    bool trembles = false;         ///< what is followed is measured
    Instant now{};
    std::vector<std::unique_ptr<FakeDrive>> drives;
    std::vector<Axis> axes;
    std::vector<MotionOracle> oracles;
    std::vector<bool> powered;
    AxisGroups groups;
    std::vector<JointVector> path;  ///< set positions, a cycle each
    struct Before {
        MotionState at{};
        bool led = false;
    };
    std::vector<Before> before;
};

inline GroupCommand line(const JointVector& target, double velocity, MC_BufferMode mode = mcAborting) {
    return {.kind = GroupCommandKind::linear_absolute, .buffer_mode = mode, .target = target, .dynamics = {.velocity = velocity}};
}
inline GroupCommand line_by(const JointVector& distance, double velocity, MC_BufferMode mode = mcAborting) {
    return {.kind = GroupCommandKind::linear_relative, .buffer_mode = mode, .target = distance, .dynamics = {.velocity = velocity}};
}
inline GroupCommand simply(GroupCommandKind kind, PathDynamics dynamics = {}) { return {.kind = kind, .dynamics = dynamics}; }

}  // namespace taktwerk::axes::test
