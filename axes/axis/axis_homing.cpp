#include "axes/axis/axis_homing.hpp"

#include <algorithm>
#include <cmath>

#include "axes/axis/aim.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/conduct.hpp"
#include "axes/axis/direction_limits.hpp"
#include "axes/axis/homing_reference.hpp"
#include "axes/axis/homing_steps.hpp"
#include "axes/axis/limit_guard.hpp"
#include "axes/axis/search_motion.hpp"
#include "axes/homing/index_doubt.hpp"

namespace taktwerk::axes {

namespace {

/// `way`: counts from the switch's edge, as it was seen, to the first pulse behind it. A switch that is polled has to leave room on both sides.
bool pulse_is_certain(const DriveCapabilities& drive, const AxisConfig& config, std::int64_t way) noexcept {
    if (drive.setpoints != SetpointClass::low_dynamics || config.homing.kind != HomingKind::reference_pulse) return true;
    const auto turn = config.gearing.counts_per_revolution, room = turn / 8;
    const auto far = way < 0 ? -way : way;
    return far >= room && far <= turn - room;
}

}  // namespace

ErrorId AxisHoming::refuse() const noexcept {
    const auto& drive = body_.port.capabilities();
    switch (body_.config.homing.kind) {
        case HomingKind::none: return ErrorId::not_supported;
        case HomingKind::drive: {
            if (!drive.drive_homing) return ErrorId::not_supported;
            // The drive has its speeds from the start-up: limits that a program has lowered since bind it all the same.
            const auto& homing = body_.config.homing;
            const bool faster = std::max(homing.search_velocity, homing.latch_velocity) > slowest(body_.config.limits);
            return faster && !drive.homing_per_run ? ErrorId::invalid_velocity : ErrorId::none;
        }
        case HomingKind::limit_switch: return drive.digital_inputs ? ErrorId::none : ErrorId::not_supported;
        case HomingKind::reference_pulse: return reference_.refuse({.source = TriggerSource::index_pulse});
        case HomingKind::absolute: return measured_.absolute_encoder() ? ErrorId::none : ErrorId::not_supported;
        case HomingKind::home_switch:
        case HomingKind::set_here:
        case HomingKind::block: break;
    }
    return ErrorId::none;
}

/// What the kinds that are built from one step search for.
StepSettings AxisHoming::home_search() const noexcept {
    const auto& homing = body_.config.homing;
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

ErrorId AxisHoming::begin(const AxisCommand& command) noexcept {
    const auto& homing = body_.config.homing;
    home_coordinate_ = std::isnan(command.position) ? homing.offset : command.position;
    body_.homed = false;
    motion_.goal = {};
    motion_.goal_pending = false;
    switch (homing.kind) {
        case HomingKind::none: return ErrorId::not_supported;
        case HomingKind::set_here: end(measured_.counts); break;
        case HomingKind::absolute: end(measured_.encoder_zero()); break;
        case HomingKind::drive:
            runs_.drive.start(body_.now, homing.timeout, body_.port.capabilities().mode_change_delay, modes_.own);
            break;
        case HomingKind::home_switch:
        case HomingKind::reference_pulse:
            runs_.by_switch.start({.search_velocity = homing.search_velocity,
                                   .latch_velocity = homing.latch_velocity,
                                   .negative = homing.negative,
                                   .two_sides = body_.config.gantry.square_velocity > 0,
                                   .timeout = homing.timeout},
                                  body_.now);
            break;
        case HomingKind::block: runs_.block_torque = homing.torque; [[fallthrough]];
        case HomingKind::limit_switch: runs_.step.start(home_search(), body_.now, measured_.counts); break;
    }
    return ErrorId::none;
}

void AxisHoming::step() noexcept {
    if (runs_.drive.busy()) {
        if (body_.power.follows_actual()) runs_.drive.cancel();
        if (measured_.feedback.homing_setup_refused && body_.state == AxisState::Homing)
            conduct_.fail(AxisAlarm::drive_homing_refused, body_.config.homing.method);
        (void)guard_.drive_speed(measured_.feedback.velocity / body_.units.counts_per_unit());
        switch (runs_.drive.step(measured_.feedback, measured_.stands(), body_.now)) {
            case DriveHoming::Result::attained: {
                // The drive's own zero is the reference. Its raw position may have wrapped on the way: zero is the nearest multiple.
                const double span = std::ldexp(1.0, body_.port.capabilities().position_bits);
                if (body_.state == AxisState::Homing)
                    end(static_cast<std::int64_t>(std::round(static_cast<double>(measured_.counts) / span) * span));
                break;
            }
            case DriveHoming::Result::failed:
                if (!measured_.feedback.homing_setup_refused)
                    conduct_.fail(AxisAlarm::drive_homing_failed, body_.config.homing.method, measured_.feedback.error_code);
                break;
            case DriveHoming::Result::timed_out:
                conduct_.fail(AxisAlarm::drive_homing_timeout, body_.config.homing.method, to_seconds(body_.config.homing.timeout));
                break;
            case DriveHoming::Result::aborted:
            case DriveHoming::Result::none: break;
        }
        return;
    }
    if (body_.queue.active().command.kind == CommandKind::homing_step) steps_.follow();
    else if (runs_.step.busy()) run_home_search();
    else search_home_switch();
}

void AxisHoming::search_home_switch() noexcept {
    const bool seeks_index = runs_.by_switch.phase() == SwitchHoming::Phase::finished && runs_.latch.armed();
    if (!runs_.by_switch.busy() && !seeks_index && !runs_.squares) return;
    if (runs_.squares) {
        runs_.squares = body_.port.squaring();
        if (!runs_.squares) end(runs_.by_switch.reference());
        return;
    }
    runs_.by_switch.step({.fresh = measured_.feedback.fresh,
                          .home_switch = measured_.feedback.home_switch,
                          .follower_switch = body_.port.follower_home_switch(),
                          .follower_ahead = std::llround(body_.port.skew()),
                          .negative_limit = measured_.negative_switch,
                          .positive_limit = measured_.positive_switch,
                          .position = measured_.feedback.position,
                          .standing = motion_.setpoint.at_rest() && !motion_.goal_pending,
                          .now = body_.now});
    switch (runs_.by_switch.phase()) {
        case SwitchHoming::Phase::finished:
            if (body_.config.homing.kind == HomingKind::reference_pulse) {
                if (!seeks_index) reference_.arm({.source = TriggerSource::index_pulse}, false);
                // Over a slow line the drive finds out where its index is while the motor rests.
                if (body_.slow_line) {
                    if (measured_.feedback.homing_error) conduct_.fail(AxisAlarm::homing_failed, index_unknown.number, 0);
                    if (measured_.feedback.homing_error || !measured_.feedback.probes[runs_.latch.probe()].armed) return;
                }
                runs_.by_switch.cancel();
                runs_.step.start(home_search(), body_.now, measured_.counts);
            } else take_edge();
            return;
        case SwitchHoming::Phase::failed:
            conduct_.fail(AxisAlarm::homing_failed, static_cast<double>(runs_.by_switch.failed_in()), 0);
            return;
        case SwitchHoming::Phase::timed_out: conduct_.fail(AxisAlarm::homing_timeout, to_seconds(body_.config.homing.timeout)); return;
        default: break;
    }
    const bool on_course = motion_.goal.kind == Goal::Kind::velocity && motion_.goal.value == runs_.by_switch.velocity();
    if (on_course) return;
    // Homing has velocities of its own; only the axis' limit holds them down.
    const double wanted = runs_.by_switch.velocity();
    const double speed = std::min(std::abs(wanted), body_.config.limits.velocity_towards(wanted));
    aim_.at(Goal::Kind::velocity, std::copysign(speed, wanted), dynamics(), VelocityLimiter::command);
}

/// The edge is the reference; of a portal that is to be squared the other side is led to where its own says.
void AxisHoming::take_edge() noexcept {
    const auto& gantry = body_.config.gantry;
    if (gantry.square_velocity <= 0) return end(runs_.by_switch.reference());
    const double scale = std::abs(body_.units.counts_per_unit());
    const double offset = gantry.square_offset * body_.units.counts_per_unit();
    const auto further = static_cast<std::int64_t>(std::llround(static_cast<double>(runs_.by_switch.follower_behind()) - offset));
    const double skew = -static_cast<double>(further) / body_.units.counts_per_unit();
    if (std::abs(skew) > gantry.error) return conduct_.fail(AxisAlarm::gantry_skew, skew, gantry.error);
    constexpr double ramp = 0.1;  // s
    body_.port.square(further - std::llround(body_.port.skew()), {gantry.square_velocity * scale, gantry.square_velocity * scale / ramp});
    runs_.squares = true;
}

MotionLimits AxisHoming::dynamics() const noexcept {
    auto dynamics = full_limits(body_.config.limits);
    dynamics.acceleration = choose(body_.config.homing.acceleration, 0, dynamics.acceleration);
    dynamics.deceleration = choose(body_.config.homing.acceleration, 0, dynamics.deceleration);
    return dynamics;
}

void AxisHoming::run_home_search() noexcept {
    auto run = dynamics();
    run.velocity = std::min(body_.config.homing.search_velocity, run.velocity);
    search_.drive({.source = TriggerSource::index_pulse}, run);
    switch (runs_.step.result()) {
        case StepRun::End::none: return;
        case StepRun::End::found:
            if (pulse_is_certain(body_.port.capabilities(), body_.config, runs_.step.place() - runs_.by_switch.reference()))
                end(runs_.step.place());
            else conduct_.fail(AxisAlarm::homing_failed, index_near_edge.number, 0);
            return;
        case StepRun::End::time_limit: conduct_.fail(AxisAlarm::homing_timeout, to_seconds(body_.config.homing.timeout)); break;
        default: conduct_.fail(AxisAlarm::homing_failed, static_cast<double>(runs_.step.result()), 0); break;
    }
}

void AxisHoming::end(std::int64_t reference) noexcept {
    reference_.set_coordinate(reference, home_coordinate_);
    body_.homed = true;
    runs_.by_switch.cancel();
    runs_.step.cancel();
    runs_.latch.release();
    motion_.goal = {};
    body_.queue.finish_active(Outcome::done);
    over_ = true;
}

DriveHomingSetup AxisHoming::drive_setup() const noexcept {
    if (!runs_.drive.busy() || !body_.port.capabilities().homing_per_run) return {};
    const double scale = std::abs(body_.units.counts_per_unit());
    const auto& homing = body_.config.homing;
    const auto limits = gentlest(full_limits(body_.config.limits), body_.config.limits);  // which way it searches is the drive's affair
    const double fastest = slowest(body_.config.limits);
    return {homing.method, std::min(homing.search_velocity, fastest) * scale, std::min(homing.latch_velocity, fastest) * scale,
            std::min({homing.acceleration, limits.acceleration, limits.deceleration}) * scale};
}

}  // namespace taktwerk::axes
