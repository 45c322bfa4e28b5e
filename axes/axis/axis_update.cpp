// ContinuousUpdate: a command goes on with other inputs. Never a re-trigger: no state changes, relative inputs keep the start's conditions
// (P1-103 to P1-110). One case per kind of command in update_active.

#include <cmath>

#include "axes/axis/axis_core.hpp"
#include "axes/axis/junction.hpp"
#include "axes/axis/plannable.hpp"

namespace taktwerk::axes {

ErrorId AxisCore::update(CommandId id, const AxisCommand& command, Owner owner) noexcept {
    if (!may(owner)) return ErrorId::owned_by_other;
    if (id == 0) return ErrorId::none;
    auto& active = queue_.active();
    if (id == active.id) return command == active.command ? ErrorId::none : update_active(command);
    if (id == queue_.beside(SideSlot::superimposed))
        return command == superimposed_.accepted.command ? ErrorId::none : update_superimposed(command);
    for (std::size_t i = 0; i < queue_.waiting(); ++i)
        if (auto& waiting = queue_.waiting_at(i); waiting.id == id)
            return command == waiting.command ? ErrorId::none : update_waiting(waiting, command);
    return ErrorId::none;  // it is over
}

ErrorId AxisCore::update_waiting(AcceptedCommand& waiting, const AxisCommand& command) noexcept {
    if (command.kind != waiting.command.kind || command.buffer_mode == mcAborting) return ErrorId::update_not_possible;
    if (const auto error = check_inputs(command, units_.counts_per_unit(), config_.limits); error != ErrorId::none) return error;
    if (const auto error = refuse_target(command, false); error != ErrorId::none) return error;
    const bool last = waiting.id == queue_.waiting_at(queue_.waiting() - 1).id;
    if (!last && never_ends(command)) return ErrorId::buffer_mode_not_supported;
    const bool blended = blends(waiting.command.buffer_mode) || blends(command.buffer_mode);
    waiting.command = command;
    if (blended && goal_.kind == Goal::Kind::position && !begin_pending_) goal_pending_ = true;
    return ErrorId::none;
}

/// BufferMode of a running command has done its work: it is kept, and ignored (P1-109).
ErrorId AxisCore::update_active(const AxisCommand& command) noexcept {
    auto& active = queue_.active();
    if (command.kind != active.command.kind) return ErrorId::update_not_possible;
    if (const auto error = check_inputs(command, units_.counts_per_unit(), config_.limits); error != ErrorId::none) return error;
    if (goal_.limiter == VelocityLimiter::software_limit) return ErrorId::update_not_possible;
    if (begin_pending_) {  // not begun: as if it had come with these inputs
        if (const auto error = refuse_target(command, true); error != ErrorId::none) return error;
        active.command = command;
        return ErrorId::none;
    }
    if (!can_be_updated(command.kind)) return ErrorId::not_supported;
    ErrorId error = ErrorId::none;
    switch (command.kind) {
        case CommandKind::move_absolute:
        case CommandKind::move_relative:
        case CommandKind::move_additive:
        case CommandKind::move_continuous_absolute:
        case CommandKind::move_continuous_relative: error = update_target(command); break;
        case CommandKind::move_velocity: {
            const double velocity = signed_velocity(command, started_backwards_);
            if (!permitted(velocity)) return ErrorId::interlocked;
            aim_at_velocity(velocity, dynamics_of(command, config_.limits, config_.defaults));
            break;
        }
        case CommandKind::gear_in:
        case CommandKind::cam_in:
        case CommandKind::combine: error = update_coupling(command); break;
        case CommandKind::position_profile:
        case CommandKind::velocity_profile:
        case CommandKind::acceleration_profile: error = update_curve(command); break;
        case CommandKind::torque:
            if (!permitted(torque_of(command))) return ErrorId::interlocked;
            begin_torque(command);
            break;
        default: return ErrorId::not_supported;
    }
    if (error == ErrorId::none) active.command = command;
    return error;
}

ErrorId AxisCore::update_target(const AxisCommand& command) noexcept {
    const auto& before = queue_.active().command;
    const bool absolute = command.kind == CommandKind::move_absolute || command.kind == CommandKind::move_continuous_absolute;
    const bool same_target = command.position == before.position && (!absolute || command.direction == before.direction);
    const bool passed = goal_.kind == Goal::Kind::velocity;  // MC_MoveContinuous... beyond its target
    const auto from = setpoint_.base();
    if (passed && same_target) {
        aim_at_velocity(command.end_velocity, dynamics_of(command, config_.limits, config_.defaults));
        return ErrorId::none;
    }
    double target = goal_.value;
    if (!same_target) {
        if (absolute) {
            if (const auto error = refuse_place(command); error != ErrorId::none) return error;
        }
        target = target_of(command, from, heads_backwards());
        if (!absolute && config_.modulo == 0) {
            if (const auto error = refuse_place(units_.to_program(target)); error != ErrorId::none) return error;
        }
        if (!permitted(target - from.position)) return ErrorId::interlocked;
    }
    aim_at_target(command, target);
    return ErrorId::none;
}

ErrorId AxisCore::update_superimposed(const AxisCommand& command) noexcept {
    if (command.kind != superimposed_.accepted.command.kind) return ErrorId::update_not_possible;
    if (const auto error = refuse_superimposed(command); error != ErrorId::none) return error;
    superimposed_.accepted.command = command;
    superimposed_.distance = command.position;
    superimposed_.pending = true;
    return ErrorId::none;
}

}  // namespace taktwerk::axes
