#include "axes/axis/admission.hpp"

#include "axes/axis/axis_coupling.hpp"
#include "axes/axis/axis_homing.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/conduct.hpp"
#include "axes/axis/drive_modes.hpp"
#include "axes/axis/drive_profiles.hpp"
#include "axes/axis/given_motion.hpp"
#include "axes/axis/homing_steps.hpp"
#include "axes/axis/plannable.hpp"
#include "axes/axis/targets.hpp"

namespace taktwerk::axes {

bool Admission::waits(const AxisCommand& command) const noexcept {
    if (command.buffer_mode == mcAborting) return false;
    return body_.queue.has_active() || body_.queue.waiting() > 0 || powers_up() || motion_.halts_alone() ||
           body_.state == AxisState::Stopping;
}

/// MC_Power has been asked for it, and Status is still to come.
bool Admission::powers_up() const noexcept {
    return body_.state == AxisState::Disabled && body_.power_wish && body_.emergency == EmergencyStop::none;
}

/// What waits behind a homing is judged when its turn comes.
bool Admission::homes_before() const noexcept {
    if (body_.state == AxisState::Homing) return true;
    for (std::size_t i = 0; i < body_.queue.waiting(); ++i)
        if (const auto kind = body_.queue.waiting_at(i).command.kind; kind == CommandKind::home || kind == CommandKind::homing_step)
            return true;
    return false;
}

ErrorId Admission::refuse_state(const AxisCommand& command) const noexcept {
    if (body_.state == AxisState::Disabled && !(powers_up() && waits(command))) return ErrorId::not_powered;
    if (body_.state == AxisState::ErrorStop) return ErrorId::in_error_stop;
    if (body_.emergency != EmergencyStop::none) return ErrorId::interlocked;
    // Behind MC_Power a command may wait for the brake as for the drive.
    if (body_.brake.holds() && body_.state != AxisState::Disabled) return ErrorId::brake_closed;
    const bool stopping = body_.state == AxisState::Stopping;
    if (waits(command)) {
        const bool behind_stop = body_.queue.active().command.kind == CommandKind::stop || body_.lock != 0;
        if (stopping && (!behind_stop || conduct_.off_when_stopped())) return ErrorId::state_forbids;
        return body_.queue.waiting() < body_.config.queue_depth ? ErrorId::none : ErrorId::queue_full;
    }
    // A stop whose Execute has fallen may be followed by another; one that is held locks the axis.
    if (stopping && command.kind == CommandKind::stop)
        return body_.lock == 0 && !conduct_.off_when_stopped() ? ErrorId::none : ErrorId::state_forbids;
    if (uncouples(command.kind)) return ErrorId::none;  // has a word of its own (refuse_coupling)
    // MC_Home's own search is no step: only MC_Stop ends it early.
    if (command.kind == CommandKind::homing_step && body_.state == AxisState::Homing && !body_.homing_procedure)
        return ErrorId::state_forbids;
    return next_state(body_.state, event_of(command.kind)) ? ErrorId::none : ErrorId::state_forbids;
}

ErrorId Admission::refuse_target(const AxisCommand& command, bool starts_now) const noexcept {
    // Coordinates of the total: what is superimposed is part of where the axis is.
    const auto& here = motion_.setpoint.state();
    double way = 0;
    switch (command.kind) {
        case CommandKind::move_absolute:
        case CommandKind::move_continuous_absolute:
            if (body_.config.require_homed && !body_.homed && (starts_now || !homes_before())) return ErrorId::not_homed;
            if (const auto error = targets_.refuse_place(command); error != ErrorId::none) return error;
            way = targets_.repetition_of(command, here, motion_.heads_backwards()) - here.position;
            break;
        case CommandKind::move_relative:
        case CommandKind::move_continuous_relative:
        case CommandKind::move_additive: {
            if (!starts_now) return ErrorId::none;  // it is checked where it begins
            const bool adds = command.kind == CommandKind::move_additive && motion_.has_commanded_target;
            const double from = adds ? motion_.commanded_target + motion_.setpoint.superimposed().position : here.position;
            way = from + command.position - here.position;
            if (body_.config.modulo > 0) break;
            if (const auto error = targets_.refuse_place(body_.units.to_program(from) + command.position); error != ErrorId::none)
                return error;
            break;
        }
        case CommandKind::drive_move_absolute:
            if (body_.config.require_homed && !body_.homed && (starts_now || !homes_before())) return ErrorId::not_homed;
            if (const auto error = targets_.refuse_place(command.position); error != ErrorId::none) return error;
            [[fallthrough]];
        case CommandKind::drive_move_relative: {
            if (!starts_now) return ErrorId::none;
            DriveProfileRun::Way at{.from = measured_.local()};
            at.target = targets_.drive_target(command, {at.from, here.velocity, 0});
            return targets_.refuse_drive_way(at);
        }
        case CommandKind::move_velocity:
        case CommandKind::drive_move_velocity:
        case CommandKind::jog: {
            if (!starts_now) return ErrorId::none;
            way = targets_.signed_velocity(command, motion_.heads_backwards());
            const double program = body_.units.to_program(here.position);
            const bool outward =
                (way > 0 && program >= body_.config.limits.position_max) || (way < 0 && program <= body_.config.limits.position_min);
            if (measured_.permitted(way) && body_.software_limits_hold() && outward) return ErrorId::beyond_software_limit;
            break;
        }
        case CommandKind::home: return homing_.refuse();
        case CommandKind::homing_step: {
            const auto* step = std::get_if<HomingStepDetails>(&command.details);
            return step ? steps_.refuse(*step, starts_now) : ErrorId::invalid_parameter;
        }
        default: return ErrorId::none;
    }
    return !starts_now || measured_.permitted(way) ? ErrorId::none : ErrorId::interlocked;
}

ErrorId Admission::refuse(const AxisCommand& command) noexcept {
    if (body_.config.encoder) return ErrorId::not_supported;  // nothing there that moves
    if (made_by_drive(command.kind) && !profiles_.makes(command.kind)) return ErrorId::not_supported;
    if (const auto error = check_inputs(command, body_.units.counts_per_unit(), body_.config.limits); error != ErrorId::none) return error;
    if (const auto error = refuse_state(command); error != ErrorId::none) return error;
    if (waits(command) && coupling_.waits_for_ever()) return ErrorId::buffer_mode_not_supported;
    if (const auto error = coupling_.refuse(command); error != ErrorId::none) return error;
    if (const auto error = refuse_target(command, !waits(command)); error != ErrorId::none) return error;
    if (const auto error = switching_.refuse(command, !waits(command)); error != ErrorId::none) return error;
    return given_.refuse(command, !waits(command));
}

ErrorId Admission::refuse_superimposed(const AxisCommand& command) const noexcept {
    if (const auto error = check_inputs(command, body_.units.counts_per_unit(), body_.config.limits); error != ErrorId::none) return error;
    if (body_.state == AxisState::Disabled) return ErrorId::not_powered;
    if (body_.state == AxisState::ErrorStop) return ErrorId::in_error_stop;
    if (body_.emergency != EmergencyStop::none) return ErrorId::interlocked;
    if (body_.brake.holds()) return ErrorId::brake_closed;
    if (!next_state(body_.state, AxisEvent::superimposed)) return ErrorId::state_forbids;
    if (command.kind == CommandKind::halt_superimposed) return ErrorId::none;
    // Where the drive takes no set-point there is nothing to add to.
    const auto base = body_.queue.active().command.kind;
    if (base == CommandKind::torque || base == CommandKind::set_controller_mode || made_by_drive(base)) return ErrorId::state_forbids;
    if (!measured_.permitted(command.position)) return ErrorId::interlocked;
    // Where both are known to end. Everything else is stopped at the limit when it comes there.
    const bool ends = motion_.goal.kind == Goal::Kind::rest || (motion_.goal.kind == Goal::Kind::position && !motion_.goal.goes_on);
    if (!ends || body_.begin_pending || body_.config.modulo > 0) return ErrorId::none;
    const double base_end = motion_.goal.kind == Goal::Kind::position ? motion_.goal.value : motion_.setpoint.base().position;
    return targets_.refuse_place(body_.units.to_program(base_end + motion_.setpoint.superimposed().position + command.position));
}

}  // namespace taktwerk::axes
