#pragma once
// The turn of a tool that an arm can turn about one axis only. Pure, real-time safe.

#include <cmath>

#include "axes/kinematics/arm_solutions.hpp"
#include "axes/kinematics/frame.hpp"

namespace taktwerk::axes {

/// The angle about axis `around` (0 x, 1 y, 2 z), in (-pi, pi]; `tilt` becomes what that leaves over, rad.
[[nodiscard]] inline double turn_about(std::size_t around, const Frame<double>& f, double& tilt) noexcept {
    const std::size_t next = (around + 1) % 3, last = (around + 2) % 3;
    tilt = std::atan2(std::hypot(f.axis[around][next], f.axis[around][last]), f.axis[around][around]);
    return std::atan2(f.axis[next][last], f.axis[next][next]);
}

/// For arms that do not turn at all: how far the orientation is from the base's, rad.
[[nodiscard]] inline double turn_from_base(const Frame<double>& f) noexcept {
    double tilt = 0;
    const double turn = turn_about(2, f, tilt);
    return std::hypot(turn, tilt);
}

}  // namespace taktwerk::axes
