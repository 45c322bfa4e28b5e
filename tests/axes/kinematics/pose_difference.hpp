#pragma once
// How far two poses are apart.

#include "axes/pose_math.hpp"

namespace taktwerk::axes {

struct PoseDifference {
    double position = 0;  ///< length
    double angle = 0;     ///< rad
};

inline PoseDifference difference(const Pose& a, const Pose& b) {
    const Eigen::Quaterniond turn = orientation_of(a).conjugate() * orientation_of(b);
    return {(position_of(a) - position_of(b)).norm(), 2 * std::atan2(turn.vec().norm(), std::abs(turn.w()))};
}

/// Rotations about the axes one after the other, about z first, then the new y, then the new x (G-078); rad.
inline Pose posed(double x, double y, double z, double about_z, double about_y, double about_x) {
    return pose_of({x, y, z}, Eigen::AngleAxisd(about_z, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(about_y, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(about_x, Eigen::Vector3d::UnitX()));
}

}  // namespace taktwerk::axes
