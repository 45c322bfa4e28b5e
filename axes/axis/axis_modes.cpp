// The cyclic mode the drive runs in. Each axis has one of its own, position or velocity (the position loop is closed here then), and
// stays in it for every motion. Only MC_Home by the drive, MC_TorqueControl, the drive's own profiles and an explicit set_controller_mode change it.
//
//   steady -> entering -> torque -> leaving -> steady      MC_TorqueControl and whatever ends it
//   steady -> changing -> steady                           set_controller_mode, at standstill
//   steady -> profile_entering -> profile -> (profile_halting ->) leaving -> steady   a profile of the drive: axis_drive_profile.cpp
//
// In torque, and while the drive makes the profile, the set-point follows the motor, so that leaving begins where the motor is and as fast as it is.
// A drive that was asked for another mode and has not shown it yet takes set-points as ever: there the set-point follows nothing, and goes on.

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

namespace {

using namespace std::chrono_literals;

constexpr Duration mode_patience = 500ms;  // a drive that has not taken its mode after this and its own delay will not
constexpr double dead_cycles = 5;          // from seeing that a torque must end to the first cycle that brakes

bool cyclic(DriveMode mode) noexcept {
    return mode == DriveMode::cyclic_position || mode == DriveMode::cyclic_velocity || mode == DriveMode::cyclic_torque;
}
bool slow_line(const DriveCapabilities& drive) noexcept { return drive.setpoints == SetpointClass::low_dynamics; }
DriveMode torque_mode(const DriveCapabilities& drive) noexcept {
    return slow_line(drive) ? DriveMode::profile_torque : DriveMode::cyclic_torque;
}
/// From a word to its effect as the feedback shows it, where that is more than a bus' few cycles.
Duration round_trip(const DriveCapabilities& drive) noexcept { return drive.command_latency + drive.feedback_period; }
/// Ends motion: taken in any mode, whatever the drive demands for a change.
bool only_stops(CommandKind kind) noexcept { return kind == CommandKind::stop || kind == CommandKind::halt; }

}  // namespace

DriveMode AxisCore::mode_on_the_way() const noexcept {
    if (drive_homing_.busy()) return drive_homing_.mode();
    if (mode_waits_) return mode_phase_ == ModePhase::changing ? former_mode_ : own_mode_;
    if (in_drive_profile()) return drive_run_.mode();
    return mode_phase_ == ModePhase::entering || mode_phase_ == ModePhase::torque ? torque_mode(port_.capabilities()) : own_mode_;
}

bool AxisCore::torque_wanted() const noexcept {
    if (queue_.active().command.kind == CommandKind::torque) return true;
    return torque_idle_ && !queue_.has_active() && view_.state == AxisState::Standstill;
}

// --- what is accepted ---------------------------------------------------------------------------------------------------------

ErrorId AxisCore::refuse_mode(const AxisCommand& command, bool starts_now) const noexcept {
    const auto& drive = port_.capabilities();
    const bool in_torque = mode_phase_ == ModePhase::entering || mode_phase_ == ModePhase::torque;
    // At the end of a move the motor is a little behind its set-point: then the change waits for it.
    const bool stands = setpoint_.at_rest() && (!in_torque || drive_stands());
    // Out of torque in motion this drive can only be braked first.
    if (starts_now && in_torque && drive.mode_change_at_standstill && !stands && command.kind != CommandKind::torque &&
        !only_stops(command.kind))
        return ErrorId::not_at_standstill;
    if (made_by_drive(command.kind)) return refuse_drive_profile(command, starts_now);
    if (command.kind == CommandKind::torque) {
        if (!drive.has(torque_mode(drive))) return ErrorId::not_supported;
        // Over a slow line the drive keeps the velocity, and brakes out of its torque by itself when it is told to halt.
        const bool by_drive = drive.velocity_limit && (slow_line(drive) || !drive.mode_change_at_standstill);
        const bool bounded = by_drive || (config_.control.inertia() > 0 && !slow_line(drive));
        if (!bounded) return ErrorId::not_supported;  // nobody would keep the velocity in its limit
        if (!starts_now) return ErrorId::none;
        if (drive.mode_change_at_standstill && !in_torque && !stands) return ErrorId::not_at_standstill;
        return permitted(torque_of(command)) ? ErrorId::none : ErrorId::interlocked;
    }
    if (command.kind != CommandKind::set_controller_mode) return ErrorId::none;
    const auto mode = static_cast<DriveMode>(static_cast<std::uint8_t>(command.position));
    if (!cyclic(mode) || !drive.has(mode)) return ErrorId::not_supported;
    if (mode == DriveMode::cyclic_velocity && !(config_.control.kv > 0)) return ErrorId::not_supported;  // no position loop
    return !starts_now || stands ? ErrorId::none : ErrorId::not_at_standstill;
}

double AxisCore::torque_of(const AxisCommand& command) const noexcept {
    const double torque = std::get<TorqueDetails>(command.details).torque;
    switch (command.direction) {
        case mcNegativeDirection: return -torque;
        case mcCurrentDirection: return setpoint_.state().velocity < 0 ? -torque : torque;
        case mcPositiveDirection:
        case mcShortestWay: break;
    }
    return torque;
}

// --- begin --------------------------------------------------------------------------------------------------------------------

void AxisCore::begin_torque(const AxisCommand& command) noexcept {
    abandon_superimposed();  // there will be no set-point to add to
    const auto& details = std::get<TorqueDetails>(command.details);
    const auto dynamics = dynamics_of(command, config_.limits, config_.defaults);
    const double wanted = command.velocity == 0 ? config_.limits.velocity : command.velocity;
    const auto allowed = allowed_speed(wanted, config_.limits.velocity, velocity_cap());
    torque_velocity_ = allowed.speed;
    const double torque = torque_of(command);
    // A negative torque in a given direction brakes motion in it and does not turn it round (P1-184, P1-187).
    auto sense = TorqueSense::both;
    if (details.torque < 0 && command.direction != mcShortestWay)
        sense = torque < 0 ? TorqueSense::only_positive : TorqueSense::only_negative;
    torque_.command(torque, details.ramp, {allowed.speed, dynamics.acceleration, dynamics.deceleration}, sense);
    torque_idle_ = false;
    aim(Goal::Kind::given, 0, full_limits(config_.limits), allowed.limiter);
    if (mode_phase_ == ModePhase::torque || mode_phase_ == ModePhase::entering) return;
    go_mode(ModePhase::entering);
    mode_waits_ = port_.capabilities().mode_change_at_standstill;
}

void AxisCore::begin_mode_change(const AxisCommand& command) noexcept {
    const auto mode = static_cast<DriveMode>(static_cast<std::uint8_t>(command.position));
    goal_ = {};
    goal_pending_ = false;
    if (mode == DriveMode::cyclic_torque) {
        torque_.command(0, 0, {config_.limits.velocity, config_.limits.acceleration, config_.limits.deceleration}, TorqueSense::both);
        torque_velocity_ = config_.limits.velocity;
    } else {
        former_mode_ = own_mode_;
        own_mode_ = mode;
    }
    torque_idle_ = mode == DriveMode::cyclic_torque;
    go_mode(torque_idle_ ? ModePhase::entering : ModePhase::changing);
    mode_waits_ = true;
}

void AxisCore::go_mode(ModePhase phase) noexcept {
    if (mode_phase_ == ModePhase::steady) motor_leads_ = false;
    mode_phase_ = phase;
    mode_since_ = now_;
    mode_seen_ = mode_waits_ = false;
}

// --- each cycle ---------------------------------------------------------------------------------------------------------------

/// The drive has shown the wanted mode for as long as it wants before commands.
bool AxisCore::mode_confirmed() noexcept {
    if (!feedback_.fresh) return false;
    const bool there = feedback_.mode == wanted_mode();
    if (there && !mode_seen_) mode_seen_at_ = now_;
    mode_seen_ = there;
    return there && now_ - mode_seen_at_ >= port_.capabilities().mode_change_delay;
}

/// True: this cycle's set-point is made.
bool AxisCore::step_mode(Duration period) noexcept {
    if (mode_waits_) {
        if (drive_stands()) mode_waits_ = false;
        else mode_since_ = now_;
    }
    const bool confirmed = !mode_waits_ && mode_confirmed();
    const auto& drive = port_.capabilities();
    const bool late = now_ - mode_since_ >= mode_patience + drive.mode_change_delay + 2 * round_trip(drive);
    switch (mode_phase_) {
        case ModePhase::steady: return false;
        case ModePhase::entering: return enter_torque(confirmed, late, period);
        case ModePhase::torque: return run_torque(period);
        case ModePhase::leaving: return leave_mode(confirmed, late, period);
        case ModePhase::changing: return change_mode(confirmed, late);
        case ModePhase::profile_entering:
        case ModePhase::profile:
        case ModePhase::profile_halting: return step_drive_profile(confirmed, late, period);
    }
    return false;
}

bool AxisCore::leave_mode(bool confirmed, bool late, Duration period) noexcept {
    if (torque_wanted() && drive_run_.mode() == DriveMode::none) {  // again
        go_mode(ModePhase::entering);
        return step_mode(period);
    }
    if (confirmed) {  // the set-point goes on from the last one the drive was given
        end_drive_profile();
        if (!motor_leads_) return false;
        if (goal_.kind != Goal::Kind::rest && goal_.kind != Goal::Kind::given) goal_pending_ = true;
        else if (!begin_pending_ && !goal_pending_) stop_or_stand();
        return false;
    }
    follow_motor();
    if (!motor_leads_ && feedback_.mode == own_mode_) {  // it never left; what it is told now begins as ever
        mode_since_ = now_;
        return false;
    }
    if (drive_run_.mode() != DriveMode::none) guard_drive_speed(setpoint_.state().velocity);
    // It stops along its own ramp first (SV33-E 3.4.3 (4), (7), (8)).
    if (motor_leads_ && drive_run_.may_still_turn(now_) && !drive_stands()) {
        drive_halt_ = drive_halt_ || (drive_run_.mode() != DriveMode::none && drive_run_.turns_too_long(now_));
        mode_since_ = now_;
        return true;
    }
    if (!late) return true;
    end_drive_profile();
    if (motor_leads_) setpoint_.place(actual_local());
    fail(AxisAlarm::drive_mode_mismatch, static_cast<double>(feedback_.mode), static_cast<double>(own_mode_));
    return false;
}

bool AxisCore::enter_torque(bool confirmed, bool late, Duration period) noexcept {
    const bool by_command = queue_.active().command.kind == CommandKind::set_controller_mode;
    if (!torque_wanted() && !by_command) {
        go_mode(ModePhase::leaving);
        return step_mode(period);
    }
    if (confirmed) {
        setpoint_.fold();
        go_mode(ModePhase::torque);
        torque_.start(view_.actual_torque, motor_velocity(), setpoint_.state().acceleration);
        if (by_command) {
            queue_.finish_active(Outcome::done);
            start_waiting(0);
        }
        return step_mode(period);
    }
    if (late) {
        torque_idle_ = false;
        queue_.finish_active(Outcome::error, ErrorId::drive_mode_refused);
        go_mode(ModePhase::leaving);
        stop_on_own_account(false);
        return step_mode(period);
    }
    return false;  // meanwhile the axis goes on as it did, in its own mode
}

bool AxisCore::run_torque(Duration period) noexcept {
    const auto& drive = port_.capabilities();
    if (!torque_wanted()) {
        if (!drive.mode_change_at_standstill || drive_stands()) {
            drive_run_.leave(now_, longest_ramp(config_.limits.deceleration));
            go_mode(ModePhase::leaving);
            torque_idle_ = false;
            return step_mode(period);
        }
        const bool error = view_.state == AxisState::ErrorStop;
        double braking = error ? stop_limits(config_.limits).deceleration
                               : dynamics_of(queue_.active().command, config_.limits, config_.defaults).deceleration;
        if (barred(setpoint_.state().velocity)) braking = std::max(braking, config_.limits.deceleration);
        torque_.brake(braking);
    } else if (begin_pending_) {
        begin_command();
    }
    if (queue_.active().command.kind == CommandKind::torque) goal_pending_ = false;
    follow_motor();
    (void)torque_.step(motor_velocity(), period);
    guard_torque();
    // Over a slow line the drive has it when the word of the cycle before, which was the same, is acknowledged.
    const double sent = config_.gearing.inverted ? -command_.torque : command_.torque;
    const bool arrived = !slow_line(drive) || (sent == torque_.torque() && feedback_.commands_acknowledged);
    queue_.set_in_target(queue_.active().command.kind == CommandKind::torque && torque_.in_torque() && !feedback_.internal_limit &&
                         arrived);
    return true;
}

/// As the guards of planned motion, but early by what leaving the mode takes.
void AxisCore::guard_motor(const MotionLimits& braking) noexcept {
    if (view_.state == AxisState::ErrorStop || guard_limit_switches()) return;
    const bool stops = view_.state == AxisState::Stopping || halts_alone();
    if ((!stops && guard_permits()) || !software_limits_hold()) return;
    auto reach = setpoint_.state();
    if (reach.velocity == 0) return;
    const auto& drive = port_.capabilities();
    const double delay = dead_cycles * to_seconds(cycle_) + to_seconds(drive.mode_change_delay + round_trip(drive));
    // Until then it may get faster, up to the velocity commanded: by its torque, or along the ramp of the drive.
    const double sense = reach.velocity > 0 ? 1 : -1, speed = std::abs(reach.velocity);
    double push = 0, most = speed;
    if (mode_phase_ == ModePhase::torque) {
        push = sense * torque_.torque() * config_.control.rated_acceleration;
        most = torque_velocity_;
    } else if (mode_phase_ == ModePhase::profile && drive_run_.mode() == DriveMode::profile_velocity) {
        push = drive_run_.setpoint().acceleration / std::abs(units_.counts_per_unit());
        most = sense * drive_run_.setpoint().velocity / units_.counts_per_unit();
    }
    const double gain = std::clamp(push * delay, 0.0, std::max(most - speed, 0.0));
    reach.position += (reach.velocity + sense * gain / 2) * delay;
    reach.velocity += sense * gain;
    const double end = units_.to_program(reach.position + stopping_distance(reach, braking));
    const double edge = reach.velocity > 0 ? config_.limits.position_max : config_.limits.position_min;
    if (reach.velocity > 0 ? end > edge : end < edge)
        fail(AxisAlarm::software_limit_reached, units_.to_program(setpoint_.state().position), edge);
}

bool AxisCore::change_mode(bool confirmed, bool late) noexcept {
    if (queue_.active().command.kind != CommandKind::set_controller_mode) {  // ended by something else, which begins in the new mode
        go_mode(ModePhase::leaving);
        return true;
    }
    if (confirmed) {
        mode_phase_ = ModePhase::steady;
        queue_.finish_active(Outcome::done);
        start_waiting(0);
        return false;
    }
    if (!late) return true;
    own_mode_ = former_mode_;
    queue_.finish_active(Outcome::error, ErrorId::drive_mode_refused);
    go_mode(ModePhase::leaving);
    stop_on_own_account(false);
    return true;
}

/// Out of torque with nothing to do: the motor may still turn.
void AxisCore::stop_or_stand() noexcept {
    if (drive_stands()) setpoint_.place(setpoint_.state().position);
    else stop_on_own_account(false);
}

double AxisCore::motor_velocity() const noexcept { return drive_stands() ? 0 : feedback_.velocity / units_.counts_per_unit(); }

/// Where the motor will be when this cycle's set-point takes effect, once the drive has been seen in a mode that takes none.
void AxisCore::follow_motor() noexcept {
    const bool takes_setpoints = feedback_.mode == own_mode_ || feedback_.mode == former_mode_;
    const bool confirmed = mode_phase_ == ModePhase::torque || mode_phase_ == ModePhase::profile;
    motor_leads_ = motor_leads_ || confirmed || (feedback_.fresh && !takes_setpoints);
    if (!motor_leads_) return;
    // A drive that shows its own mode again may take what it is told before it has to. What is measured then is the echo of this set-point a
    // few cycles ago, whose rounding would grow with every turn: it is led on as fast as it was.
    const bool echoes = mode_phase_ == ModePhase::leaving && mode_seen_ && !drive_stands();
    const double velocity = echoes ? setpoint_.state().velocity : motor_velocity();
    const double ahead = velocity * to_seconds(port_.setpoint_effective(now_) - feedback_.latched);
    setpoint_.set({actual_local() + ahead, velocity, 0});
}

// --- to the drive -------------------------------------------------------------------------------------------------------------

void AxisCore::fill_targets() noexcept {
    const auto& set = setpoint_.state();
    const auto& control = config_.control;
    const double counts = units_.counts_per_unit();
    command_.mode = wanted_mode();
    command_.position = seeded_ ? units_.counts(set.position + compensation_.offset()) : feedback_.position;
    command_.velocity = control.feed_forward * set.velocity * counts;
    command_.torque = torque_per_acceleration_ * set.acceleration;
    if (slow_line(port_.capabilities())) {
        // Told to stop, the drive ramps by itself: one word on the line ends the motion, whatever becomes of the line then.
        const bool ends_torque = mode_phase_ == ModePhase::leaving || (mode_phase_ == ModePhase::torque && !torque_wanted());
        command_.halt = goal_.kind == Goal::Kind::stop || ends_torque;
        const double deceleration = command_.halt ? goal_.limits.deceleration : config_.limits.deceleration;
        command_.acceleration = config_.limits.acceleration * std::abs(counts);
        command_.deceleration = deceleration * std::abs(counts);
    }
    if (own_mode_ == DriveMode::cyclic_velocity || own_mode_ == DriveMode::profile_velocity) {
        const bool closed = mode_phase_ == ModePhase::steady && online() && !power_.follows_actual();
        const double limit = control.output_limit > 0 ? control.output_limit : 1.2 * view_.parameters[place_of(velocity_of_system)];
        const double velocity = mode_phase_ == ModePhase::leaving
                                    ? set.velocity
                                    : control.feed_forward * set.velocity + (closed ? control.kv * view_.following_error : 0);
        command_.velocity = std::clamp(velocity, -limit, limit) * counts;
    }
    if (mode_phase_ == ModePhase::steady) return;
    if (in_drive_profile()) fill_drive_profile();
    else fill_torque();
    command_.halt = command_.halt || drive_halt_;
}

void AxisCore::fill_torque() noexcept {
    if (mode_phase_ == ModePhase::entering) command_.torque = feedback_.torque;  // what the motor has when it takes the mode
    if (mode_phase_ != ModePhase::torque) return;
    const double counts = units_.counts_per_unit();
    command_.torque = (config_.gearing.inverted ? -1 : 1) * torque_.torque();
    command_.velocity_limit = torque_velocity_ * std::abs(counts);
}

}  // namespace taktwerk::axes
