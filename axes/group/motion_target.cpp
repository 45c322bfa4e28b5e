#include "axes/group/motion_target.hpp"

#include <cmath>

#include "axes/group/written_pose.hpp"
#include "axes/kinematics/kinematics.hpp"

namespace taktwerk::axes {

bool has_all_joints(const Kinematics* arm, const GroupMembers& members) noexcept {
    if (arm == nullptr) return false;
    for (std::size_t i = 0; i < most_members; ++i)
        if (members.has(i) != (i < arm->joint_count())) return false;
    return true;
}

ErrorId refuse_frame(const GroupCommand& command, const Kinematics* arm, const GroupMembers& members) noexcept {
    if (command.frame == mcACS) return is_circular(command.kind) ? ErrorId::no_kinematics : ErrorId::none;
    if (command.frame > mcPCS_8) return ErrorId::invalid_parameter;
    if (!has_all_joints(arm, members)) return ErrorId::no_kinematics;
    return command.frame == mcFCS ? ErrorId::not_supported : ErrorId::none;
}

JointVector target_of(const GroupCommand& command, const JointVector& here, const GroupMembers& members) noexcept {
    JointVector target = here;
    if (command.frame != mcACS) return target;
    for (std::size_t i = 0; i < most_members; ++i)
        if (members.has(i)) target[i] = is_relative(command.kind) ? here[i] + command.target[i] : command.target[i];
    return target;
}

bool keeps_turn(const GroupCommand& command, const Kinematics& arm) noexcept {
    const auto which = arm.commands();
    const auto& target = command.target;
    return !(which[3] || which[4] || which[5]) && target[3] == 0 && target[4] == 0 && target[5] == 0;
}

namespace {

/// Of an absolute target: as it is told, but for turns that the arm does not command.
Pose goal_of(const GroupCommand& command, const CommandPlace& place, const Joints& near, const Kinematics& arm) noexcept {
    Pose goal = seen_through(place.frame, pose_of_six(command.target));
    if (keeps_turn(command, arm))
        if (const auto now = arm.forward(near, place.carried.tool); now.miss.ok()) goal.orientation = now.pose.orientation;
    return goal;
}

}  // namespace

ErrorId refuse_reach(const GroupCommand& command, const CommandPlace& place, const JointVector& here, const Kinematics* arm) noexcept {
    if (command.frame == mcACS || command.frame == mcTCS || is_relative(command.kind)) return ErrorId::none;
    Joints near{};
    for (std::size_t i = 0; i < max_joints; ++i) near[i] = here[i];
    const auto stand = arm->inverse(goal_of(command, place, near, *arm), place.carried.tool, command.wanted, near);
    if (stand.ok()) return ErrorId::none;
    return stand.miss.fault == KinematicFault::joint_limit ? ErrorId::beyond_software_limit : ErrorId::out_of_reach;
}

namespace {

void put_target(PathHindrance& at, const GroupCommand& command, const CommandPlace& place, const JointVector& here,
                const Kinematics& arm) noexcept {
    Joints near{};
    for (std::size_t i = 0; i < max_joints; ++i) near[i] = here[i];
    const Pose goal = goal_of(command, place, near, arm);
    at.in_space = true;
    at.point = goal.position;
    const auto stand = arm.inverse(goal, place.carried.tool, command.wanted, near);
    if (stand.miss.fault == KinematicFault::joint_limit && stand.miss.joint >= 0) at.place = static_cast<std::uint8_t>(stand.miss.joint);
}

}  // namespace

PathHindrance hindrance_of(ErrorId error, const GroupCommand& command, const CommandPlace& place, const JointVector& here,
                           const Kinematics* arm, const GroupMembers& members) noexcept {
    PathHindrance at;
    if (!goes_a_way(command.kind) || goes_stored_path(command.kind) || command.kind == GroupCommandKind::jog) return at;
    const bool of_target = error == ErrorId::beyond_software_limit || error == ErrorId::out_of_reach;
    if (of_target && command.frame != mcACS && command.frame != mcTCS && !is_relative(command.kind) && arm != nullptr)
        put_target(at, command, place, here, *arm);
    const auto target = target_of(command, here, members);
    for (std::size_t i = 0; i < most_members && at.place == PathHindrance::none; ++i) {
        if (!members.has(i)) continue;
        const auto& view = members.axis(i).view();
        const auto& limits = members.axis(i).config().limits;
        const bool outside = command.frame == mcACS && (target[i] > limits.position_max || target[i] < limits.position_min);
        const bool blamed = error == ErrorId::beyond_software_limit ? outside
                            : error == ErrorId::not_homed           ? members.axis(i).config().require_homed && !view.homed
                                                                    : error == ErrorId::not_powered && !view.powered;
        if (!blamed) continue;
        at.place = static_cast<std::uint8_t>(i);
        at.limit_known = outside && error == ErrorId::beyond_software_limit;
        at.position = target[i];
        at.limit = target[i] > limits.position_max ? limits.position_max : limits.position_min;
    }
    return at;
}

bool goes_nowhere(const GroupCommand& command, const JointVector& here, const GroupMembers& members) noexcept {
    return command.frame == mcACS && target_of(command, here, members) == here;
}

ErrorId refuse_target(const GroupCommand& command, const JointVector& target, const GroupMembers& members) noexcept {
    constexpr std::size_t pose_numbers = 6;
    if (command.frame != mcACS)
        for (std::size_t i = 0; i < pose_numbers; ++i)
            if (!std::isfinite(command.target[i])) return ErrorId::invalid_position;
    if (is_circular(command.kind))
        for (const double value : command.circle.aux)
            if (!std::isfinite(value)) return ErrorId::invalid_position;
    for (std::size_t i = 0; i < most_members; ++i) {
        if (!members.has(i)) continue;
        const auto& config = members.axis(i).config();
        const bool homed = members.axis(i).view().homed;
        if (!is_relative(command.kind) && config.require_homed && !homed) return ErrorId::not_homed;
        if (command.frame != mcACS) continue;
        if (!std::isfinite(command.target[i]) || !std::isfinite(target[i])) return ErrorId::invalid_position;
        if (homed && (target[i] > config.limits.position_max || target[i] < config.limits.position_min))
            return ErrorId::beyond_software_limit;
    }
    return ErrorId::none;
}

}  // namespace taktwerk::axes
