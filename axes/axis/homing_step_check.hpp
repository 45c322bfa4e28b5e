#pragma once
// What can be said about a step of PLCopen Part 5 without knowing the axis: are its numbers usable. Real-time safe.

#include <cmath>

#include "axes/axis/command.hpp"

namespace taktwerk::axes {

[[nodiscard]] constexpr bool passive(HomingStep step) noexcept {
    return step == HomingStep::flying_switch || step == HomingStep::flying_reference_pulse;
}

/// What runs beside the axis' own motion.
[[nodiscard]] inline bool beside(const AxisCommand& command) noexcept {
    const auto* step = std::get_if<HomingStepDetails>(&command.details);
    return command.kind == CommandKind::abort_passive_homing || (command.kind == CommandKind::homing_step && step && passive(step->step));
}

/// Steps that look for something by moving.
[[nodiscard]] constexpr bool searches(HomingStep step) noexcept { return step <= HomingStep::distance_coded; }

[[nodiscard]] inline ErrorId check_step(const AxisCommand& command) noexcept {
    const auto* step = std::get_if<HomingStepDetails>(&command.details);
    if (!step) return ErrorId::invalid_parameter;

    const bool speed = command.velocity > 0 && !std::isinf(command.velocity);
    if (searches(step->step) && !speed) return ErrorId::invalid_velocity;
    if (step->step == HomingStep::finish) {
        if (!std::isfinite(command.position)) return ErrorId::invalid_position;
        if (command.position != 0 && !speed) return ErrorId::invalid_velocity;
    }
    // NaN leaves the coordinates alone; a step that does nothing but set them must have some.
    const bool sets_only = step->step == HomingStep::direct || passive(step->step);
    if (std::isinf(step->set_position) || (sets_only && std::isnan(step->set_position))) return ErrorId::invalid_position;
    for (const double limit : {step->torque_limit, step->distance_limit, step->detection_velocity_limit})
        if (!(limit >= 0) || std::isinf(limit)) return ErrorId::invalid_parameter;
    if (step->time_limit < Duration::zero() || step->detection_velocity_time < Duration::zero()) return ErrorId::invalid_parameter;

    const bool by_switch = step->direction > MC_HomeDirection::mcNegativeDirection;
    switch (step->step) {
        case HomingStep::limit_switch:
            return step->switch_mode <= MC_SwitchMode::mcFallingEdge ? ErrorId::none : ErrorId::invalid_parameter;
        case HomingStep::block:
            if (!(step->torque_limit > 0) || !(step->detection_velocity_limit > 0)) return ErrorId::invalid_parameter;
            return by_switch ? ErrorId::invalid_direction : ErrorId::none;
        case HomingStep::reference_pulse:
        case HomingStep::distance_coded: return by_switch ? ErrorId::invalid_direction : ErrorId::none;
        default: return ErrorId::none;
    }
}

}  // namespace taktwerk::axes
