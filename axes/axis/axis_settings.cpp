#include "axes/axis/axis_settings.hpp"

#include <cmath>

#include "axes/axis/aim.hpp"
#include "axes/axis/axis_coupling.hpp"
#include "axes/axis/axis_parameters.hpp"
#include "axes/axis/conduct.hpp"
#include "axes/axis/given_motion.hpp"
#include "axes/axis/parameters.hpp"
#include "axes/axis/plannable.hpp"
#include "axes/axis/superimposed_motion.hpp"

namespace taktwerk::axes {

Submitted AxisSettings::submit(const AxisCommand& command, Owner owner) noexcept {
    if (!body_.may(owner)) return {0, ErrorId::owned_by_other};
    const auto* setting = std::get_if<AxisSetting>(&command.details);
    if (!setting || command.buffer_mode > mcBuffered) return {0, ErrorId::invalid_parameter};
    // What can be said now is said now; the rest when its turn comes.
    if (const auto* parameter = std::get_if<WriteParameter>(setting))
        if (const auto error = check_write(body_.shown, *parameter); error != ErrorId::none) return {0, error};
    const bool waits =
        command.buffer_mode == mcBuffered && (body_.queue.has_active() || body_.queue.waiting() > 0 || body_.state == AxisState::Stopping);
    if (waits && body_.queue.waiting() >= body_.config.queue_depth) return {0, ErrorId::queue_full};
    const AcceptedCommand accepted{body_.queue.next_id(), owner, command};
    if (waits) body_.queue.push(accepted);
    else carry_out(accepted);
    return {accepted.id, ErrorId::none};
}

void AxisSettings::carry_out(const AcceptedCommand& setting) noexcept {
    const auto error = apply(std::get<AxisSetting>(setting.command.details), setting.owner);
    body_.queue.record(setting.id, error == ErrorId::none ? Outcome::done : Outcome::error, error);
}

void AxisSettings::carry_out_due() noexcept {
    while (body_.queue.waiting() > 0 && body_.queue.front().command.kind == CommandKind::setting && body_.shown.active_in_target)
        carry_out(body_.queue.pop());
}

ErrorId AxisSettings::set_position(const SetPosition& wanted) noexcept {
    if (!std::isfinite(wanted.position)) return ErrorId::invalid_position;
    if (!measured_.online()) return ErrorId::drive_not_ready;
    if (body_.state == AxisState::Homing) return ErrorId::state_forbids;
    const double here = body_.units.to_program(measured_.local());
    const double shift = wanted.relative ? wanted.position : wanted.position - here;
    if (!is_place(here + shift, body_.units.counts_per_unit())) return ErrorId::invalid_position;
    aim_.shift_coordinates(shift);
    changed_ = true;
    return ErrorId::none;
}

ErrorId AxisSettings::apply(const AxisSetting& setting, Owner owner) noexcept {
    if (!body_.may(owner)) return ErrorId::owned_by_other;
    const bool each_cycle = std::holds_alternative<SetpointFeed>(setting) || std::holds_alternative<SelectCam>(setting);
    if (each_cycle && body_.slow_line) return ErrorId::not_supported;
    if (std::holds_alternative<SetPosition>(setting) && body_.led()) return ErrorId::axis_grouped;
    if (const auto* position = std::get_if<SetPosition>(&setting)) return set_position(*position);
    if (const auto* parameter = std::get_if<WriteParameter>(&setting)) return parameters_.write(*parameter);
    if (const auto* output = std::get_if<WriteOutput>(&setting)) return parameters_.write_output(*output);
    if (const auto* fed = std::get_if<SetpointFeed>(&setting)) return feed_in(*fed);
    if (const auto* factors = std::get_if<Override>(&setting)) return set_override(*factors);
    if (const auto* brake = std::get_if<SetBrake>(&setting)) return set_brake(*brake);
    if (const auto* cam = std::get_if<SelectCam>(&setting)) {
        changed_ = true;
        return coupling_.select_cam(*cam);
    }
    return ErrorId::not_supported;
}

/// Open it is where the axis holds its load itself, or where the machine file says that nothing sinks. Closed it is where nothing moves.
ErrorId AxisSettings::set_brake(const SetBrake& wanted) noexcept {
    if (!body_.brake.controlled()) return ErrorId::brake_not_controlled;
    if (body_.config.brake.by == BrakeBy::object && !body_.port.capabilities().brake) return ErrorId::not_supported;
    const auto phase = body_.power.phase();
    if (wanted.release) {
        if (body_.emergency != EmergencyStop::none) return ErrorId::interlocked;
        if (phase == PowerSequence::Phase::off && !body_.config.brake.release_without_power) return ErrorId::not_powered;
        if (phase == PowerSequence::Phase::off && !measured_.online()) return ErrorId::drive_not_ready;
        if (phase == PowerSequence::Phase::off && body_.power_wish && body_.state == AxisState::Disabled) return ErrorId::state_forbids;
    }
    const bool rests = body_.state == AxisState::Standstill && !conduct_.moves() && !body_.queue.has_active() && !body_.begin_pending &&
                       body_.queue.waiting() == 0;
    if (phase == PowerSequence::Phase::on ? !wanted.release && !rests : phase != PowerSequence::Phase::off) return ErrorId::state_forbids;
    body_.brake.by_hand(wanted.release);
    return ErrorId::none;
}

/// One that cannot be followed ends the command that is fed.
ErrorId AxisSettings::feed_in(const SetpointFeed& fed) noexcept {
    if (body_.queue.active().command.kind != CommandKind::external) return ErrorId::state_forbids;
    const auto error = given_.feed(fed);
    if (error != ErrorId::none) {
        conduct_.end_with(error);
        changed_ = true;
    }
    return error;
}

ErrorId AxisSettings::set_override(const Override& factors) noexcept {
    bool others = false;
    const auto error = motion_.take_override(factors, others);
    if (others) override_changed();
    return error;
}

ErrorId AxisSettings::set_operators_override(double factor) noexcept {
    bool others = false;
    const auto error = motion_.take_operators_override(factor, others);
    if (others) override_changed();
    return error;
}

void AxisSettings::override_changed() noexcept {
    if (body_.queue.beside(SideSlot::superimposed) != 0) addition_.plan_anew();
    changed_ = true;
}

}  // namespace taktwerk::axes
