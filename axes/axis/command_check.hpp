#pragma once
// What can be said about a command without knowing where the axis is: are its numbers usable, and with which dynamics does it run.
//
// Velocity, acceleration, deceleration and jerk above the axis' limits are clamped to them, and the view's `limiter` says so; 0 means the
// axis' default (velocity excepted); negative or not finite is an error. Real-time safe.

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_config.hpp"
#include "axes/axis/axis_view.hpp"
#include "axes/axis/command.hpp"
#include "axes/axis/command_kinds.hpp"
#include "axes/axis/homing_step_check.hpp"
#include "axes/planner/motion.hpp"

namespace taktwerk::axes {

/// Details of profiles over time, torque, controller mode.
[[nodiscard]] inline ErrorId check_details(const AxisCommand& command) noexcept {
    switch (command.kind) {
        case CommandKind::position_profile:
        case CommandKind::velocity_profile:
        case CommandKind::acceleration_profile: {
            const auto* profile = std::get_if<TimeProfileDetails>(&command.details);
            const bool usable = profile && profile->time_scale > 0 && std::isfinite(profile->time_scale) &&
                                std::isfinite(profile->value_scale) && std::isfinite(profile->offset);
            return usable ? ErrorId::none : ErrorId::invalid_parameter;
        }
        case CommandKind::torque:
        case CommandKind::drive_torque: {
            const auto* torque = std::get_if<TorqueDetails>(&command.details);
            if (!torque || !std::isfinite(torque->torque) || !(torque->ramp >= 0)) return ErrorId::invalid_parameter;
            return command.velocity >= 0 && std::isfinite(command.velocity) ? ErrorId::none : ErrorId::invalid_velocity;  // P1-181
        }
        case CommandKind::set_torque_limit: {
            const auto* limit = std::get_if<TorqueLimitDetails>(&command.details);
            const auto usable = [](double value) { return value == 0 || (value >= TorqueLimitDetails::least && std::isfinite(value)); };
            return limit && usable(limit->positive) && usable(limit->negative) ? ErrorId::none : ErrorId::invalid_torque_limit;
        }
        case CommandKind::set_controller_mode: {
            const bool whole = command.position >= 0 && command.position <= 255 && command.position == std::floor(command.position);
            return whole ? ErrorId::none : ErrorId::invalid_parameter;
        }
        default: return ErrorId::none;
    }
}

[[nodiscard]] inline ErrorId check_numbers(const AxisCommand& command) noexcept {
    for (const double value : {command.acceleration, command.deceleration, command.jerk})
        if (!(value >= 0) || std::isinf(value)) return ErrorId::invalid_dynamics;
    switch (command.kind) {
        case CommandKind::none: return ErrorId::invalid_parameter;
        default: return ErrorId::not_supported;
        case CommandKind::move_absolute:
        case CommandKind::move_relative:
        case CommandKind::move_additive:
        case CommandKind::move_continuous_absolute:
        case CommandKind::move_continuous_relative:
        case CommandKind::drive_move_absolute:
        case CommandKind::drive_move_relative:
            if (!std::isfinite(command.position)) return ErrorId::invalid_position;
            if (!(command.velocity > 0) || std::isinf(command.velocity)) return ErrorId::invalid_velocity;
            if (!std::isfinite(command.end_velocity)) return ErrorId::invalid_velocity;
            break;
        case CommandKind::move_superimposed:  // VelocityDiff 0: what the axis' limit leaves
            if (!std::isfinite(command.position)) return ErrorId::invalid_position;
            if (!(command.velocity >= 0) || std::isinf(command.velocity)) return ErrorId::invalid_velocity;
            break;
        case CommandKind::move_velocity:
        case CommandKind::drive_move_velocity:
            if (!std::isfinite(command.velocity)) return ErrorId::invalid_velocity;
            if (command.direction == mcShortestWay) return ErrorId::invalid_direction;
            break;
        case CommandKind::jog:
            if (!std::isfinite(command.velocity) || command.velocity == 0) return ErrorId::invalid_velocity;
            break;
        case CommandKind::home:  // NaN: Position is not given, the configured offset holds
            if (std::isinf(command.position)) return ErrorId::invalid_position;
            break;
        case CommandKind::position_profile:
        case CommandKind::velocity_profile:
        case CommandKind::acceleration_profile:
        case CommandKind::torque:
        case CommandKind::drive_torque:
        case CommandKind::set_controller_mode:
        case CommandKind::set_torque_limit:
            if (const auto error = check_details(command); error != ErrorId::none) return error;
            break;
        case CommandKind::homing_step:
            if (const auto error = check_step(command); error != ErrorId::none) return error;
            break;
        case CommandKind::external:
        case CommandKind::group_motion:
        case CommandKind::halt:
        case CommandKind::gear_in:
        case CommandKind::gear_in_pos:
        case CommandKind::cam_in:
        case CommandKind::combine:
        case CommandKind::gear_out:
        case CommandKind::cam_out:
        case CommandKind::halt_superimposed:
        case CommandKind::stop: break;
    }
    if (command.buffer_mode > mcBlendingHigh) return ErrorId::buffer_mode_not_supported;
    if (command.buffer_mode != mcAborting && !can_be_buffered(command.kind)) return ErrorId::buffer_mode_not_supported;
    if (command.buffer_mode > mcBuffered && made_by_drive(command.kind)) return ErrorId::buffer_mode_not_supported;
    return ErrorId::none;
}

/// For errors and emergency stop.
[[nodiscard]] inline MotionLimits stop_limits(const AxisLimits& limits) noexcept {
    return {limits.velocity, limits.acceleration, limits.stop_deceleration > 0 ? limits.stop_deceleration : limits.deceleration,
            limits.stop_jerk > 0 ? limits.stop_jerk : limits.jerk};
}

[[nodiscard]] inline MotionLimits full_limits(const AxisLimits& limits) noexcept {
    return {limits.velocity, limits.acceleration, limits.deceleration, limits.jerk};
}

/// `value` as commanded, else the default, else the limit; never above the limit.
[[nodiscard]] inline double choose(double value, double fallback, double limit) noexcept {
    return std::min(value > 0 ? value : (fallback > 0 ? fallback : limit), limit);
}

/// Dynamics of a command; its velocity is the limit's where the kind has none.
[[nodiscard]] inline MotionLimits dynamics_of(const AxisCommand& command, const AxisLimits& limits, const AxisDefaults& defaults) noexcept {
    // A stop may be as hard as the axis' own stop, which may be harder than its ordinary deceleration.
    const bool stop = command.kind == CommandKind::stop;
    const auto hardest = stop_limits(limits);
    const double deceleration = stop ? std::max(limits.deceleration, hardest.deceleration) : limits.deceleration;
    const double jerk = stop ? std::max(limits.jerk, hardest.jerk) : limits.jerk;
    const double default_deceleration = defaults.deceleration > 0 ? defaults.deceleration : limits.deceleration;
    const double default_jerk = defaults.jerk > 0 ? defaults.jerk : limits.jerk;
    return {limits.velocity, choose(command.acceleration, defaults.acceleration, limits.acceleration),
            choose(command.deceleration, default_deceleration, deceleration), choose(command.jerk, default_jerk, jerk)};
}

/// Speed (>= 0) that `wanted` (>= 0) is allowed to have, and what held it down.
struct AllowedSpeed {
    double speed = 0;
    VelocityLimiter limiter = VelocityLimiter::command;
};
[[nodiscard]] inline AllowedSpeed allowed_speed(double wanted, double axis_limit, double mode_cap) noexcept {
    if (wanted <= axis_limit && wanted <= mode_cap) return {wanted, VelocityLimiter::command};
    if (mode_cap < axis_limit) return {mode_cap, VelocityLimiter::manual_speed};
    return {axis_limit, VelocityLimiter::axis_limit};
}

}  // namespace taktwerk::axes
