#include "axes/axis/homing_steps.hpp"

#include <algorithm>
#include <cmath>

#include "axes/axis/aim.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/homing_reference.hpp"
#include "axes/axis/search_motion.hpp"

namespace taktwerk::axes {

namespace {

ErrorId error_of(StepRun::End end) noexcept {
    switch (end) {
        case StepRun::End::none:
        case StepRun::End::found: return ErrorId::none;
        case StepRun::End::failed: return ErrorId::homing_failed;
        case StepRun::End::time_limit: return ErrorId::homing_limit_time;
        case StepRun::End::distance_limit: return ErrorId::homing_limit_distance;
        case StepRun::End::torque_limit: return ErrorId::homing_limit_torque;
        case StepRun::End::not_permitted: return ErrorId::interlocked;
    }
    return ErrorId::homing_failed;
}

const HomingStepDetails& details_of(const AxisCommand& command) noexcept { return *std::get_if<HomingStepDetails>(&command.details); }

}  // namespace

ErrorId HomingSteps::refuse(const HomingStepDetails& step, bool starts_now) const noexcept {
    const auto& drive = body_.port.capabilities();
    switch (step.step) {
        case HomingStep::absolute_switch:
            // A latch knows its edge, not the level by which such a search turns around.
            return HomingReference::latched_by_drive(step.reference) ? ErrorId::not_supported : reference_.refuse(step.reference);
        case HomingStep::flying_switch:
        case HomingStep::reference_pulse:
        case HomingStep::flying_reference_pulse: return reference_.refuse(step.reference);
        case HomingStep::limit_switch: return drive.digital_inputs ? ErrorId::none : ErrorId::not_supported;
        case HomingStep::distance_coded:
            return body_.config.homing.marks.valid() ? reference_.refuse({.source = TriggerSource::index_pulse}) : ErrorId::not_supported;
        case HomingStep::absolute: return measured_.absolute_encoder() ? ErrorId::none : ErrorId::not_supported;
        case HomingStep::finish:
            if (!starts_now || runs_.step_succeeded) return ErrorId::none;
            return body_.homing_procedure ? ErrorId::homing_failed : ErrorId::state_forbids;
        case HomingStep::block:
        case HomingStep::direct: break;
    }
    return ErrorId::none;
}

ErrorId HomingSteps::begin(const AxisCommand& command) noexcept {
    const auto& step = details_of(command);
    body_.homed = false;
    const auto dynamics = dynamics_of(command, body_.config.limits, body_.config.defaults);
    const bool positive = step.direction == MC_HomeDirection::mcPositiveDirection || step.direction == MC_HomeDirection::mcSwitchPositive;
    StepSettings run{.velocity = command.velocity,
                     .time_limit = step.time_limit,
                     .distance_limit = std::llround(step.distance_limit * std::abs(body_.units.counts_per_unit())),
                     .torque_limit = step.torque_limit};
    switch (step.step) {
        case HomingStep::absolute_switch: run.search = SwitchSearch(step.switch_mode, step.direction); break;
        case HomingStep::limit_switch: run.search = LimitSearch(step.switch_mode, positive); break;
        case HomingStep::block:
            runs_.block_torque = step.torque_limit;
            run.search = BlockSearch({.positive = positive,
                                      .torque = step.torque_limit,
                                      .velocity_limit = step.detection_velocity_limit,
                                      .time = step.detection_velocity_time});
            break;
        case HomingStep::reference_pulse:
            run.search = PulseSearch(positive);
            reference_.arm(step.reference, false);
            break;
        case HomingStep::distance_coded:
            run.search = CodedSearch(body_.config.homing.marks, positive);
            reference_.arm({.source = TriggerSource::index_pulse}, true);
            break;
        case HomingStep::finish:
            if (command.position != 0) {
                auto limits = dynamics;
                limits.velocity = std::min(command.velocity, limits.velocity);
                aim_.start_at_base();
                aim_.at(Goal::Kind::position, motion_.origin + command.position, limits, VelocityLimiter::command);
                return ErrorId::none;
            }
            [[fallthrough]];
        case HomingStep::direct:
        case HomingStep::absolute: aim_.at_rest(dynamics); return ErrorId::none;
        case HomingStep::flying_switch:
        case HomingStep::flying_reference_pulse: return ErrorId::invalid_parameter;  // they have a slot of their own
    }
    runs_.step.start(run, body_.now, measured_.counts);
    return ErrorId::none;
}

void HomingSteps::follow() noexcept {
    const auto command = body_.queue.active().command;
    const auto& step = details_of(command);
    if (!searches(step.step)) {
        guard_finish();
        return;
    }
    if (body_.begin_pending || !runs_.step.busy()) return;
    auto dynamics = dynamics_of(command, body_.config.limits, body_.config.defaults);
    dynamics.velocity = std::min(command.velocity, dynamics.velocity);
    search_.drive(step.reference, dynamics);
    const auto end = runs_.step.result();
    if (end == StepRun::End::none) return;
    if (end == StepRun::End::found) {
        const double from_zero = static_cast<double>(runs_.step.absolute()) / body_.units.counts_per_unit();
        if (step.step == HomingStep::distance_coded) reference_.set_coordinate(runs_.step.place(), body_.config.homing.offset + from_zero);
        else if (!std::isnan(step.set_position)) reference_.set_coordinate(runs_.step.place(), step.set_position);
    }
    end_step(error_of(end));
}

/// The last move runs without a search: a limit switch ahead ends it.
void HomingSteps::guard_finish() noexcept {
    const double velocity = motion_.setpoint.state().velocity;
    const bool forbidden = (velocity > 0 && (measured_.positive_switch || !body_.permit_positive)) ||
                           (velocity < 0 && (measured_.negative_switch || !body_.permit_negative));
    if (!forbidden || body_.begin_pending || motion_.goal.kind != Goal::Kind::position) return;
    runs_.step_succeeded = false;
    body_.queue.finish_active(Outcome::error, ErrorId::interlocked);
    body_.queue.finish_waiting(Outcome::aborted);
    aim_.at_rest(stop_limits(body_.config.limits));
}

void HomingSteps::end_step(ErrorId error) noexcept {
    runs_.step.cancel();
    runs_.latch.release();
    motion_.goal = {};
    runs_.step_succeeded = error == ErrorId::none;
    body_.queue.finish_active(runs_.step_succeeded ? Outcome::done : Outcome::error, error);
    if (!runs_.step_succeeded) body_.queue.finish_waiting(Outcome::aborted);  // what was to build on it
    over_ = true;
}

bool HomingSteps::complete() noexcept {
    const auto& command = body_.queue.active().command;
    const auto& step = details_of(command);
    if (searches(step.step) || body_.begin_pending) return false;
    motion_.setpoint.go_to_end();
    if (step.step == HomingStep::direct) reference_.set_coordinate(measured_.counts, step.set_position);
    if (step.step == HomingStep::absolute) reference_.set_coordinate(measured_.encoder_zero(), body_.config.homing.offset);
    body_.homing_procedure = runs_.step_succeeded = false;
    body_.homed = true;
    motion_.goal = {};
    body_.queue.finish_active(Outcome::done);
    return true;
}

}  // namespace taktwerk::axes
