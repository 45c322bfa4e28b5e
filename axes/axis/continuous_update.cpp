#include "axes/axis/continuous_update.hpp"

#include "axes/axis/admission.hpp"
#include "axes/axis/aim.hpp"
#include "axes/axis/axis_coupling.hpp"
#include "axes/axis/drive_modes.hpp"
#include "axes/axis/given_motion.hpp"
#include "axes/axis/junction.hpp"
#include "axes/axis/plannable.hpp"
#include "axes/axis/superimposed_motion.hpp"
#include "axes/axis/targets.hpp"

namespace taktwerk::axes {

ErrorId ContinuousUpdate::update(CommandId id, const AxisCommand& command) noexcept {
    if (id == 0) return ErrorId::none;
    auto& active = body_.queue.active();
    if (id == active.id) return command == active.command ? ErrorId::none : update_active(command);
    if (id == body_.queue.beside(SideSlot::superimposed))
        return command == addition_.command() ? ErrorId::none : update_superimposed(command);
    for (std::size_t i = 0; i < body_.queue.waiting(); ++i)
        if (auto& waiting = body_.queue.waiting_at(i); waiting.id == id)
            return command == waiting.command ? ErrorId::none : update_waiting(waiting, command);
    return ErrorId::none;  // it is over
}

ErrorId ContinuousUpdate::update_waiting(AcceptedCommand& waiting, const AxisCommand& command) noexcept {
    if (command.kind != waiting.command.kind || command.buffer_mode == mcAborting) return ErrorId::update_not_possible;
    if (const auto error = check_inputs(command, body_.units.counts_per_unit(), body_.config.limits); error != ErrorId::none) return error;
    if (const auto error = refuse_as_new(command, false); error != ErrorId::none) return error;
    const bool last = waiting.id == body_.queue.waiting_at(body_.queue.waiting() - 1).id;
    if (!last && coupling_.never_ends(command)) return ErrorId::buffer_mode_not_supported;
    const bool blended = blends(waiting.command.buffer_mode) || blends(command.buffer_mode);
    waiting.command = command;
    if (blended && motion_.goal.kind == Goal::Kind::position && !body_.begin_pending) motion_.goal_pending = true;
    return ErrorId::none;
}

/// What has not begun is held to all that it would have been held to, had it come like this: what could not begin would end its command.
ErrorId ContinuousUpdate::refuse_as_new(const AxisCommand& command, bool starts_now) noexcept {
    if (const auto error = coupling_.refuse(command); error != ErrorId::none) return error;
    if (const auto error = admission_.refuse_target(command, starts_now); error != ErrorId::none) return error;
    if (const auto error = switching_.refuse(command, starts_now); error != ErrorId::none) return error;
    return given_.refuse(command, starts_now);
}

/// BufferMode of a running command has done its work: it is kept, and ignored (P1-109).
ErrorId ContinuousUpdate::update_active(const AxisCommand& command) noexcept {
    auto& active = body_.queue.active();
    if (command.kind != active.command.kind) return ErrorId::update_not_possible;
    if (const auto error = check_inputs(command, body_.units.counts_per_unit(), body_.config.limits); error != ErrorId::none) return error;
    if (motion_.goal.limiter == VelocityLimiter::software_limit) return ErrorId::update_not_possible;
    if (body_.begin_pending) {  // not begun: as if it had come with these inputs
        if (const auto error = refuse_as_new(command, true); error != ErrorId::none) return error;
        if (body_.queue.waiting() > 0 && coupling_.never_ends(command)) return ErrorId::buffer_mode_not_supported;
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
            const double velocity = targets_.signed_velocity(command, motion_.started_backwards);
            if (!measured_.permitted(velocity)) return ErrorId::interlocked;
            aim_.at_velocity(velocity, dynamics_of(command, body_.config.limits, body_.config.defaults));
            break;
        }
        case CommandKind::gear_in:
        case CommandKind::cam_in:
        case CommandKind::combine: error = coupling_.update(command); break;
        case CommandKind::position_profile:
        case CommandKind::velocity_profile:
        case CommandKind::acceleration_profile: error = given_.update(command); break;
        case CommandKind::torque:
            if (!measured_.permitted(targets_.torque_of(command))) return ErrorId::interlocked;
            switching_.begin_torque(command);
            break;
        default: return ErrorId::not_supported;
    }
    if (error == ErrorId::none) active.command = command;
    return error;
}

ErrorId ContinuousUpdate::update_target(const AxisCommand& command) noexcept {
    const auto& before = body_.queue.active().command;
    const bool absolute = command.kind == CommandKind::move_absolute || command.kind == CommandKind::move_continuous_absolute;
    const bool same_target = command.position == before.position && (!absolute || command.direction == before.direction);
    const bool passed = motion_.goal.kind == Goal::Kind::velocity;  // MC_MoveContinuous... beyond its target
    const auto from = motion_.setpoint.base();
    if (passed && same_target) {
        aim_.at_velocity(command.end_velocity, dynamics_of(command, body_.config.limits, body_.config.defaults));
        return ErrorId::none;
    }
    double target = motion_.goal.value;
    if (!same_target) {
        if (absolute) {
            if (const auto error = targets_.refuse_place(command); error != ErrorId::none) return error;
        }
        target = targets_.target_of(command, from, motion_.heads_backwards());
        if (!absolute && body_.config.modulo == 0) {
            if (const auto error = targets_.refuse_place(body_.units.to_program(target)); error != ErrorId::none) return error;
        }
        if (!measured_.permitted(target - from.position)) return ErrorId::interlocked;
    }
    aim_.at_target(command, target);
    return ErrorId::none;
}

ErrorId ContinuousUpdate::update_superimposed(const AxisCommand& command) noexcept {
    if (command.kind != addition_.command().kind) return ErrorId::update_not_possible;
    if (const auto error = admission_.refuse_superimposed(command); error != ErrorId::none) return error;
    addition_.update(command);
    return ErrorId::none;
}

}  // namespace taktwerk::axes
