#pragma once
// Numbers that are finite and still mean nothing to this axis: refused before a plan is asked for. Real-time safe.

#include <cmath>

#include "axes/axis/command.hpp"
#include "axes/axis/units.hpp"

namespace taktwerk::axes {

/// A count is told from the next one up to here: beyond it a position is no place of this axis.
inline constexpr double largest_count = 4503599627370496.0;  // 2^52
/// Of the axis' velocity limit. Slower than this is nobody's motion: a millimetre would take years.
inline constexpr double least_velocity_share = 1e-9;

[[nodiscard]] inline ErrorId check_plannable(const AxisCommand& command, double counts_per_unit, double velocity_limit) noexcept {
    if (std::abs(command.position * counts_per_unit) > largest_count) return ErrorId::invalid_position;
    const double speed = std::abs(command.velocity);
    return speed > 0 && speed < least_velocity_share * velocity_limit ? ErrorId::invalid_velocity : ErrorId::none;
}

}  // namespace taktwerk::axes
