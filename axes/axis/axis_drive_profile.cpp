// Profiles that the drive makes, in its own modes: PP, PV, PT. The axis stands before the drive is asked for the mode, hands it one set-point
// (and in PP as many ahead as the drive takes), follows the motor, and looks after limits by what the drive reports. Whatever takes the axis
// ends it: bumpless back into the axis' own mode where the drive changes it in motion, else by a halt (6040h bit 8) in the drive's mode first.
//
//   steady          the axis stops along its own ramp
//   entering        the drive is asked for its mode and has no set-point
//   profile         the set-points are the drive's
//   halting         bit 8, until the motor stands
//   leaving         as out of torque (axis_modes.cpp)

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

namespace {

using namespace std::chrono_literals;

constexpr double too_fast = 1.2;     // times the velocity limit: more than a loop overshoots
constexpr double at_once = 1e6;      // rated torques/s: beyond the range of every 6087h (SV33-E 7.3: 2^32 - 1 means no ramp)
constexpr double braking_grace = 2;  // times the ramp that the drive was given
constexpr Duration longest_braking = 60s;

}  // namespace

// --- what is accepted ---------------------------------------------------------------------------------------------------------

bool AxisCore::drive_makes(CommandKind kind) const noexcept {
    const auto& drive = port_.capabilities();
    if (drive.setpoints == SetpointClass::low_dynamics || !drive.has(profile_mode_of(kind))) return false;
    if (kind == CommandKind::drive_torque) return drive.velocity_limit;  // else nobody keeps the velocity in its limit
    return profile_mode_of(kind) != DriveMode::profile_position || drive.profile_buffer > 0;
}

ErrorId AxisCore::refuse_drive_profile(const AxisCommand& command, bool starts_now) const noexcept {
    if (!starts_now) return ErrorId::none;
    const bool goes_on = mode_phase_ == ModePhase::profile && drive_run_.mode() == profile_mode_of(command.kind);
    const bool stands = setpoint_.at_rest() && (!in_drive_profile() || drive_stands());
    if (port_.capabilities().mode_change_at_standstill && !stands && !goes_on) return ErrorId::not_at_standstill;
    if (command.kind != CommandKind::drive_torque) return ErrorId::none;
    return permitted(torque_of(command)) ? ErrorId::none : ErrorId::interlocked;
}

ErrorId AxisCore::refuse_drive_way(const DriveProfileRun::Way& way) const noexcept {
    if (config_.modulo == 0) {
        if (const auto error = refuse_place(units_.to_program(way.target)); error != ErrorId::none) return error;
    }
    return permitted(way.target - way.from) ? ErrorId::none : ErrorId::interlocked;
}

// --- into the mode --------------------------------------------------------------------------------------------------------------

/// From a motion of its own the axis stops first. With the drive's profile running, the next cycle hands the set-point over.
void AxisCore::begin_drive_profile(const AxisCommand& command) noexcept {
    abandon_superimposed();
    start_at_base();
    has_commanded_target_ = false;
    aim_at_stop(command);
}

void AxisCore::ask_for_drive_mode() noexcept {
    if (!drive_stands() || !setpoint_.at_rest()) return;  // the motor comes a little later than its set-point
    setpoint_.fold();
    drive_run_.enter(profile_mode_of(queue_.active().command.kind));
    go_mode(ModePhase::profile_entering);
}

/// The command in control is one for the mode the drive is in.
bool AxisCore::drive_profile_goes_on() const noexcept {
    const auto kind = queue_.active().command.kind;
    if (!made_by_drive(kind) || profile_mode_of(kind) != drive_run_.mode()) return false;
    const bool instead = begin_pending_ && drive_run_.under_way() && drive_run_.mode() == DriveMode::profile_position;
    return !instead || port_.capabilities().profile_replaces;
}

bool AxisCore::step_drive_profile(bool confirmed, bool late, Duration period) noexcept {
    if (mode_phase_ == ModePhase::profile_halting) return halt_drive_profile(period);
    if (!drive_profile_goes_on()) return leave_drive_profile(period);
    return mode_phase_ == ModePhase::profile ? run_drive_profile(period) : enter_drive_profile(confirmed, late, period);
}

bool AxisCore::enter_drive_profile(bool confirmed, bool late, Duration period) noexcept {
    follow_motor();
    if (late) {
        queue_.finish_active(Outcome::error, ErrorId::drive_mode_refused);
        stop_on_own_account(false);
        return leave_drive_profile(period);
    }
    if (!confirmed) return true;
    go_mode(ModePhase::profile);
    begin_pending_ = true;
    return run_drive_profile(period);
}

// --- in it ------------------------------------------------------------------------------------------------------------------------

bool AxisCore::run_drive_profile(Duration period) noexcept {
    follow_motor();
    if (endless_ && drive_run_.mode() != DriveMode::profile_position && units_.far_from_anchor(setpoint_.state().position)) reanchor();
    if (const double velocity = setpoint_.state().velocity; velocity != 0) backwards_ = velocity < 0;
    if (begin_pending_) {
        begin_pending_ = false;
        if (const auto error = hand_to_drive(queue_.active().command); error != ErrorId::none) {
            queue_.finish_active(Outcome::error, error);
            stop_on_own_account(false);
        }
    } else {
        drive_run_.watch(feedback_, drive_stands(), now_);
        judge_drive_profile();
    }
    if (drive_profile_goes_on()) guard_drive_profile();
    if (!drive_profile_goes_on()) return leave_drive_profile(period);
    hand_ahead();
    return true;
}

/// Local target of a move that begins at `from`.
double AxisCore::drive_target(const AxisCommand& command, const MotionState& from) const noexcept {
    if (command.kind == CommandKind::drive_move_relative) return from.position + command.position;
    return repetition_of(command, from, from.velocity != 0 ? from.velocity < 0 : backwards_);
}

/// What the command means in the drive's counts; `way.target` has been found.
DriveProfileRun::Setpoint AxisCore::drive_setpoint(const AxisCommand& command, DriveProfileRun::Way& way) const noexcept {
    const double counts = units_.counts_per_unit();
    const auto dynamics = dynamics_of(command, config_.limits, config_.defaults);
    DriveProfileRun::Setpoint made;
    made.acceleration = dynamics.acceleration * std::abs(counts);
    made.deceleration = dynamics.deceleration * std::abs(counts);
    const double wanted = command.kind == CommandKind::drive_torque && command.velocity == 0 ? config_.limits.velocity : command.velocity;
    const auto allowed = allowed_speed(std::abs(wanted), config_.limits.velocity, velocity_cap());
    way.limiter = allowed.limiter;
    switch (drive_run_.mode()) {
        case DriveMode::profile_velocity:
            made.velocity = std::copysign(allowed.speed, signed_velocity(command, backwards_)) * counts;
            break;
        case DriveMode::profile_torque: {
            const double ramp = std::get<TorqueDetails>(command.details).ramp;
            made.torque = (config_.gearing.inverted ? -1 : 1) * torque_of(command);
            made.torque_slope = ramp > 0 ? ramp : at_once;
            made.velocity_limit = allowed.speed * std::abs(counts);
            break;
        }
        default:
            made.velocity = allowed.speed * std::abs(counts);
            made.position = units_.counts(way.target + compensation_.offset());
            break;
    }
    return made;
}

ErrorId AxisCore::hand_to_drive(const AxisCommand& command) noexcept {
    goal_ = {.kind = Goal::Kind::given, .value = 0, .limits = full_limits(config_.limits), .limiter = VelocityLimiter::none};
    goal_pending_ = false;
    const bool position = drive_run_.mode() == DriveMode::profile_position;
    const bool instead = drive_run_.under_way();
    DriveProfileRun::Way way{.from = actual_local()};
    if (position) {
        way.target = drive_target(command, {way.from, setpoint_.state().velocity, 0});
        if (const auto error = refuse_drive_way(way); error != ErrorId::none) return error;
    }
    auto made = drive_setpoint(command, way);
    made.immediately = position && instead;
    // From standstill every drive means the same by a distance; and where an endless axis' absolute target lies in a range that wraps it does not.
    made.relative = position && !instead && (endless_ || command.kind == CommandKind::drive_move_relative);
    if (made.relative) made.position = std::llround((way.target - way.from) * units_.counts_per_unit());
    goal_.limiter = way.limiter;
    drive_run_.hand(made, way, now_);
    queue_.set_in_target(false);
    return ErrorId::none;
}

/// PP with a buffer: what waits behind is in the drive before the move in front is over.
void AxisCore::hand_ahead() noexcept {
    const auto behind = drive_run_.ahead();
    if (queue_.waiting() <= behind || drive_run_.mode() != DriveMode::profile_position) return;
    if (!drive_run_.accepted() || drive_run_.barred() || behind >= port_.capabilities().profile_buffer) return;
    const auto& next = queue_.waiting_at(behind).command;
    if (profile_mode_of(next.kind) != DriveMode::profile_position || next.buffer_mode != mcBuffered) return;
    DriveProfileRun::Way way{.from = drive_run_.last().target};
    way.target = drive_target(next, {way.from, 0, 0});
    if (refuse_drive_way(way) != ErrorId::none) return;  // it hears of it when its turn comes
    const auto made = drive_setpoint(next, way);
    drive_run_.hand_ahead(made, way, now_);
}

/// What became of the set-points.
void AxisCore::judge_drive_profile() noexcept {
    if (drive_run_.refused(now_)) {
        if (drive_run_.ahead() > 0) {
            drive_run_.drop_ahead();
            return;
        }
        queue_.finish_active(Outcome::error, ErrorId::drive_setpoint_refused);
        stop_on_own_account(false);
        return;
    }
    if (drive_run_.mode() == DriveMode::profile_position) judge_drive_move();
    else queue_.set_in_target(drive_run_.in_target());
}

/// Only the last target shows in the drive's "target reached": those before it are over where the motor has come to them.
void AxisCore::judge_drive_move() noexcept {
    const auto& way = drive_run_.front();
    const double missing = way.target - actual_local();
    const bool near = std::abs(missing) <= config_.windows.in_position;
    const bool passed = near || missing * (way.target - way.from) < 0;
    if (!(drive_run_.arrived(near, now_) || (drive_run_.ahead() > 0 && passed))) return;
    queue_.finish_active(Outcome::done);
    drive_run_.advance();
    if (drive_run_.under_way()) {
        queue_.activate(queue_.pop());
        goal_.limiter = drive_run_.front().limiter;
        return;
    }
    start_waiting(0);
}

bool AxisCore::guard_drive_speed(double velocity) noexcept {
    if (!(std::abs(velocity) > too_fast * config_.limits.velocity)) return false;
    fail(AxisAlarm::drive_too_fast, std::abs(velocity), config_.limits.velocity);
    return true;
}

/// By what the drive reports: its way is not ours to plan.
void AxisCore::guard_drive_profile() noexcept {
    const auto& at = setpoint_.state();
    if (guard_drive_speed(at.velocity)) return;
    auto braking = stop_limits(config_.limits);
    braking.deceleration = std::min(braking.deceleration, drive_run_.setpoint().deceleration / std::abs(units_.counts_per_unit()));
    if (drive_run_.mode() != DriveMode::profile_position) {
        guard_motor(braking);
        return;
    }
    if (guard_switches() || !software_limits_hold() || at.velocity == 0) return;
    const double place = units_.to_program(actual_local());
    const double edge = at.velocity > 0 ? config_.limits.position_max : config_.limits.position_min;
    const double beyond = at.velocity > 0 ? place - edge : edge - place;
    if (beyond > config_.windows.in_position) fail(AxisAlarm::software_limit_reached, place, edge);
}

// --- out of it --------------------------------------------------------------------------------------------------------------------

/// The motor stands by then, if the drive stops along a ramp of its own. `deceleration` u/s2; 0: unknown.
Duration AxisCore::longest_ramp(double deceleration) const noexcept {
    const double seconds = deceleration > 0 ? braking_grace * std::abs(motor_velocity()) / deceleration : 0;
    return std::min<Duration>(from_seconds(std::min(seconds, to_seconds(longest_braking))) + 500ms, longest_braking);
}

bool AxisCore::leave_drive_profile(Duration period) noexcept {
    const bool halts = port_.capabilities().mode_change_at_standstill && !drive_stands();
    drive_run_.leave(now_, longest_ramp(drive_run_.setpoint().deceleration / std::abs(units_.counts_per_unit())));
    drive_halt_ = halts;
    go_mode(halts ? ModePhase::profile_halting : ModePhase::leaving);
    return step_mode(period);
}

bool AxisCore::halt_drive_profile(Duration period) noexcept {
    follow_motor();
    if (drive_stands() || !drive_run_.may_still_turn(now_)) {
        go_mode(ModePhase::leaving);
        return step_mode(period);
    }
    if (guard_drive_speed(setpoint_.state().velocity)) return true;
    if (drive_run_.mode() != DriveMode::profile_position) guard_motor(stop_limits(config_.limits));
    else if (view_.state == AxisState::Stopping) (void)guard_limit_switches();
    else if (view_.state != AxisState::ErrorStop) (void)guard_switches();
    return true;
}

// --- to the drive -------------------------------------------------------------------------------------------------------------------

void AxisCore::fill_drive_profile() noexcept {
    command_.velocity = command_.torque = 0;
    if (mode_phase_ == ModePhase::profile_entering) return;
    const auto& made = drive_run_.setpoint();
    command_.profile = drive_run_.announced();
    if (drive_run_.mode() == DriveMode::profile_position) command_.position = made.position;
    command_.velocity = made.velocity;
    command_.torque = made.torque;
    command_.acceleration = made.acceleration;
    command_.deceleration = made.deceleration;
    command_.torque_slope = made.torque_slope;
    command_.velocity_limit = made.velocity_limit;
    if (!drive_halt_) return;
    command_.torque = 0;  // what the halt does is the drive's affair; at least nothing drives on
    const auto& stopping = queue_.active().command;
    const bool error = view_.state == AxisState::ErrorStop;
    const auto braking = error ? stop_limits(config_.limits) : dynamics_of(stopping, config_.limits, config_.defaults);
    command_.deceleration = braking.deceleration * std::abs(units_.counts_per_unit());
}

}  // namespace taktwerk::axes
