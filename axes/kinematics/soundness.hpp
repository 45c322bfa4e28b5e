#pragma once
// What poses and axes must be before anything is computed of them. Pure, real-time safe.

#include <algorithm>
#include <cmath>

#include "axes/kinematics/frame.hpp"
#include "axes/kinematics/joints.hpp"

namespace taktwerk::axes {

/// An orientation this far from length 1 is a mistake; nearer, it is rounding and is scaled.
inline constexpr double length_rounding = 1e-6;

/// What is larger is no place of a machine, in whatever unit; what is computed from it would be infinite.
inline constexpr double largest = 1e12;

[[nodiscard]] inline bool sound(const Pose& pose) noexcept {
    for (const double v : pose.position)
        if (!(std::abs(v) <= largest)) return false;
    return std::abs(orientation_of(pose).norm() - 1) < length_rounding;
}

[[nodiscard]] inline Frame<double> frame_of_scaled(Pose pose) noexcept {
    const double scale = 1 / orientation_of(pose).norm();
    for (double& v : pose.orientation) v *= scale;
    return frame_of(pose);
}

[[nodiscard]] inline bool finite(const Joints& joints) noexcept {
    return std::all_of(joints.begin(), joints.end(), [](double v) { return std::abs(v) <= largest; });
}

}  // namespace taktwerk::axes
