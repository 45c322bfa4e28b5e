#include "runtime/machine/measuring.hpp"

#include <cmath>

namespace taktwerk::runtime {

using axes::AxisState;
using axes::ErrorId;
using axes::ExcitationRefusal;

namespace {

Verdict verdict_of(ExcitationRefusal refusal) noexcept {
    switch (refusal) {
        case ExcitationRefusal::none: return {};
        case ExcitationRefusal::below_limit:
        case ExcitationRefusal::above_limit: return {Answer::refused_by_axis, ErrorId::beyond_software_limit};
        case ExcitationRefusal::no_velocity: return {Answer::not_possible_now};
        default: return {Answer::bad_value};
    }
}

}  // namespace

Verdict Measuring::command(const OperatorCommand& command, std::size_t axis) noexcept {
    const bool mine = state_.axis == axis && client_ == command.client;
    if (state_.running && !mine) return {Answer::not_possible_now};
    if (command.flag && !state_.running) return press(command, axis);
    if (!state_.running) return mine && state_.end == MeasureEnd::done ? Verdict{} : Verdict{Answer::stale};
    if (body_.axes[axis].view().owner != owner_) return {Answer::no_control, ErrorId::owned_by_other};
    renewed_ = body_.now;
    return {};
}

Verdict Measuring::press(const OperatorCommand& command, std::size_t index) noexcept {
    auto& axis = body_.axes[index];
    const auto& view = axis.view();
    const auto& config = axis.config();
    if (body_.mode == Mode::automatic) return {Answer::wrong_mode};
    if (view.owner != command.owner) return runtime::verdict_of(ErrorId::owned_by_other);
    if (body_.emergency) return runtime::verdict_of(ErrorId::interlocked);
    if (view.state == AxisState::ErrorStop) return runtime::verdict_of(ErrorId::in_error_stop);
    if (!view.powered) return runtime::verdict_of(ErrorId::not_powered);
    if (view.state != AxisState::Standstill || view.set_velocity != 0) return runtime::verdict_of(ErrorId::not_at_standstill);
    const bool limited = config.modulo == 0 && (std::isfinite(config.limits.position_min) || std::isfinite(config.limits.position_max));
    if (limited && !view.homed) return runtime::verdict_of(ErrorId::not_homed);
    const axes::ExcitationPlan plan(command.measure, measure_bounds(config, view, body_.mode, body_.config.cycle));
    if (plan.refusal() != ExcitationRefusal::none) return verdict_of(plan.refusal());

    axes::AxisCommand wanted;
    wanted.kind = axes::CommandKind::external;
    wanted.jerk = plan.jerk();  // else whatever stops it would drop its acceleration
    const auto submitted = body_.requests.submit({static_cast<std::uint16_t>(index)}, wanted, command.owner);
    if (submitted.error != ErrorId::none) return runtime::verdict_of(submitted.error);
    command_ = submitted.id;
    owner_ = command.owner;
    client_ = command.client;
    renewed_ = body_.now;
    begins_ = true;
    unwrapped_ = 0;
    override_ = velocity_override(view);
    excitation_ = axes::Excitation(plan);
    state_ = {state_.run + 1, static_cast<std::uint16_t>(index), true, MeasureEnd::none, ErrorId::none, 0, state_.lost, plan};
    return {};
}

/// A modulo axis has several names for one place; it takes the one that is no leap.
ErrorId Measuring::feed(const axes::MotionState& next) noexcept {
    auto& axis = body_.axes[state_.axis];
    const double modulo = axis.config().modulo;
    auto error = ErrorId::none;
    for (const double turns : {0.0, -modulo, modulo}) {
        error = axis.set(axes::SetpointFeed{next.position + unwrapped_ + turns, next.velocity, next.acceleration}, owner_);
        if (error == ErrorId::none) unwrapped_ += turns;
        if (error != ErrorId::invalid_velocity || modulo == 0) break;
    }
    return error;
}

void Measuring::end(MeasureEnd how, ErrorId error) noexcept {
    state_.running = false;
    state_.end = how;
    state_.error = error;
    if (how != MeasureEnd::alarm && how != MeasureEnd::stopped) (void)hands_.let_go(state_.axis);
}

void Measuring::step() noexcept {
    if (!state_.running) return;
    auto& axis = body_.axes[state_.axis];
    const auto status = axis.view().status(command_);
    if (status != axes::CommandStatus::active && status != axes::CommandStatus::in_target && status != axes::CommandStatus::queued)
        return end(axis.view().state == AxisState::ErrorStop ? MeasureEnd::alarm : MeasureEnd::stopped);
    if (body_.now - renewed_ >= axis.config().patience.jog_lease) return end(MeasureEnd::lease);
    // Fed set-points take no override. Who turns it down wants it slower now, and a measurement that changes on the way is none.
    if (velocity_override(axis.view()) < override_) {
        (void)hands_.let_go(state_.axis);
        return end(MeasureEnd::stopped);
    }
    if (begins_) return;  // the axis takes the command over as it plans, and what it was fed before is lost
    axes::MotionState next;
    const bool goes_on = excitation_.step(next);
    state_.elapsed = excitation_.elapsed();
    if (const auto error = feed(next); error != ErrorId::none) return end(MeasureEnd::refused, error);
    if (!goes_on) end(MeasureEnd::done);
}

void Measuring::keep() noexcept {
    if (!state_.running) return;
    if (begins_) {
        begins_ = false;
        return;
    }
    const auto& view = body_.axes[state_.axis].view();
    axes::MeasureSample sample;
    sample.cycle = body_.cycles;
    sample.run = state_.run;
    sample.leg = static_cast<std::uint16_t>(excitation_.leg());
    sample.holds = excitation_.holds();
    sample.fresh = view.online && view.answered;
    sample.set_position = view.set_position;
    sample.set_velocity = view.set_velocity;
    sample.set_acceleration = view.set_acceleration;
    sample.actual_position = view.actual_position;
    sample.actual_velocity = view.actual_velocity;
    sample.following_error = view.following_error;
    sample.torque = view.actual_torque;
    if (!samples_.try_push(sample)) ++state_.lost;
}

}  // namespace taktwerk::runtime
