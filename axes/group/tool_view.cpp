#include "axes/group/tool_view.hpp"

#include "axes/group/group_arm.hpp"
#include "axes/group/written_pose.hpp"
#include "axes/kinematics/kinematics.hpp"

namespace taktwerk::axes {
namespace {

Joints first_of(const JointVector& values) noexcept {
    Joints joints{};
    for (std::size_t i = 0; i < max_joints; ++i) joints[i] = values[i];
    return joints;
}

std::array<double, 6> velocity_of(const Kinematics& arm, const Pose& tool, const JointVector& at, const JointVector& velocity) noexcept {
    Eigen::Matrix<double, 6, 1> q;
    for (std::size_t i = 0; i < max_joints; ++i) q[static_cast<Eigen::Index>(i)] = i < arm.joint_count() ? velocity[i] : 0;
    const Eigen::Matrix<double, 6, 1> v = arm.jacobian(first_of(at), tool) * q;
    return {v[0], v[1], v[2], v[3], v[4], v[5]};
}

}  // namespace

std::array<bool, 6> commands_of(const Kinematics& arm) noexcept { return arm.commands(); }

void see_tool(GroupView& view, const Kinematics* arm, const Pose& tool) noexcept {
    view.tool_known = false;
    if (arm == nullptr || !view.kinematics) return;
    const auto set = arm->forward(first_of(view.set_position), tool), actual = arm->forward(first_of(view.actual_position), tool);
    const auto commanded = arm->forward(first_of(view.commanded), tool);
    if (!set.miss.ok() || !actual.miss.ok() || !commanded.miss.ok()) return;
    view.tool_known = true;
    view.tool_set = numbers_of(set.pose);
    view.tool_actual = numbers_of(actual.pose);
    view.tool_commanded = numbers_of(commanded.pose);
    view.tool_velocity = velocity_of(*arm, tool, view.set_position, view.set_velocity);
    view.tool_actual_velocity = velocity_of(*arm, tool, view.actual_position, view.actual_velocity);
}

}  // namespace taktwerk::axes
