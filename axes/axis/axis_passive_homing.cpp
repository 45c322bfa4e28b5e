// Passive homing (PLCopen Part 5, flying steps): the axis does what it was told anyway, and when the reference passes by its coordinates are
// set by it. The number of an absolute target stays, so the way to it changes. No state changes; one at a time, a new one replaces the old.

#include <cmath>

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

namespace {

/// `velocity` tells the named edges of a switch apart.
bool passed(MC_SwitchMode mode, const EdgeWatch& edge, double velocity) noexcept {
    using enum MC_SwitchMode;
    switch (mode) {
        case mcOn: return edge.level();
        case mcOff: return !edge.level();
        case mcRisingEdge: return edge.rising();
        case mcFallingEdge: return edge.falling();
        case mcEdgeSwitchPositive: return velocity > 0 ? edge.rising() : edge.falling();
        case mcEdgeSwitchNegative: return velocity > 0 ? edge.falling() : edge.rising();
    }
    return false;
}

}  // namespace

ErrorId AxisCore::refuse_passive(const AxisCommand& command) const noexcept {
    if (const auto error = check_numbers(command); error != ErrorId::none) return error;
    if (view_.state == AxisState::Disabled) return ErrorId::not_powered;
    if (view_.state == AxisState::ErrorStop) return ErrorId::in_error_stop;
    if (view_.state == AxisState::Homing || view_.state == AxisState::Stopping) return ErrorId::state_forbids;
    const auto* step = std::get_if<HomingStepDetails>(&command.details);
    return refuse_step(*step, true);
}

Submitted AxisCore::submit_passive(const AxisCommand& command, Owner owner) noexcept {
    if (!may(owner)) return {0, ErrorId::owned_by_other};
    if (command.kind == CommandKind::abort_passive_homing) {
        end_passive_homing(Outcome::aborted);
        const auto id = queue_.next_id();
        queue_.record(id, Outcome::done, ErrorId::none);
        publish();
        return {id, ErrorId::none};
    }
    if (const auto error = refuse_passive(command); error != ErrorId::none) return {0, error};
    end_passive_homing(Outcome::aborted);
    passive_ = {.id = queue_.next_id(), .step = *std::get_if<HomingStepDetails>(&command.details), .since = now_, .from = actual_counts_};
    arm_latch(passive_.step.reference, false);
    publish();
    return {passive_.id, ErrorId::none};
}

void AxisCore::end_passive_homing(Outcome outcome, ErrorId error) noexcept {
    if (passive_.id == 0) return;
    queue_.record(passive_.id, outcome, error);
    passive_.id = 0;
    show_side(SideSlot::passive_homing, 0);
    latch_.release();
}

void AxisCore::watch_passive_homing() noexcept {
    if (passive_.id == 0) return;
    if (view_.state == AxisState::ErrorStop) return end_passive_homing(Outcome::error, ErrorId::aborted_by_axis_error);
    // What homes the axis actively, and what takes its power, takes this with it.
    if (view_.state == AxisState::Disabled || view_.state == AxisState::Homing) return end_passive_homing(Outcome::aborted);
    if (!feedback_.fresh) return;

    const auto& step = passive_.step;
    auto& edge = passive_.edge;
    edge.see(reference_level(step.reference), feedback_.position);
    const auto latch = latch_.take(feedback_);
    const bool pulse = step.step == HomingStep::flying_reference_pulse;
    const auto mode = pulse ? MC_SwitchMode::mcRisingEdge : step.switch_mode;
    const double velocity = feedback_.velocity / units_.counts_per_unit();
    const bool seen = latch_.armed() ? latch.has_value() : passed(mode, edge, velocity);
    if (seen) {
        shift_coordinates(step.set_position - units_.to_program(units_.local(latch.value_or(edge.place()))));
        view_.homed = true;
        return end_passive_homing(Outcome::done);
    }
    const double way = std::abs(static_cast<double>(feedback_.position - passive_.from) / units_.counts_per_unit());
    if (step.distance_limit > 0 && way >= step.distance_limit) end_passive_homing(Outcome::error, ErrorId::homing_limit_distance);
    else if (step.time_limit > Duration::zero() && now_ - passive_.since >= step.time_limit)
        end_passive_homing(Outcome::error, ErrorId::homing_limit_time);
}

}  // namespace taktwerk::axes
