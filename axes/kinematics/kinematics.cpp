#include "axes/kinematics/kinematics.hpp"

#include <algorithm>

#include "axes/kinematics/soundness.hpp"

namespace taktwerk::axes {
namespace {

constexpr double whole_turn = 2 * std::numbers::pi;

/// The turn that an angle is in; beyond what a number of turns holds, the last one (of what is no number, the lowest).
std::int8_t turn_of(double angle) noexcept {
    if (!(std::abs(angle) < 1e6)) return angle > 0 ? 127 : -127;
    const double whole = std::clamp(nearest_whole(angle * (1 / whole_turn)), -127.0, 127.0), rest = angle - whole_turn * whole;
    // A half belongs to the turn before.
    const int one_more = static_cast<int>(rest > whole_turn / 2) - static_cast<int>(rest <= -whole_turn / 2);
    return static_cast<std::int8_t>(std::clamp(static_cast<int>(whole) + one_more, -127, 127));
}

Miss outside(const JointSettings& s, std::size_t joint, double value) noexcept {
    if (value >= s.low && value <= s.high) return {};
    // A limit that is itself the result of some arithmetic does not fail by its last bits.
    const double beyond = std::max(s.low - value, value - s.high);
    return beyond > 1e-12 * (1 + std::abs(value)) ? Miss{KinematicFault::joint_limit, static_cast<int>(joint), beyond} : Miss{};
}

/// The whole turns away from `angle` that are nearest to `near` and within the limits, where there are some.
double turned_near(double angle, double near, const JointSettings& s) noexcept {
    const double best = angle + whole_turn * nearest_whole((near - angle) * (1 / whole_turn));
    if (best >= s.low && best <= s.high) return best;
    const double slack = 1e-12 * (1 + std::abs(best));
    if (best > s.high + slack) {
        const double below = best - whole_turn * std::ceil((best - s.high - slack) / whole_turn);
        return below >= s.low - slack ? below : best;
    }
    if (best < s.low - slack) {
        const double above = best + whole_turn * std::ceil((s.low - slack - best) / whole_turn);
        return above <= s.high + slack ? above : best;
    }
    return best;
}

}  // namespace

std::array<bool, 6> Kinematics::commands() const noexcept {
    return std::visit([](const auto& arm) { return arm.commands(); }, arm_);
}
bool Kinematics::closed_form() const noexcept {
    const auto* six = std::get_if<SixArm>(&arm_);
    return six == nullptr || six->closed_form();
}

bool Kinematics::may_not_close() const noexcept {
    return std::holds_alternative<RotaryDelta>(arm_) || std::holds_alternative<LinearDelta>(arm_);
}

ForwardResult Kinematics::forward(const Joints& axes, const Pose& tool) const noexcept {
    if (!finite(axes) || !sound(tool)) return {{}, {KinematicFault::not_finite}};
    const Joints arm = map_.arm_of(map_.joints_of(axes));
    double gap = 0;
    const Frame<double> flange = std::visit(
        [&](const auto& a) {
            if constexpr (requires { a.gap(arm); }) gap = a.gap(arm);
            return a.forward(arm);
        },
        arm_);
    if (gap > 0) return {{}, {KinematicFault::does_not_close, -1, gap}};
    return {pose_of(base_ * flange * frame_of_scaled(tool)), {}};
}

Miss Kinematics::to_flange(const Pose& tool_point, const Pose& tool, Frame<double>& flange) const noexcept {
    if (!sound(tool_point) || !sound(tool)) return {KinematicFault::not_finite};
    flange = to_base_ * frame_of_scaled(tool_point) * inverse_of(frame_of_scaled(tool));
    return {};
}

AxisSolution Kinematics::placed(const ArmSolution& way, const Configuration& wanted, const Joints& near_joints) const noexcept {
    AxisSolution s;
    s.configuration.branch = way.branch;
    Joints joints = map_.joints_of_arm(way.joints);
    for (std::size_t i = 0; i < max_joints; ++i) {
        s.configuration.turns[i] = 0;
        if (i >= joint_count_) {
            joints[i] = 0;
            continue;
        }
        if (rotary_[i]) {
            const std::int8_t asked = wanted.turns[i];
            joints[i] = asked == any_turn ? turned_near(joints[i], near_joints[i], map_.settings(i))
                                          : joints[i] + whole_turn * (static_cast<double>(asked) - turn_of(joints[i]));
            s.configuration.turns[i] = turn_of(joints[i]);
        }
        const Miss miss = outside(map_.settings(i), i, joints[i]);
        if (!miss.ok() && (s.miss.ok() || miss.amount > s.miss.amount)) s.miss = miss;
    }
    s.axes = map_.axes_of(joints);
    return s;
}

double Kinematics::way_between(const Joints& a, const Joints& b) const noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < joint_count_; ++i) {
        const double way = (a[i] - b[i]) / (rotary_[i] ? 1 : reach_);
        sum += way * way;
    }
    return sum;
}

AxisSolution Kinematics::inverse(const Pose& tool_point, const Pose& tool, const Configuration& wanted, const Joints& near) const noexcept {
    AxisSolution best;
    Frame<double> flange;
    best.miss = finite(near) ? to_flange(tool_point, tool, flange) : Miss{KinematicFault::not_finite};
    if (!best.miss.ok()) return best;
    const Joints near_joints = map_.joints_of(near), near_arm = map_.arm_of(near_joints);
    const ArmSolutions ways = std::visit(
        [&](const auto& arm) {
            if constexpr (requires { arm.solve_one(flange, wanted.branch, near_arm); })
                return arm.solve_one(flange, wanted.branch, near_arm);
            else return arm.solve(flange, near_arm);
        },
        arm_);
    best.miss = ways.count > 0 ? Miss{KinematicFault::other_branch} : ways.miss;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < ways.count; ++i) {
        const ArmSolution& way = ways.at[static_cast<std::size_t>(i)];
        if (!answers(way.branch, wanted.branch)) continue;
        const AxisSolution s = placed(way, wanted, near_joints);
        const double far = way_between(map_.joints_of(s.axes), near_joints);
        // One within the limits before one that is not; of those, the one that misses by least.
        const bool better = s.ok() ? !best.ok() || far < least
                                   : !best.ok() && (best.miss.fault != KinematicFault::joint_limit || s.miss.amount < best.miss.amount);
        if (!better) continue;
        best = s;
        least = far;
    }
    return best;
}

AllAxisSolutions Kinematics::inverse_all(const Pose& tool_point, const Pose& tool, const Joints& near) const noexcept {
    AllAxisSolutions all;
    Frame<double> flange;
    all.miss = finite(near) ? to_flange(tool_point, tool, flange) : Miss{KinematicFault::not_finite};
    if (!all.miss.ok()) return all;
    const Joints near_joints = map_.joints_of(near), near_arm = map_.arm_of(near_joints);
    const ArmSolutions ways = std::visit([&](const auto& arm) { return arm.solve(flange, near_arm); }, arm_);
    all.count = ways.count;
    if (ways.count == 0) all.miss = ways.miss;
    for (std::size_t i = 0; i < static_cast<std::size_t>(ways.count); ++i) all.at[i] = placed(ways.at[i], {}, near_joints);
    return all;
}

Configuration Kinematics::configuration(const Joints& axes) const noexcept {
    const Joints joints = map_.joints_of(axes), arm = map_.arm_of(joints);
    Configuration c;
    c.branch = std::visit([&](const auto& a) { return a.branch(arm); }, arm_);
    for (std::size_t i = 0; i < max_joints; ++i) c.turns[i] = i < joint_count_ && rotary_[i] ? turn_of(joints[i]) : std::int8_t{0};
    return c;
}

Singularity Kinematics::singularity(const Joints& axes) const noexcept {
    const Joints arm = map_.arm_of(map_.joints_of(axes));
    return std::visit([&](const auto& a) { return a.singularity(arm); }, arm_);
}

Miss Kinematics::limits_of(const Joints& axes) const noexcept {
    const Joints joints = map_.joints_of(axes);
    for (std::size_t i = 0; i < joint_count_; ++i)
        if (const Miss miss = outside(map_.settings(i), i, joints[i]); !miss.ok()) return miss;
    return {};
}

double Kinematics::skew(const Joints& axes) const noexcept {
    return std::holds_alternative<BeamGantry>(arm_) ? BeamGantry::skew(map_.arm_of(map_.joints_of(axes))) : 0;
}

}  // namespace taktwerk::axes
