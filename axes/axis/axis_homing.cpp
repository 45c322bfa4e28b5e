// MC_Home: which sequence runs, and how its result becomes the axis' coordinates.

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_core.hpp"
#include "axes/homing/index_doubt.hpp"

namespace taktwerk::axes {

namespace {

bool slow_line(const DriveCapabilities& drive) noexcept { return drive.setpoints == SetpointClass::low_dynamics; }

/// `way`: counts from the switch's edge, as it was seen, to the first pulse behind it. A switch that is polled has to leave room on both sides.
bool pulse_is_certain(const DriveCapabilities& drive, const AxisConfig& config, std::int64_t way) noexcept {
    if (!slow_line(drive) || config.homing.kind != HomingKind::reference_pulse) return true;
    const auto turn = config.gearing.counts_per_revolution, room = turn / 8;
    const auto far = way < 0 ? -way : way;
    return far >= room && far <= turn - room;
}

}  // namespace

ErrorId AxisCore::refuse_home() const noexcept {
    const auto& drive = port_.capabilities();
    switch (config_.homing.kind) {
        case HomingKind::none: return ErrorId::not_supported;
        case HomingKind::drive: {
            if (!drive.drive_homing) return ErrorId::not_supported;
            // The drive has its speeds from the start-up: limits that a program has lowered since bind it all the same.
            const auto& homing = config_.homing;
            const bool faster = std::max(homing.search_velocity, homing.latch_velocity) > config_.limits.velocity;
            return faster && !drive.homing_per_run ? ErrorId::invalid_velocity : ErrorId::none;
        }
        case HomingKind::limit_switch: return drive.digital_inputs ? ErrorId::none : ErrorId::not_supported;
        case HomingKind::reference_pulse: return refuse_reference({.source = TriggerSource::index_pulse});
        case HomingKind::absolute: return absolute_encoder() ? ErrorId::none : ErrorId::not_supported;
        case HomingKind::home_switch:
        case HomingKind::set_here:
        case HomingKind::block: break;
    }
    return ErrorId::none;
}

/// What the kinds that are built from one step search for.
StepSettings AxisCore::home_search() const noexcept {
    const auto& homing = config_.homing;
    StepSettings run{.velocity = homing.search_velocity, .time_limit = homing.timeout};
    switch (homing.kind) {
        case HomingKind::limit_switch:
            run.search = LimitSearch(MC_SwitchMode::mcFallingEdge, !homing.negative);
            run.fine_velocity = homing.latch_velocity;
            break;
        case HomingKind::reference_pulse:  // the way on which the home switch's edge was left
            run.search = PulseSearch(homing.negative);
            run.velocity = homing.latch_velocity;
            break;
        default:
            run.search = BlockSearch({.positive = !homing.negative,
                                      .torque = homing.torque,
                                      .velocity_limit = homing.block_velocity,
                                      .time = homing.block_time});
            break;
    }
    return run;
}

ErrorId AxisCore::begin_homing(const AxisCommand& command) noexcept {
    const auto& homing = config_.homing;
    home_coordinate_ = std::isnan(command.position) ? homing.offset : command.position;
    view_.homed = false;
    goal_ = {};
    goal_pending_ = false;
    switch (homing.kind) {
        case HomingKind::none: return ErrorId::not_supported;
        case HomingKind::set_here: end_homing(actual_counts_); break;
        case HomingKind::absolute: end_homing(encoder_zero()); break;
        case HomingKind::drive: drive_homing_.start(now_, homing.timeout, port_.capabilities().mode_change_delay, own_mode_); break;
        case HomingKind::home_switch:
        case HomingKind::reference_pulse:
            switch_homing_.start({.search_velocity = homing.search_velocity,
                                  .latch_velocity = homing.latch_velocity,
                                  .negative = homing.negative,
                                  .timeout = homing.timeout},
                                 now_);
            break;
        case HomingKind::block: block_torque_ = homing.torque; [[fallthrough]];
        case HomingKind::limit_switch: step_run_.start(home_search(), now_, actual_counts_); break;
    }
    return ErrorId::none;
}

std::int64_t AxisCore::encoder_range() const noexcept {
    if (config_.memory.range > 0) return config_.memory.range;
    const auto bits = std::min<unsigned>(port_.capabilities().position_bits, 62);
    return std::int64_t{1} << bits;
}

/// counts; the encoder's (or the drive's) own zero. Its raw position may have wrapped: zero is the nearest multiple of the range.
std::int64_t AxisCore::encoder_zero() const noexcept {
    const auto range = static_cast<double>(encoder_range());
    return static_cast<std::int64_t>(std::round(static_cast<double>(actual_counts_) / range) * range);
}

void AxisCore::step_homing() noexcept {
    watch_passive_homing();
    if (drive_homing_.busy()) {
        if (power_.follows_actual()) drive_homing_.cancel();
        if (feedback_.homing_setup_refused && view_.state == AxisState::Homing)
            fail(AxisAlarm::drive_homing_refused, config_.homing.method);
        guard_drive_speed(feedback_.velocity / units_.counts_per_unit());
        switch (drive_homing_.step(feedback_, drive_stands(), now_)) {
            case DriveHoming::Result::attained: {
                // The drive's own zero is the reference. Its raw position may have wrapped on the way: zero is the nearest multiple.
                const double span = std::ldexp(1.0, port_.capabilities().position_bits);
                if (view_.state == AxisState::Homing)
                    end_homing(static_cast<std::int64_t>(std::round(static_cast<double>(actual_counts_) / span) * span));
                break;
            }
            case DriveHoming::Result::failed:
                if (!feedback_.homing_setup_refused) fail(AxisAlarm::drive_homing_failed, config_.homing.method, feedback_.error_code);
                break;
            case DriveHoming::Result::timed_out:
                fail(AxisAlarm::drive_homing_timeout, config_.homing.method, to_seconds(config_.homing.timeout));
                break;
            case DriveHoming::Result::aborted:
            case DriveHoming::Result::none: break;
        }
        return;
    }
    if (queue_.active().command.kind == CommandKind::homing_step) follow_homing_step();
    else if (step_run_.busy()) run_home_search();
    else search_home_switch();
}

/// What the port makes sure of before it starts the drive's homing. Nothing: the start-up list has it.
DriveHomingSetup AxisCore::drive_homing_setup() const noexcept {
    if (!drive_homing_.busy() || !port_.capabilities().homing_per_run) return {};
    const double scale = std::abs(units_.counts_per_unit());
    const auto& homing = config_.homing;
    const auto& limits = config_.limits;
    return {homing.method, std::min(homing.search_velocity, limits.velocity) * scale,
            std::min(homing.latch_velocity, limits.velocity) * scale,
            std::min({homing.acceleration, limits.acceleration, limits.deceleration}) * scale};
}

/// What homing gave is gone, and so is what was kept of it.
void AxisCore::lose_reference() noexcept {
    if (!view_.homed && !retained_.homed) return;
    view_.homed = false;
    retained_ = {};
    fail(AxisAlarm::reference_lost, feedback_.error_code);
}

void AxisCore::search_home_switch() noexcept {
    const bool seeks_index = switch_homing_.phase() == SwitchHoming::Phase::finished && latch_.armed();
    if (!switch_homing_.busy() && !seeks_index) return;
    switch_homing_.step({.fresh = feedback_.fresh,
                         .home_switch = feedback_.home_switch,
                         .negative_limit = negative_switch_,
                         .positive_limit = positive_switch_,
                         .position = feedback_.position,
                         .standing = setpoint_.at_rest() && !goal_pending_,
                         .now = now_});
    switch (switch_homing_.phase()) {
        case SwitchHoming::Phase::finished:
            if (config_.homing.kind == HomingKind::reference_pulse) {
                if (!seeks_index) arm_latch({.source = TriggerSource::index_pulse}, false);
                // Over a slow line the drive finds out where its index is while the motor rests.
                if (slow_line(port_.capabilities())) {
                    if (feedback_.homing_error) fail(AxisAlarm::homing_failed, index_unknown.number, 0);
                    if (feedback_.homing_error || !feedback_.probes[latch_.probe()].armed) return;
                }
                switch_homing_.cancel();
                step_run_.start(home_search(), now_, actual_counts_);
            } else end_homing(switch_homing_.reference());
            return;
        case SwitchHoming::Phase::failed: fail(AxisAlarm::homing_failed, static_cast<double>(switch_homing_.failed_in()), 0); return;
        case SwitchHoming::Phase::timed_out: fail(AxisAlarm::homing_timeout, to_seconds(config_.homing.timeout)); return;
        default: break;
    }
    const bool on_course = goal_.kind == Goal::Kind::velocity && goal_.value == switch_homing_.velocity();
    if (on_course) return;
    // Homing has velocities of its own; only the axis' limit holds them down.
    const double speed = std::min(std::abs(switch_homing_.velocity()), config_.limits.velocity);
    aim(Goal::Kind::velocity, std::copysign(speed, switch_homing_.velocity()), homing_dynamics(), VelocityLimiter::command);
}

MotionLimits AxisCore::homing_dynamics() const noexcept {
    auto dynamics = full_limits(config_.limits);
    dynamics.acceleration = choose(config_.homing.acceleration, 0, dynamics.acceleration);
    dynamics.deceleration = choose(config_.homing.acceleration, 0, dynamics.deceleration);
    return dynamics;
}

void AxisCore::run_home_search() noexcept {
    auto dynamics = homing_dynamics();
    dynamics.velocity = std::min(config_.homing.search_velocity, dynamics.velocity);
    drive_step({.source = TriggerSource::index_pulse}, dynamics);
    switch (step_run_.result()) {
        case StepRun::End::none: return;
        case StepRun::End::found:
            if (pulse_is_certain(port_.capabilities(), config_, step_run_.place() - switch_homing_.reference()))
                end_homing(step_run_.place());
            else fail(AxisAlarm::homing_failed, index_near_edge.number, 0);
            return;
        case StepRun::End::time_limit: fail(AxisAlarm::homing_timeout, to_seconds(config_.homing.timeout)); break;
        default: fail(AxisAlarm::homing_failed, static_cast<double>(step_run_.result()), 0); break;
    }
}

/// The motor's place `at` is the load's `coordinate`, whatever compensation adds on the way between them.
void AxisCore::set_coordinate(std::int64_t at, double coordinate) noexcept { units_.set_program(at, coordinate + compensation_.offset()); }

void AxisCore::end_homing(std::int64_t reference) noexcept {
    set_coordinate(reference, home_coordinate_);
    view_.homed = true;
    switch_homing_.cancel();
    step_run_.cancel();
    latch_.release();
    goal_ = {};
    queue_.finish_active(Outcome::done);
    start_waiting(0);
}

void AxisCore::abort_homing() noexcept {
    if (step_run_.busy() || switch_homing_.phase() == SwitchHoming::Phase::finished) latch_.release();
    switch_homing_.cancel();
    step_run_.cancel();
    if (power_.follows_actual()) drive_homing_.cancel();
    else drive_homing_.abort(now_);
}

}  // namespace taktwerk::axes
