#include "axes/group/tool_view.hpp"

#include <cmath>

#include "axes/group/group_arm.hpp"
#include "axes/kinematics/kinematics.hpp"
#include "axes/pose_math.hpp"

namespace taktwerk::axes {
namespace {

Joints first_of(const JointVector& values) noexcept {
    Joints joints{};
    for (std::size_t i = 0; i < max_joints; ++i) joints[i] = values[i];
    return joints;
}

/// Turns about z, the new y, the new x; where the second one is a right angle the third is 0.
std::array<double, 6> six_of(const Pose& pose) noexcept {
    const Eigen::Matrix3d r = orientation_of(pose).toRotationMatrix();
    const double level = std::hypot(r(0, 0), r(1, 0));
    constexpr double upright = 1e-12;
    const double ry = std::atan2(-r(2, 0), level);
    const double rx = level > upright ? std::atan2(r(2, 1), r(2, 2)) : 0;
    const double rz = level > upright ? std::atan2(r(1, 0), r(0, 0)) : std::atan2(-r(0, 1), r(1, 1));
    return {pose.position[0], pose.position[1], pose.position[2], rx, ry, rz};
}

std::array<double, 6> velocity_of(const Kinematics& arm, const JointVector& at, const JointVector& velocity) noexcept {
    Eigen::Matrix<double, 6, 1> q;
    for (std::size_t i = 0; i < max_joints; ++i) q[static_cast<Eigen::Index>(i)] = i < arm.joint_count() ? velocity[i] : 0;
    const Eigen::Matrix<double, 6, 1> v = arm.jacobian(first_of(at), {}) * q;
    return {v[0], v[1], v[2], v[3], v[4], v[5]};
}

}  // namespace

std::array<bool, 6> commands_of(const Kinematics& arm) noexcept { return arm.commands(); }

void see_tool(GroupView& view, const Kinematics* arm) noexcept {
    view.tool_known = false;
    if (arm == nullptr || !view.kinematics) return;
    const auto set = arm->forward(first_of(view.set_position), {}), actual = arm->forward(first_of(view.actual_position), {});
    const auto commanded = arm->forward(first_of(view.commanded), {});
    if (!set.miss.ok() || !actual.miss.ok() || !commanded.miss.ok()) return;
    view.tool_known = true;
    view.tool_set = six_of(set.pose);
    view.tool_actual = six_of(actual.pose);
    view.tool_commanded = six_of(commanded.pose);
    view.tool_velocity = velocity_of(*arm, view.set_position, view.set_velocity);
    view.tool_actual_velocity = velocity_of(*arm, view.actual_position, view.actual_velocity);
}

}  // namespace taktwerk::axes
