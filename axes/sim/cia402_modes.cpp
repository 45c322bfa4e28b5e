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
        case ModeViolation::alarm: raise_if_known(DriveAlarmKind::mode_change); break;
    }
    return false;
}

/// SV33-E 3.4.3 (3), (4), (7), (8): "a ramp stop is carried out, then the other mode may be entered". By which ramp is not stated: 6084h.
bool Cia402Axis::stops_before_mode_change() noexcept {
    const bool position = !mode::of_velocity(mode_) && !mode::of_torque(mode_);
    if (!has(Quirk::ramp_before_mode_change) || state_ != State::enabled || position || stands()) {
        stop_.ramp_out(false);
        return false;
    }
    if (!stop_.holds_up()) {
        const double ramp = stop_ramp(*profile_, StopBy::ramp, mode_, settings_);
        begin_stop({StopBy::ramp, StopThen::lock, ramp, ramp <= 0});
    }
    stop_.ramp_out(true);
    return true;
}

bool Cia402Axis::has_mode(DriveMode mode) const noexcept {
    const auto& modes = profile_->modes;  // none: it has them all
    return modes.empty() || std::find(modes.begin(), modes.end(), mode) != modes.end();
}

/// 0 and what the drive does not have leave the mode as it is (TSVM 5.4.1 rule 7).
void Cia402Axis::select_mode(const AxisInputs& in) noexcept {
    if (in.mode == mode_) {
        if (stop_.ramps_out()) velocity_.demand(plant().velocity());  // it stays after all
        stop_.ramp_out(false);
        return;
    }
    const auto wanted = mode::meaning(in.mode);
    if (wanted == DriveMode::none || !has_mode(wanted)) return;
    if (mode_ == mode::homing && homing_.busy()) return;  // no other while homing runs (SV33-E 3.4.3)
    if (!may_change_mode() || stops_before_mode_change()) return;
    if (mode::of_torque(mode_)) motor_.keep_torque();
    mode_ = in.mode;
    mode_changed_at_ = now_;
    alarms_.end_warning();
    homing_.forget();
    stop_.halt(false);
    // A switch never moves: the new mode starts where the axis is.
    motor_.demand_rest();
    forget_targets();
}

void Cia402Axis::forget_targets() noexcept {
    cyclic_.rest(motor_.position());
    velocity_.forget(ramps_velocity() && !stands() ? motor_.velocity() : 0);  // a ramp begins at the speed there is
    torque_.forget();
    profile_position_.reset(motor_.position());
    travel_.limited(false);
    window_.forget();
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
    if (mode_ == mode::profile_torque) torque_.ramp(motor_, settings_.torque_slope, dt);
    if (mode::of_torque(mode_)) return torque_.torque(motor_);
    if (mode::of_velocity(mode_)) {
        const double before = velocity_.demanded();
        if (ramps_velocity()) ramp_velocity(dt);
        const double wanted = velocity_.demanded();
        const double acceleration = ramps_velocity() ? (wanted - before) / dt : 0;  // a jump of the master's is none
        return torque_.with_offset(motor_, motor_.velocity_torque(wanted, acceleration, motor_.torque_limit(), dt));
    }
    if (mode_ == mode::homing && !homing_.idle()) homing_step(dt);
    else if (mode_ == mode::profile_position) motor_.demand(profile_position_.step(dt));
    else interpolate(dt);
    return torque_.with_offset(motor_, motor_.position_torque(origin_.zero(), dt));
}

}  // namespace taktwerk::axes::sim
