#pragma once
// Arithmetic of poses with Eigen. Pure, real-time safe: fixed sizes, nothing allocates.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "axes/pose.hpp"

namespace taktwerk::axes {

[[nodiscard]] inline Eigen::Vector3d position_of(const Pose& pose) noexcept {
    return {pose.position[0], pose.position[1], pose.position[2]};
}
/// As it stands in the pose: of length 1 if the pose's is.
[[nodiscard]] inline Eigen::Quaterniond orientation_of(const Pose& pose) noexcept {
    return {pose.orientation[0], pose.orientation[1], pose.orientation[2], pose.orientation[3]};
}
[[nodiscard]] inline Pose pose_of(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation) noexcept {
    return {{position.x(), position.y(), position.z()}, {orientation.w(), orientation.x(), orientation.y(), orientation.z()}};
}

/// `inner`, which is seen from `outer`, seen from where `outer` is: outer * inner.
[[nodiscard]] inline Pose composed(const Pose& outer, const Pose& inner) noexcept {
    const Eigen::Quaterniond turn = orientation_of(outer);
    return pose_of(position_of(outer) + turn * position_of(inner), turn * orientation_of(inner));
}
[[nodiscard]] inline Pose inverted(const Pose& pose) noexcept {
    const Eigen::Quaterniond back = orientation_of(pose).conjugate();
    return pose_of(-(back * position_of(pose)), back);
}

}  // namespace taktwerk::axes
