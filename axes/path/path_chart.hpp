#pragma once
// How numbers of a path become a pose: the position as it stands, the orientation as a rotation vector seen from a reference. Along any
// programmed element the rotation vector keeps its direction, which makes it a great circle; only a blend's bends.
// Pure, real-time safe.

#include <array>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "axes/path/path_vector.hpp"

namespace taktwerk::axes {

/// Numbers 3..5 of a path are lever * (rotation vector of reference^-1 * orientation). A lever of 0: the path does not turn,
/// and keeps the reference: of an arm that cannot turn, as it is mounted and as its tool is.
struct PathChart {
    std::array<double, 4> reference{1, 0, 0, 0};  ///< unit quaternion w, x, y, z
    double lever = 0;                             ///< u/rad

    friend bool operator==(const PathChart&, const PathChart&) = default;
};

/// A pose along a path with its derivatives by the length s. Angular values are seen from the path's frame, not from the tool.
struct PosePoint {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
    std::array<Eigen::Vector3d, 3> linear;   ///< dp/ds, d2p/ds2, d3p/ds3
    std::array<Eigen::Vector3d, 3> angular;  ///< w = turn per length [rad/u], dw/ds, d2w/ds2
};

[[nodiscard]] PosePoint pose_point(const PathPoint& point, const PathChart& chart) noexcept;

/// The rotation vector, of length at most pi, that turns `from` into `to` seen from `from`.
[[nodiscard]] Eigen::Vector3d rotation_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) noexcept;

}  // namespace taktwerk::axes
