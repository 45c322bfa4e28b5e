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

}  // namespace

std::array<bool, 6> commands_of(const Kinematics& arm) noexcept { return arm.commands(); }

void see_tool(GroupView& view, const Kinematics* arm, const Pose& tool) noexcept {
    view.tool_known = false;
    if (arm == nullptr || !view.kinematics) return;
    const auto set = arm->moving(first_of(view.set_position), first_of(view.set_velocity), tool);
    const auto actual = arm->moving(first_of(view.actual_position), first_of(view.actual_velocity), tool);
    const auto commanded = arm->forward(first_of(view.commanded), tool);
    if (!set.miss.ok() || !actual.miss.ok() || !commanded.miss.ok()) return;
    view.tool_known = true;
    view.tool_set = numbers_of(set.pose);
    view.tool_actual = numbers_of(actual.pose);
    view.tool_commanded = numbers_of(commanded.pose);
    view.tool_velocity = set.velocity;
    view.tool_actual_velocity = actual.velocity;
}

}  // namespace taktwerk::axes
