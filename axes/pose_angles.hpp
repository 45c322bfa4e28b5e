#pragma once
// Orientations as three angles, as people and files write them. Inside there are quaternions only. Pure, real-time safe.

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "axes/pose_math.hpp"

namespace taktwerk::axes {

/// Which three turns, one after the other, each about an axis that the ones before have turned.
enum class AngleOrder : std::uint8_t {
    z_y_x,  ///< ours; KUKA's A B C, Siemens' A B C, ISG's default
    x_y_z,  ///< Staubli, Mecademic
    z_y_z,  ///< CODESYS' A B C
};

/// rad, in the order in which they turn.
[[nodiscard]] inline Eigen::Quaterniond orientation_from(const std::array<double, 3>& angles, AngleOrder order) noexcept {
    const auto about = [](const Eigen::Vector3d& axis, double angle) { return Eigen::Quaterniond{Eigen::AngleAxisd(angle, axis)}; };
    const auto x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
    switch (order) {
        case AngleOrder::x_y_z: return about(x, angles[0]) * about(y, angles[1]) * about(z, angles[2]);
        case AngleOrder::z_y_z: return about(z, angles[0]) * about(y, angles[1]) * about(z, angles[2]);
        default: return about(z, angles[0]) * about(y, angles[1]) * about(x, angles[2]);
    }
}

/// The first and third in [-pi, pi], the second in [-pi/2, pi/2] (z_y_z: [0, pi]). Where the second makes the others one turn, the first is 0.
[[nodiscard]] inline std::array<double, 3> angles_of(const Eigen::Quaterniond& orientation, AngleOrder order) noexcept {
    const Eigen::Matrix3d m = orientation.toRotationMatrix();
    // Third from what the first two leave: right to rounding beside the singularity too.
    constexpr double one_turn_below = 1e-12;
    if (order == AngleOrder::z_y_z) {
        const double sine = std::hypot(m(0, 2), m(1, 2)), first = sine < one_turn_below ? 0 : std::atan2(m(1, 2), m(0, 2));
        const double c = std::cos(first), s = std::sin(first);
        return {first, std::atan2(sine, m(2, 2)), std::atan2(c * m(1, 0) - s * m(0, 0), c * m(1, 1) - s * m(0, 1))};
    }
    if (order == AngleOrder::x_y_z) {
        const double level = std::hypot(m(1, 2), m(2, 2)), first = level < one_turn_below ? 0 : std::atan2(-m(1, 2), m(2, 2));
        const double c = std::cos(first), s = std::sin(first);
        return {first, std::atan2(m(0, 2), level), std::atan2(c * m(1, 0) + s * m(2, 0), c * m(1, 1) + s * m(2, 1))};
    }
    const double level = std::hypot(m(0, 0), m(1, 0)), first = level < one_turn_below ? 0 : std::atan2(m(1, 0), m(0, 0));
    const double c = std::cos(first), s = std::sin(first);
    return {first, std::atan2(-m(2, 0), level), std::atan2(s * m(0, 2) - c * m(1, 2), c * m(1, 1) - s * m(0, 1))};
}

}  // namespace taktwerk::axes
