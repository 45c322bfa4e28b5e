#include "axes/axis/drive_modes.hpp"

#include <algorithm>
#include <chrono>

#include "axes/axis/aim.hpp"
#include "axes/axis/conduct.hpp"
#include "axes/axis/direction_limits.hpp"
#include "axes/axis/drive_output.hpp"
#include "axes/axis/drive_profiles.hpp"
#include "axes/axis/limit_guard.hpp"
#include "axes/axis/motor_lead.hpp"
#include "axes/axis/superimposed_motion.hpp"
#include "axes/axis/targets.hpp"

namespace taktwerk::axes {

namespace {

using namespace std::chrono_literals;

constexpr Duration mode_patience = 500ms;  // a drive that has not taken its mode after this and its own delay will not

constexpr int taking_a_mode = 2;  // cycles from its word to the mode that a drive shows

bool cyclic(DriveMode mode) noexcept {
    return mode == DriveMode::cyclic_position || mode == DriveMode::cyclic_velocity || mode == DriveMode::cyclic_torque;
}
/// Ends motion: taken in any mode, whatever the drive demands for a change.
bool only_stops(CommandKind kind) noexcept { return kind == CommandKind::stop || kind == CommandKind::halt; }

}  // namespace

ErrorId DriveModes::refuse(const AxisCommand& command, bool starts_now) const noexcept {
    const auto& drive = body_.port.capabilities();
    const bool in_torque = modes_.phase == ModePhase::entering || modes_.phase == ModePhase::torque;
    // At the end of a move the motor is a little behind its set-point: then the change waits for it.
    // What was just handed to the drive has not moved the motor yet, and will.
    const bool handed = modes_.run.under_way() && !(modes_.run.in_target() && measured_.stands());
    const bool stands = motion_.setpoint.at_rest() && !handed && (!in_torque || measured_.stands());
    // Out of torque in motion this drive can only be braked first.
    if (starts_now && in_torque && drive.mode_change_at_standstill && !stands && command.kind != CommandKind::torque &&
        !only_stops(command.kind))
        return ErrorId::not_at_standstill;
    if (made_by_drive(command.kind)) return profiles_.refuse(command, starts_now);
    if (command.kind == CommandKind::torque) {
        if (!drive.has(modes_.torque_mode())) return ErrorId::not_supported;
        // Over a slow line the drive keeps the velocity, and brakes out of its torque by itself when it is told to halt.
        const bool by_drive = drive.velocity_limit && (body_.slow_line || !drive.mode_change_at_standstill);
        const bool bounded = by_drive || (body_.config.control.inertia() > 0 && !body_.slow_line);
        if (!bounded) return ErrorId::not_supported;  // nobody would keep the velocity in its limit
        if (!starts_now) return ErrorId::none;
        if (drive.mode_change_at_standstill && !in_torque && !stands) return ErrorId::not_at_standstill;
        return measured_.permitted(targets_.torque_of(command)) ? ErrorId::none : ErrorId::interlocked;
    }
    if (command.kind != CommandKind::set_controller_mode) return ErrorId::none;
    const auto mode = static_cast<DriveMode>(static_cast<std::uint8_t>(command.position));
    if (!cyclic(mode) || !drive.has(mode)) return ErrorId::not_supported;
    if (mode == DriveMode::cyclic_velocity && !(body_.config.control.kv > 0)) return ErrorId::not_supported;  // no position loop
    return !starts_now || stands ? ErrorId::none : ErrorId::not_at_standstill;
}

void DriveModes::begin_torque(const AxisCommand& command) noexcept {
    addition_.abandon();  // there will be no set-point to add to
    const auto& details = std::get<TorqueDetails>(command.details);
    // A load may turn the motor either way.
    const auto dynamics = gentlest(dynamics_of(command, body_.config.limits, body_.config.defaults), body_.config.limits);
    const double fastest = slowest(body_.config.limits);
    const auto allowed = allowed_speed(command.velocity == 0 ? fastest : command.velocity, fastest, body_.velocity_cap());
    modes_.torque_velocity = allowed.speed;
    const double torque = targets_.torque_of(command);
    // A negative torque in a given direction brakes motion in it and does not turn it round (P1-184, P1-187).
    auto sense = TorqueSense::both;
    if (details.torque < 0 && command.direction != mcShortestWay)
        sense = torque < 0 ? TorqueSense::only_positive : TorqueSense::only_negative;
    modes_.torque.command(torque, details.ramp, {allowed.speed, dynamics.acceleration, dynamics.deceleration}, sense);
    modes_.torque_idle = false;
    aim_.at(Goal::Kind::given, 0, full_limits(body_.config.limits), allowed.limiter);
    if (modes_.phase == ModePhase::torque || modes_.phase == ModePhase::entering) return;
    modes_.go(ModePhase::entering);
    modes_.waits = body_.port.capabilities().mode_change_at_standstill;
}

void DriveModes::begin_mode_change(const AxisCommand& command) noexcept {
    const auto mode = static_cast<DriveMode>(static_cast<std::uint8_t>(command.position));
    motion_.goal = {};
    motion_.goal_pending = false;
    // It stands, but for what it took over of a motor that a drive without torque lets go.
    if (motion_.setpoint.state().velocity != 0) motion_.setpoint.place(motion_.setpoint.state().position);
    if (mode == DriveMode::cyclic_torque) {
        const auto limits = gentlest(full_limits(body_.config.limits), body_.config.limits);
        modes_.torque_velocity = slowest(body_.config.limits);
        modes_.torque.command(0, 0, {modes_.torque_velocity, limits.acceleration, limits.deceleration}, TorqueSense::both);
    } else {
        modes_.former = modes_.own;
        modes_.own = mode;
    }
    modes_.torque_idle = mode == DriveMode::cyclic_torque;
    modes_.go(modes_.torque_idle ? ModePhase::entering : ModePhase::changing);
    modes_.waits = true;
}

/// Before each step: what the drive is told from this cycle on. A wish that is taken back at once is on its way all the same.
void DriveModes::note_asked() noexcept {
    if (modes_.wanted() == modes_.asked_for) return;
    modes_.asked_for = modes_.wanted();
    modes_.asked_at = body_.now;
    modes_.was_another = false;
}

/// The drive has shown the wanted mode for as long as it wants before commands. What it shows may be older than the wish, where it is the mode that it
/// was in before the one before: such a word counts once the wish has reached it.
bool DriveModes::mode_confirmed() noexcept {
    if (!measured_.feedback.fresh) return false;
    const bool shown = measured_.feedback.mode == modes_.wanted();
    modes_.was_another = modes_.was_another || !shown;
    const auto heard = body_.port.setpoint_effective(modes_.asked_at) + body_.round_trip() + taking_a_mode * body_.cycle;
    const bool there = shown && (modes_.was_another || measured_.feedback.latched >= heard);
    if (there && !modes_.seen) modes_.seen_at = body_.now;
    modes_.seen = there;
    return there && body_.now - modes_.seen_at >= body_.port.capabilities().mode_change_delay;
}

ModeStep DriveModes::step(Duration period) noexcept {
    note_asked();
    if (modes_.waits) {
        if (measured_.stands()) modes_.waits = false;
        else modes_.since = body_.now;
    }
    const bool confirmed = !modes_.waits && mode_confirmed();
    const auto& drive = body_.port.capabilities();
    const bool late = body_.now - modes_.since >= mode_patience + drive.mode_change_delay + 2 * body_.round_trip();
    switch (modes_.phase) {
        case ModePhase::steady: return ModeStep::free;
        case ModePhase::entering: return enter_torque(confirmed, late);
        case ModePhase::torque: return run_torque(period);
        case ModePhase::leaving: return leave(confirmed, late);
        case ModePhase::changing: return change_mode(confirmed, late);
        case ModePhase::profile_entering:
        case ModePhase::profile:
        case ModePhase::profile_halting: return profiles_.step(confirmed, late);
    }
    return ModeStep::free;
}

ModeStep DriveModes::leave(bool confirmed, bool late) noexcept {
    if (modes_.torque_wanted() && modes_.run.mode() == DriveMode::none) {  // again
        modes_.go(ModePhase::entering);
        return ModeStep::again;
    }
    if (confirmed) {
        modes_.end_profile();
        go_on_from_motor();
        return ModeStep::free;
    }
    // Who is not heard refuses nothing: what keeps it silent says so itself, and it has its time when it answers again. Nobody leads meanwhile.
    if (!measured_.online()) {
        go_on_from_motor();
        modes_.motor_leads = false;
        modes_.since = body_.now;
        return ModeStep::free;
    }
    lead_.follow();
    if (!modes_.motor_leads && measured_.feedback.mode == modes_.own) {  // it never left; what it is told now begins as ever
        modes_.since = body_.now;
        return ModeStep::free;
    }
    if (modes_.run.mode() != DriveMode::none) (void)guard_.drive_speed(motion_.setpoint.state().velocity);
    // It stops along its own ramp first (SV33-E 3.4.3 (4), (7), (8)).
    if (modes_.motor_leads && modes_.run.may_still_turn(body_.now) && !measured_.stands()) {
        modes_.halt = modes_.halt || (modes_.run.mode() != DriveMode::none && modes_.run.turns_too_long(body_.now));
        modes_.since = body_.now;
        return ModeStep::made;
    }
    if (!late) return ModeStep::made;
    modes_.end_profile();
    if (modes_.motor_leads) motion_.setpoint.place(measured_.local());
    conduct_.fail(AxisAlarm::drive_mode_mismatch, static_cast<double>(measured_.feedback.mode), static_cast<double>(modes_.own));
    return ModeStep::free;
}

ModeStep DriveModes::enter_torque(bool confirmed, bool late) noexcept {
    const bool by_command = body_.queue.active().command.kind == CommandKind::set_controller_mode;
    if (!modes_.torque_wanted() && !by_command) {
        modes_.go(ModePhase::leaving);
        return ModeStep::again;
    }
    if (confirmed) {
        motion_.setpoint.fold();
        modes_.go(ModePhase::torque);
        modes_.torque.start(measured_.torque(), measured_.motor_velocity(), motion_.setpoint.state().acceleration);
        if (by_command) {
            body_.queue.finish_active(Outcome::done);
            return ModeStep::next_again;
        }
        return ModeStep::again;
    }
    if (late) {
        modes_.torque_idle = false;
        body_.queue.finish_active(Outcome::error, ErrorId::drive_mode_refused);
        modes_.go(ModePhase::leaving);
        conduct_.stop_on_own_account(false);
        return ModeStep::again;
    }
    return ModeStep::free;  // meanwhile the axis goes on as it did, in its own mode
}

ModeStep DriveModes::run_torque(Duration period) noexcept {
    const auto& drive = body_.port.capabilities();
    if (!modes_.torque_wanted()) {
        if (!drive.mode_change_at_standstill || measured_.stands()) {
            modes_.run.leave(body_.now, lead_.longest_ramp(body_.config.limits.deceleration));
            modes_.go(ModePhase::leaving);
            modes_.torque_idle = false;
            return ModeStep::again;
        }
        const bool error = body_.state == AxisState::ErrorStop;
        double braking = error ? stop_limits(body_.config.limits).deceleration
                               : dynamics_of(body_.queue.active().command, body_.config.limits, body_.config.defaults).deceleration;
        if (body_.barred(motion_.setpoint.state().velocity)) braking = std::max(braking, body_.config.limits.deceleration);
        modes_.torque.brake(braking);
    } else if (body_.begin_pending) {
        body_.begin_pending = false;
        aim_.start_at_base();
        begin_torque(body_.queue.active().command);
    }
    if (body_.queue.active().command.kind == CommandKind::torque) motion_.goal_pending = false;
    lead_.follow();
    (void)modes_.torque.step(measured_.motor_velocity(), period);
    guard_.motor(stop_limits(body_.config.limits));
    // Over a slow line the drive has it when the word of the cycle before, which was the same, is acknowledged.
    const double sent = body_.config.gearing.inverted ? -output_.command().torque : output_.command().torque;
    const bool arrived = !body_.slow_line || (sent == modes_.torque.torque() && measured_.feedback.commands_acknowledged);
    body_.queue.set_in_target(body_.queue.active().command.kind == CommandKind::torque && modes_.torque.in_torque() &&
                              !measured_.feedback.internal_limit && arrived);
    return ModeStep::made;
}

ModeStep DriveModes::change_mode(bool confirmed, bool late) noexcept {
    if (body_.queue.active().command.kind != CommandKind::set_controller_mode) {  // ended by something else, which begins in the new mode
        modes_.go(ModePhase::leaving);
        return ModeStep::made;
    }
    if (confirmed) {
        modes_.phase = ModePhase::steady;
        body_.queue.finish_active(Outcome::done);
        return ModeStep::next;
    }
    if (!late) return ModeStep::made;
    modes_.own = modes_.former;
    body_.queue.finish_active(Outcome::error, ErrorId::drive_mode_refused);
    modes_.go(ModePhase::leaving);
    conduct_.stop_on_own_account(false);
    return ModeStep::made;
}

/// Nothing follows the motor any more: the set-point goes on from the last one the drive was given.
void DriveModes::go_on_from_motor() noexcept {
    if (!modes_.motor_leads) return;
    if (motion_.goal.kind != Goal::Kind::rest && motion_.goal.kind != Goal::Kind::given) motion_.goal_pending = true;
    else if (!body_.begin_pending && !motion_.goal_pending) stop_or_stand();
}

/// Out of torque with nothing to do: the motor may still turn.
void DriveModes::stop_or_stand() noexcept {
    if (measured_.stands()) motion_.setpoint.place(motion_.setpoint.state().position);
    else conduct_.stop_on_own_account(false);
}

}  // namespace taktwerk::axes
