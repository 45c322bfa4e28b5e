#include "axes/axis/drive_profiles.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "axes/axis/aim.hpp"
#include "axes/axis/conduct.hpp"
#include "axes/axis/direction_limits.hpp"
#include "axes/axis/limit_guard.hpp"
#include "axes/axis/motor_lead.hpp"
#include "axes/axis/superimposed_motion.hpp"
#include "axes/axis/targets.hpp"

namespace taktwerk::axes {

namespace {

constexpr double at_once = 1e6;  // rated torques/s: beyond the range of every 6087h (SV33-E 7.3: 2^32 - 1 means no ramp)

}  // namespace

bool DriveProfiles::makes(CommandKind kind) const noexcept {
    const auto& drive = body_.port.capabilities();
    if (drive.setpoints == SetpointClass::low_dynamics || !drive.has(profile_mode_of(kind))) return false;
    if (kind == CommandKind::drive_torque) return drive.velocity_limit;  // else nobody keeps the velocity in its limit
    return profile_mode_of(kind) != DriveMode::profile_position || drive.profile_buffer > 0;
}

ErrorId DriveProfiles::refuse(const AxisCommand& command, bool starts_now) const noexcept {
    if (!starts_now) return ErrorId::none;
    const bool goes_on = modes_.phase == ModePhase::profile && modes_.run.mode() == profile_mode_of(command.kind);
    const bool stands = motion_.setpoint.at_rest() && (!modes_.in_profile() || measured_.stands());
    if (body_.port.capabilities().mode_change_at_standstill && !stands && !goes_on) return ErrorId::not_at_standstill;
    if (command.kind != CommandKind::drive_torque) return ErrorId::none;
    return measured_.permitted(targets_.torque_of(command)) ? ErrorId::none : ErrorId::interlocked;
}

void DriveProfiles::begin(const AxisCommand& command) noexcept {
    addition_.abandon();
    aim_.start_at_base();
    motion_.has_commanded_target = false;
    aim_.at_stop(command);
}

void DriveProfiles::ask_for_mode() noexcept {
    if (!measured_.stands() || !motion_.setpoint.at_rest()) return;  // the motor comes a little later than its set-point
    motion_.setpoint.fold();
    modes_.run.enter(profile_mode_of(body_.queue.active().command.kind));
    modes_.go(ModePhase::profile_entering);
}

/// The command in control is one for the mode the drive is in.
bool DriveProfiles::goes_on() const noexcept {
    const auto kind = body_.queue.active().command.kind;
    if (!made_by_drive(kind) || profile_mode_of(kind) != modes_.run.mode()) return false;
    const bool instead = body_.begin_pending && modes_.run.under_way() && modes_.run.mode() == DriveMode::profile_position;
    return !instead || body_.port.capabilities().profile_replaces;
}

ModeStep DriveProfiles::step(bool confirmed, bool late) noexcept {
    if (modes_.phase == ModePhase::profile_halting) return halt();
    if (!goes_on()) return leave();
    return modes_.phase == ModePhase::profile ? run() : enter(confirmed, late);
}

ModeStep DriveProfiles::enter(bool confirmed, bool late) noexcept {
    lead_.follow();
    if (late) {
        body_.queue.finish_active(Outcome::error, ErrorId::drive_mode_refused);
        conduct_.stop_on_own_account(false);
        return leave();
    }
    if (!confirmed) return ModeStep::made;
    modes_.go(ModePhase::profile);
    body_.begin_pending = true;
    return run();
}

ModeStep DriveProfiles::run() noexcept {
    lead_.follow();
    if (body_.endless && modes_.run.mode() != DriveMode::profile_position && body_.units.far_from_anchor(motion_.setpoint.state().position))
        aim_.reanchor();
    if (const double velocity = motion_.setpoint.state().velocity; velocity != 0) motion_.backwards = velocity < 0;
    const bool resumed = std::exchange(resumed_, false);
    if (resumed) {
    } else if (body_.begin_pending) {
        body_.begin_pending = false;
        if (const auto error = hand_to_drive(body_.queue.active().command); error != ErrorId::none) {
            body_.queue.finish_active(Outcome::error, error);
            conduct_.stop_on_own_account(false);
        }
    } else {
        modes_.run.watch(measured_.feedback, measured_.stands(), body_.now);
        if (judge()) {
            resumed_ = true;
            return ModeStep::next_again;
        }
    }
    if (goes_on()) watch_limits();
    if (!goes_on()) return leave();
    hand_ahead();
    return ModeStep::made;
}

/// What the command means in the drive's counts; `way.target` has been found.
DriveProfileRun::Setpoint DriveProfiles::drive_setpoint(const AxisCommand& command, DriveProfileRun::Way& way) const noexcept {
    const double counts = body_.units.counts_per_unit();
    const auto& axis = body_.config.limits;
    const auto mode = modes_.run.mode();
    const double sense = mode == DriveMode::profile_velocity ? targets_.signed_velocity(command, motion_.backwards) : way.target - way.from;
    auto dynamics = dynamics_of(command, axis, body_.config.defaults);
    dynamics = mode == DriveMode::profile_torque ? gentlest(dynamics, axis) : towards(dynamics, axis, sense);
    const double fastest = mode == DriveMode::profile_torque ? slowest(axis) : axis.velocity_towards(sense);
    DriveProfileRun::Setpoint made;
    made.acceleration = dynamics.acceleration * std::abs(counts);
    made.deceleration = dynamics.deceleration * std::abs(counts);
    const double wanted = command.kind == CommandKind::drive_torque && command.velocity == 0 ? fastest : command.velocity;
    const auto allowed = allowed_speed(std::abs(wanted), fastest, body_.velocity_cap());
    way.limiter = allowed.limiter;
    switch (mode) {
        case DriveMode::profile_velocity: made.velocity = std::copysign(allowed.speed, sense) * counts; break;
        case DriveMode::profile_torque: {
            const double ramp = std::get<TorqueDetails>(command.details).ramp;
            made.torque = (body_.config.gearing.inverted ? -1 : 1) * targets_.torque_of(command);
            made.torque_slope = ramp > 0 ? ramp : at_once;
            made.velocity_limit = allowed.speed * std::abs(counts);
            break;
        }
        default:
            made.velocity = allowed.speed * std::abs(counts);
            made.position = body_.units.counts(way.target + measured_.compensation.offset());
            break;
    }
    return made;
}

ErrorId DriveProfiles::hand_to_drive(const AxisCommand& command) noexcept {
    motion_.goal = {.kind = Goal::Kind::given, .value = 0, .limits = full_limits(body_.config.limits), .limiter = VelocityLimiter::none};
    motion_.goal_pending = false;
    const bool position = modes_.run.mode() == DriveMode::profile_position;
    const bool instead = modes_.run.under_way();
    DriveProfileRun::Way way{.from = measured_.local()};
    if (position) {
        way.target = targets_.drive_target(command, {way.from, motion_.setpoint.state().velocity, 0});
        if (const auto error = targets_.refuse_drive_way(way); error != ErrorId::none) return error;
    }
    auto made = drive_setpoint(command, way);
    made.immediately = position && instead;
    // From standstill every drive means the same by a distance; and where an endless axis' absolute target lies in a range that wraps it does not.
    made.relative = position && !instead && (body_.endless || command.kind == CommandKind::drive_move_relative);
    if (made.relative) made.position = std::llround((way.target - way.from) * body_.units.counts_per_unit());
    motion_.goal.limiter = way.limiter;
    modes_.run.hand(made, way, body_.now);
    body_.queue.set_in_target(false);
    return ErrorId::none;
}

/// PP with a buffer: what waits behind is in the drive before the move in front is over.
void DriveProfiles::hand_ahead() noexcept {
    const auto behind = modes_.run.ahead();
    if (body_.queue.waiting() <= behind || modes_.run.mode() != DriveMode::profile_position) return;
    if (!modes_.run.accepted() || modes_.run.barred() || behind >= body_.port.capabilities().profile_buffer) return;
    const auto& next = body_.queue.waiting_at(behind).command;
    if (profile_mode_of(next.kind) != DriveMode::profile_position || next.buffer_mode != mcBuffered) return;
    DriveProfileRun::Way way{.from = modes_.run.last().target};
    way.target = targets_.drive_target(next, {way.from, 0, 0});
    if (targets_.refuse_drive_way(way) != ErrorId::none) return;  // it hears of it when its turn comes
    const auto made = drive_setpoint(next, way);
    modes_.run.hand_ahead(made, way, body_.now);
}

/// What became of the set-points. True: what waits has its turn.
bool DriveProfiles::judge() noexcept {
    if (modes_.run.refused(body_.now)) {
        if (modes_.run.ahead() > 0) {
            modes_.run.drop_ahead();
            return false;
        }
        body_.queue.finish_active(Outcome::error, ErrorId::drive_setpoint_refused);
        conduct_.stop_on_own_account(false);
        return false;
    }
    if (modes_.run.mode() == DriveMode::profile_position) return judge_move();
    body_.queue.set_in_target(modes_.run.in_target());
    return false;
}

/// Only the last target shows in the drive's "target reached": those before it are over where the motor has come to them.
bool DriveProfiles::judge_move() noexcept {
    const auto& way = modes_.run.front();
    const double missing = way.target - measured_.local();
    const bool near = std::abs(missing) <= body_.config.windows.in_position;
    const bool passed = near || missing * (way.target - way.from) < 0;
    if (!(modes_.run.arrived(near, body_.now) || (modes_.run.ahead() > 0 && passed))) return false;
    body_.queue.finish_active(Outcome::done);
    modes_.run.advance();
    if (modes_.run.under_way()) {
        body_.queue.activate(body_.queue.pop());
        motion_.goal.limiter = modes_.run.front().limiter;
        return false;
    }
    return true;
}

/// By what the drive reports: its way is not ours to plan.
void DriveProfiles::watch_limits() noexcept {
    const auto& at = motion_.setpoint.state();
    if (guard_.drive_speed(at.velocity)) return;
    auto braking = stop_limits(body_.config.limits);
    braking.deceleration = std::min(braking.deceleration, modes_.run.setpoint().deceleration / std::abs(body_.units.counts_per_unit()));
    if (modes_.run.mode() != DriveMode::profile_position) {
        guard_.motor(braking);
        return;
    }
    if (guard_.switches() || !body_.software_limits_hold() || at.velocity == 0) return;
    const double place = body_.units.to_program(measured_.local());
    const double edge = at.velocity > 0 ? body_.config.limits.position_max : body_.config.limits.position_min;
    const double beyond = at.velocity > 0 ? place - edge : edge - place;
    if (beyond > body_.config.windows.in_position) conduct_.fail(AxisAlarm::software_limit_reached, place, edge);
}

ModeStep DriveProfiles::leave() noexcept {
    const bool halts = body_.port.capabilities().mode_change_at_standstill && !measured_.stands();
    modes_.run.leave(body_.now, lead_.longest_ramp(modes_.run.setpoint().deceleration / std::abs(body_.units.counts_per_unit())));
    modes_.halt = halts;
    modes_.go(halts ? ModePhase::profile_halting : ModePhase::leaving);
    return ModeStep::again;
}

ModeStep DriveProfiles::halt() noexcept {
    lead_.follow();
    if (measured_.stands() || !modes_.run.may_still_turn(body_.now)) {
        modes_.go(ModePhase::leaving);
        return ModeStep::again;
    }
    if (guard_.drive_speed(motion_.setpoint.state().velocity)) return ModeStep::made;
    if (modes_.run.mode() != DriveMode::profile_position) guard_.motor(stop_limits(body_.config.limits));
    else if (body_.state == AxisState::Stopping) (void)guard_.limit_switches();
    else if (body_.state != AxisState::ErrorStop) (void)guard_.switches();
    return ModeStep::made;
}

}  // namespace taktwerk::axes
