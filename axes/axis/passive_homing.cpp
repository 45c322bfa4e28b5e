#include "axes/axis/passive_homing.hpp"

#include <cmath>

#include "axes/axis/aim.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/homing_reference.hpp"
#include "axes/axis/homing_steps.hpp"

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

ErrorId PassiveHoming::refuse(const AxisCommand& command) const noexcept {
    if (const auto error = check_numbers(command); error != ErrorId::none) return error;
    if (body_.state == AxisState::Disabled && !body_.config.encoder) return ErrorId::not_powered;
    if (body_.state == AxisState::ErrorStop) return ErrorId::in_error_stop;
    if (body_.state == AxisState::Homing || body_.state == AxisState::Stopping) return ErrorId::state_forbids;
    const auto* step = std::get_if<HomingStepDetails>(&command.details);
    return steps_.refuse(*step, true);
}

Submitted PassiveHoming::submit(const AxisCommand& command) noexcept {
    if (command.kind == CommandKind::abort_passive_homing) {
        end(Outcome::aborted);
        const auto id = body_.queue.next_id();
        body_.queue.record(id, Outcome::done, ErrorId::none);
        return {id, ErrorId::none};
    }
    if (const auto error = refuse(command); error != ErrorId::none) return {0, error};
    end(Outcome::aborted);
    passive_ = {.id = body_.queue.next_id(),
                .step = *std::get_if<HomingStepDetails>(&command.details),
                .since = body_.now,
                .from = measured_.counts};
    reference_.arm(passive_.step.reference, false);
    return {passive_.id, ErrorId::none};
}

void PassiveHoming::end(Outcome outcome, ErrorId error) noexcept {
    if (passive_.id == 0) return;
    body_.queue.record(passive_.id, outcome, error);
    passive_.id = 0;
    runs_.latch.release();
}

void PassiveHoming::watch() noexcept {
    if (passive_.id == 0) return;
    if (body_.state == AxisState::ErrorStop) return end(Outcome::error, ErrorId::aborted_by_axis_error);
    // What homes the axis actively, and what takes its power, takes this with it.
    const bool without_power = body_.state == AxisState::Disabled && !body_.config.encoder;  // what only measures is always Disabled
    if (without_power || body_.state == AxisState::Homing) return end(Outcome::aborted);
    if (!measured_.feedback.fresh) return;

    const auto& step = passive_.step;
    auto& edge = passive_.edge;
    edge.see(reference_.level(step.reference), measured_.feedback.position);
    const auto latch = runs_.latch.take(measured_.feedback);
    const bool pulse = step.step == HomingStep::flying_reference_pulse;
    const auto mode = pulse ? MC_SwitchMode::mcRisingEdge : step.switch_mode;
    const double velocity = measured_.feedback.velocity / body_.units.counts_per_unit();
    const bool seen = runs_.latch.armed() ? latch.has_value() : passed(mode, edge, velocity);
    if (seen) {
        aim_.shift_coordinates(step.set_position - body_.units.to_program(body_.units.local(latch.value_or(edge.place()))));
        body_.homed = true;
        return end(Outcome::done);
    }
    const double way = std::abs(static_cast<double>(measured_.feedback.position - passive_.from) / body_.units.counts_per_unit());
    if (step.distance_limit > 0 && way >= step.distance_limit) end(Outcome::error, ErrorId::homing_limit_distance);
    else if (step.time_limit > Duration::zero() && body_.now - passive_.since >= step.time_limit)
        end(Outcome::error, ErrorId::homing_limit_time);
}

}  // namespace taktwerk::axes
