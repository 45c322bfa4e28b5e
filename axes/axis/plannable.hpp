#pragma once
// Inputs that no motion can be made of: not numbers, or numbers that mean nothing to this axis. Refused before a plan is asked for, when a
// command comes and when it is updated. Real-time safe.

#include <cmath>

#include "axes/axis/axis_config.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/units.hpp"

namespace taktwerk::axes {

/// A count is told from the next one up to here: beyond it a position is no place of this axis.
inline constexpr double largest_count = 4503599627370496.0;  // 2^52
/// Of the axis' limits, per second for the jerk, and of 1 for an override. Less is nobody's motion: a millimetre would take years.
inline constexpr double least_share = 1e-9;

[[nodiscard]] inline bool is_place(double position, double counts_per_unit) noexcept {
    return !(std::abs(position * counts_per_unit) > largest_count);  // NaN: not given
}

[[nodiscard]] inline bool as_good_as_none(double value, double limit) noexcept {
    return value != 0 && std::abs(value) < least_share * limit;  // 0: the axis' own
}

[[nodiscard]] inline ErrorId check_inputs(const AxisCommand& command, double counts_per_unit, const AxisLimits& limits) noexcept {
    if (const auto error = check_numbers(command); error != ErrorId::none) return error;
    const auto* step = std::get_if<HomingStepDetails>(&command.details);
    if (!is_place(command.position, counts_per_unit) || (step && !is_place(step->set_position, counts_per_unit)))
        return ErrorId::invalid_position;
    if (as_good_as_none(command.velocity, limits.velocity)) return ErrorId::invalid_velocity;
    const bool dynamics = as_good_as_none(command.acceleration, limits.acceleration) ||
                          as_good_as_none(command.deceleration, limits.deceleration) || as_good_as_none(command.jerk, limits.acceleration);
    return dynamics ? ErrorId::invalid_dynamics : ErrorId::none;
}

}  // namespace taktwerk::axes
