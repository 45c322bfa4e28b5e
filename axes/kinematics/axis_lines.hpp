#pragma once
// Lines in space: where joints' axes meet. Pure, real-time safe.

#include <Eigen/Dense>

namespace taktwerk::axes {

/// The point next to three lines, in the least sum of squares: where they meet, if they do. Not all parallel.
[[nodiscard]] inline Eigen::Vector3d middle_of(const Eigen::Vector3d& p1, const Eigen::Vector3d& z1, const Eigen::Vector3d& p2,
                                               const Eigen::Vector3d& z2, const Eigen::Vector3d& p3, const Eigen::Vector3d& z3) noexcept {
    const auto across = [](const Eigen::Vector3d& z) { return Eigen::Matrix3d{Eigen::Matrix3d::Identity() - z * z.transpose()}; };
    const Eigen::Matrix3d sum = across(z1) + across(z2) + across(z3);
    return sum.ldlt().solve(across(z1) * p1 + across(z2) * p2 + across(z3) * p3);
}
/// The same of two lines, which are not parallel.
[[nodiscard]] inline Eigen::Vector3d middle_of(const Eigen::Vector3d& p1, const Eigen::Vector3d& z1, const Eigen::Vector3d& p2,
                                               const Eigen::Vector3d& z2) noexcept {
    return middle_of(p1, z1, p2, z2, p1, z1);
}

}  // namespace taktwerk::axes
