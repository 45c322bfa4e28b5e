// Which mode is active, which targets it takes, and who makes the torque in it. The modes themselves: cia402_cyclic.cpp,
// cia402_profile.cpp, cia402_homing.cpp.

#include <algorithm>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

/// False: the drive does not take this change now. TSVM 5.4.1: at standstill, and so long after the last one.
bool Cia402Axis::may_change_mode() noexcept {
    const bool too_soon = mode_changed_at_ && now_ - *mode_changed_at_ < profile_->mode_rules.change_interval;
    const bool moves = profile_->mode_rules.change_at_standstill && state_ == State::enabled && !stands();
    if (!too_soon && !moves) return true;
    switch (profile_->mode_rules.violation) {
        case ModeViolation::obeyed: return true;
        case ModeViolation::ignored: break;
        case ModeViolation::alarm:
            if (codes_[DriveAlarmKind::mode_change].code) raise(codes_[DriveAlarmKind::mode_change]);
            break;
    }
    return false;
}

/// SV33-E 3.4.3 (3), (4), (7), (8): "a ramp stop is carried out, then the other mode may be entered". By which ramp is not stated: 6084h.
bool Cia402Axis::stops_before_mode_change() noexcept {
    const bool position = !mode::of_velocity(mode_) && !mode::of_torque(mode_);
    if (!has(Quirk::ramp_before_mode_change) || state_ != State::enabled || position || stands()) {
        ramps_out_ = false;
        return false;
    }
    if (!ramps_out_ && !halted_) {
        const double ramp = ramp_of(StopBy::ramp);
        begin_stop({StopBy::ramp, StopThen::lock, ramp, ramp <= 0});
    }
    ramps_out_ = true;
    return true;
}

bool Cia402Axis::has_mode(DriveMode mode) const noexcept {
    const auto& modes = profile_->modes;  // none: it has them all
    return modes.empty() || std::find(modes.begin(), modes.end(), mode) != modes.end();
}

/// 0 and what the drive does not have leave the mode as it is (TSVM 5.4.1 rule 7).
void Cia402Axis::select_mode(const AxisInputs& in) noexcept {
    if (in.mode == mode_) {
        if (ramps_out_) velocity_demand_ = plant_.velocity();  // it stays after all
        ramps_out_ = false;
        return;
    }
    const auto wanted = mode::meaning(in.mode);
    if (wanted == DriveMode::none || !has_mode(wanted)) return;
    if (mode_ == mode::homing && homing_.busy()) return;  // no other while homing runs (SV33-E 3.4.3)
    if (!may_change_mode() || stops_before_mode_change()) return;
    if (mode::of_torque(mode_)) loop_.take_over(torque_);
    mode_ = in.mode;
    mode_changed_at_ = now_;
    end_warning();
    homing_.cancel();
    homing_attained_ = homing_error_ = false;
    halted_ = false;
    // A switch never moves: the new mode starts where the axis is.
    demand_ = {seen_position(), 0, 0};
    forget_targets();
}

void Cia402Axis::forget_targets() noexcept {
    target_ = seen_position();
    steps_left_ = 0;
    velocity_demand_ = ramps_velocity() && !stands() ? seen_velocity() : 0;  // a ramp begins at the speed there is
    velocity_target_ = torque_target_ = torque_demand_ = torque_offset_ = 0;
    profile_position_.reset(seen_position());
    limited_ = target_reached_ = false;
}

void Cia402Axis::take_targets(const AxisInputs& in, Duration cycle) noexcept {
    take_torque_offset(in);
    switch (mode_) {
        case mode::cyclic_position: take_position_target(in, to_seconds(cycle)); break;
        case mode::profile_position: take_profile_position(in); break;
        case mode::profile_velocity: take_profile_velocity(in); break;
        case mode::cyclic_velocity: take_velocity_target(in); break;
        case mode::profile_torque: take_profile_torque(in); break;
        case mode::cyclic_torque: take_torque_target(in); break;
        case mode::homing: take_homing_start(in); break;
        default: break;
    }
}

double Cia402Axis::enabled_torque(double dt) noexcept {
    if (mode_ == mode::profile_torque) ramp_torque(dt);
    if (mode::of_torque(mode_)) return ServoLoop::torque_control(plant_, torque_demand_, fastest_, torque_limit());
    if (mode::of_velocity(mode_)) {
        const double before = velocity_demand_;
        if (ramps_velocity()) ramp_velocity(dt);
        const double acceleration = ramps_velocity() ? (velocity_demand_ - before) / dt : 0;  // a jump of the master's is none
        return with_offset(velocity_torque(velocity_demand_, acceleration, torque_limit(), dt));
    }
    if (mode_ == mode::homing && homing_.state() != HomingRun::State::idle) homing_step(dt);
    else if (mode_ == mode::profile_position) demand_ = profile_position_.step(dt);
    else interpolate(dt);
    return with_offset(position_torque(dt));
}

double Cia402Axis::position_torque(double dt) noexcept {
    if (stepper_) return stepper_->torque(plant_, demand_, torque_limit(), dt);
    return loop_.position_control(plant_, demand_, quantised() + zero_, torque_limit(), dt);
}

/// Of a motor without an encoder the field turns with that velocity, whatever the rotor does.
double Cia402Axis::velocity_torque(double velocity, double acceleration, double limit, double dt) noexcept {
    if (!stepper_) return loop_.velocity_control(plant_, velocity, acceleration, limit, dt);
    demand_.velocity = velocity;
    demand_.position += velocity * dt;
    return stepper_->torque(plant_, demand_, limit, dt);
}

}  // namespace taktwerk::axes::sim
