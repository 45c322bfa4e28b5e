// PLCopen Part 5: homing step by step. The axis is in Homing from the first step until MC_FinishHoming (or MC_HomeDirect, MC_HomeAbsolute),
// and not homed in between. A step that meets one of its limits, or finds nothing, ends with that error: the axis stops along its ramp and
// stays in Homing, so that the program may try another step; MC_Stop gives up.

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_core.hpp"

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

bool latched_by_drive(const TriggerRef& reference) noexcept {
    return reference.source != TriggerSource::home_switch && reference.source != TriggerSource::input;
}

/// A latch may serve the index pulse alone (XP200).
bool has_edge(const DriveCapabilities& drive, unsigned probe, bool falling) noexcept {
    return ((drive.probe_edges >> (2 * probe + (falling ? 1 : 0))) & 1u) != 0;
}

const HomingStepDetails& details_of(const AxisCommand& command) noexcept { return *std::get_if<HomingStepDetails>(&command.details); }

}  // namespace

ErrorId AxisCore::refuse_reference(const TriggerRef& reference) const noexcept {
    const auto& drive = port_.capabilities();
    switch (reference.source) {
        case TriggerSource::home_switch: return drive.digital_inputs ? ErrorId::none : ErrorId::not_supported;
        case TriggerSource::input:
            return reference.point < scene_.inputs.size() && reference.bit < 64 ? ErrorId::none : ErrorId::invalid_parameter;
        case TriggerSource::index_pulse:
            if (drive.probes < 1) return ErrorId::no_such_probe;
            break;
        case TriggerSource::probe1:
            if (drive.probes < 1 || !has_edge(drive, 0, reference.falling)) return ErrorId::no_such_probe;
            break;
        case TriggerSource::probe2:
            if (drive.probes < 2 || !has_edge(drive, 1, reference.falling)) return ErrorId::no_such_probe;
            break;
    }
    const auto taken = [this](SideSlot slot) { return view_.side[static_cast<std::size_t>(slot)] != 0; };
    return taken(SideSlot::probe1) || taken(SideSlot::probe2) ? ErrorId::probe_busy : ErrorId::none;
}

ErrorId AxisCore::refuse_step(const HomingStepDetails& step, bool starts_now) const noexcept {
    const auto& drive = port_.capabilities();
    switch (step.step) {
        case HomingStep::absolute_switch:
            // A latch knows its edge, not the level by which such a search turns around.
            return latched_by_drive(step.reference) ? ErrorId::not_supported : refuse_reference(step.reference);
        case HomingStep::flying_switch:
        case HomingStep::reference_pulse:
        case HomingStep::flying_reference_pulse: return refuse_reference(step.reference);
        case HomingStep::limit_switch: return drive.digital_inputs ? ErrorId::none : ErrorId::not_supported;
        case HomingStep::distance_coded:
            return config_.homing.marks.valid() ? refuse_reference({.source = TriggerSource::index_pulse}) : ErrorId::not_supported;
        case HomingStep::absolute: return absolute_encoder() ? ErrorId::none : ErrorId::not_supported;
        case HomingStep::finish:
            if (!starts_now || step_succeeded_) return ErrorId::none;
            return view_.homing_procedure ? ErrorId::homing_failed : ErrorId::state_forbids;
        case HomingStep::block:
        case HomingStep::direct: break;
    }
    return ErrorId::none;
}

bool AxisCore::reference_level(const TriggerRef& reference) const noexcept {
    bool level = false;
    if (reference.source == TriggerSource::home_switch) level = feedback_.home_switch;
    else if (reference.source == TriggerSource::input && reference.point < scene_.inputs.size())
        level = ((scene_.inputs[reference.point] >> reference.bit) & 1) != 0;
    else return false;
    return level != reference.falling;
}

void AxisCore::arm_latch(const TriggerRef& reference, bool continuous) noexcept {
    if (!latched_by_drive(reference)) return;
    latch_.arm(reference.source == TriggerSource::probe2 ? 1 : 0, {.continuous = continuous,
                                                                   .index_pulse = reference.source == TriggerSource::index_pulse,
                                                                   .edge = reference.falling ? ProbeEdge::falling : ProbeEdge::rising});
}

ErrorId AxisCore::begin_homing_step(const AxisCommand& command) noexcept {
    const auto& step = details_of(command);
    view_.homed = false;
    const auto dynamics = dynamics_of(command, config_.limits, config_.defaults);
    const bool positive = step.direction == MC_HomeDirection::mcPositiveDirection || step.direction == MC_HomeDirection::mcSwitchPositive;
    StepSettings run{.velocity = command.velocity,
                     .time_limit = step.time_limit,
                     .distance_limit = std::llround(step.distance_limit * std::abs(units_.counts_per_unit())),
                     .torque_limit = step.torque_limit};
    switch (step.step) {
        case HomingStep::absolute_switch: run.search = SwitchSearch(step.switch_mode, step.direction); break;
        case HomingStep::limit_switch: run.search = LimitSearch(step.switch_mode, positive); break;
        case HomingStep::block:
            block_torque_ = step.torque_limit;
            run.search = BlockSearch({.positive = positive,
                                      .torque = step.torque_limit,
                                      .velocity_limit = step.detection_velocity_limit,
                                      .time = step.detection_velocity_time});
            break;
        case HomingStep::reference_pulse:
            run.search = PulseSearch(positive);
            arm_latch(step.reference, false);
            break;
        case HomingStep::distance_coded:
            run.search = CodedSearch(config_.homing.marks, positive);
            arm_latch({.source = TriggerSource::index_pulse}, true);
            break;
        case HomingStep::finish:
            if (command.position != 0) {
                auto limits = dynamics;
                limits.velocity = std::min(command.velocity, limits.velocity);
                start_at_base();
                aim(Goal::Kind::position, origin_ + command.position, limits, VelocityLimiter::command);
                return ErrorId::none;
            }
            [[fallthrough]];
        case HomingStep::direct:
        case HomingStep::absolute: aim_at_rest(dynamics); return ErrorId::none;
        case HomingStep::flying_switch:
        case HomingStep::flying_reference_pulse: return ErrorId::invalid_parameter;  // they have a slot of their own
    }
    step_run_.start(run, now_, actual_counts_);
    return ErrorId::none;
}

SearchInput AxisCore::search_input(const TriggerRef& reference) noexcept {
    const auto latch = latch_.take(feedback_);
    return {.signal = reference_level(reference),
            .negative_limit = negative_switch_,
            .positive_limit = positive_switch_,
            .position = feedback_.position,
            .latched = latch.has_value(),
            .latch = latch.value_or(0),
            .set_velocity = setpoint_.state().velocity,
            .velocity = feedback_.velocity / units_.counts_per_unit(),
            .torque = config_.gearing.inverted ? -feedback_.torque : feedback_.torque,
            .now = now_};
}

/// Carries out what the step asks for, until it is over.
void AxisCore::drive_step(const TriggerRef& reference, const MotionLimits& dynamics) noexcept {
    step_run_.step(search_input(reference), feedback_.fresh, setpoint_.at_rest() && setpoint_.finished() && !goal_pending_);
    const double velocity = step_run_.velocity();
    const bool forbidden = (velocity > 0 && !permit_positive_) || (velocity < 0 && !permit_negative_);
    if (step_run_.busy() && step_run_.demand() == StepRun::Demand::velocity && forbidden) step_run_.end(StepRun::End::not_permitted);
    if (!step_run_.busy()) return;
    switch (step_run_.demand()) {
        case StepRun::Demand::stop:
            if (goal_.kind != Goal::Kind::stop) aim_at_rest(dynamics);
            break;
        case StepRun::Demand::velocity: {
            // Homing has velocities of its own; only the axis' limit holds them down.
            const double speed = std::min(std::abs(step_run_.velocity()), config_.limits.velocity);
            const double wanted = std::copysign(speed, step_run_.velocity());
            if (goal_.kind != Goal::Kind::velocity || goal_.value != wanted)
                aim(Goal::Kind::velocity, wanted, dynamics, VelocityLimiter::command);
            break;
        }
        case StepRun::Demand::place: {
            const double there = units_.local(step_run_.place());
            if (goal_.kind != Goal::Kind::position || goal_.value != there)
                aim(Goal::Kind::position, there, dynamics, VelocityLimiter::command);
            break;
        }
    }
}

void AxisCore::follow_homing_step() noexcept {
    const auto command = queue_.active().command;
    const auto& step = details_of(command);
    if (!searches(step.step)) {
        guard_finish();
        return;
    }
    if (begin_pending_ || !step_run_.busy()) return;
    auto dynamics = dynamics_of(command, config_.limits, config_.defaults);
    dynamics.velocity = std::min(command.velocity, dynamics.velocity);
    drive_step(step.reference, dynamics);
    const auto end = step_run_.result();
    if (end == StepRun::End::none) return;
    if (end == StepRun::End::found) {
        const double from_zero = static_cast<double>(step_run_.absolute()) / units_.counts_per_unit();
        if (step.step == HomingStep::distance_coded) set_coordinate(step_run_.place(), config_.homing.offset + from_zero);
        else if (!std::isnan(step.set_position)) set_coordinate(step_run_.place(), step.set_position);
    }
    end_homing_step(error_of(end));
}

/// The last move runs without a search: a limit switch ahead ends it.
void AxisCore::guard_finish() noexcept {
    const double velocity = setpoint_.state().velocity;
    const bool forbidden =
        (velocity > 0 && (positive_switch_ || !permit_positive_)) || (velocity < 0 && (negative_switch_ || !permit_negative_));
    if (!forbidden || begin_pending_ || goal_.kind != Goal::Kind::position) return;
    step_succeeded_ = false;
    queue_.finish_active(Outcome::error, ErrorId::interlocked);
    queue_.finish_waiting(Outcome::aborted);
    aim_at_rest(stop_limits(config_.limits));
}

void AxisCore::end_homing_step(ErrorId error) noexcept {
    step_run_.cancel();
    latch_.release();
    goal_ = {};
    step_succeeded_ = error == ErrorId::none;
    queue_.finish_active(step_succeeded_ ? Outcome::done : Outcome::error, error);
    if (!step_succeeded_) queue_.finish_waiting(Outcome::aborted);  // what was to build on it
    start_waiting(0);
}

/// The steps that need no search, once the axis stands. They end the procedure.
bool AxisCore::complete_homing_step() noexcept {
    const auto& command = queue_.active().command;
    const auto& step = details_of(command);
    if (searches(step.step) || begin_pending_) return false;
    setpoint_.go_to_end();
    if (step.step == HomingStep::direct) set_coordinate(actual_counts_, step.set_position);
    if (step.step == HomingStep::absolute) set_coordinate(encoder_zero(), config_.homing.offset);
    view_.homing_procedure = step_succeeded_ = false;
    view_.homed = true;
    goal_ = {};
    queue_.finish_active(Outcome::done);
    start_waiting(0);
    return queue_.has_active();
}

}  // namespace taktwerk::axes
