// Which mode is active, which targets it takes, and who makes the torque in it. The modes themselves: cia402_cyclic.cpp,
// cia402_homing.cpp.

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

void Cia402Axis::select_mode(const AxisInputs& in) noexcept {
    if (in.mode == mode_) return;
    const bool known = in.mode == mode::profile_velocity || in.mode == mode::profile_torque || in.mode == mode::homing ||
                       in.mode == mode::cyclic_position || in.mode == mode::cyclic_velocity || in.mode == mode::cyclic_torque;
    if (!known) return;
    if (mode_ == mode::homing && homing_.busy()) return;  // no other while homing runs (SV33-E 3.4.3)
    if (mode::of_torque(mode_)) loop_.take_over(torque_);
    mode_ = in.mode;
    end_warning();
    homing_.cancel();
    homing_attained_ = homing_error_ = false;
    // A switch never moves: the new mode starts where the axis is.
    demand_ = {plant_.position(), 0, 0};
    forget_targets();
}

void Cia402Axis::forget_targets() noexcept {
    target_ = plant_.position();
    steps_left_ = 0;
    velocity_demand_ = torque_demand_ = torque_offset_ = 0;
}

void Cia402Axis::take_targets(const AxisInputs& in, Duration cycle) noexcept {
    take_torque_offset(in);
    switch (mode_) {
        case mode::cyclic_position: take_position_target(in, to_seconds(cycle)); break;
        case mode::profile_velocity:
        case mode::cyclic_velocity: take_velocity_target(in); break;
        case mode::profile_torque:
        case mode::cyclic_torque: take_torque_target(in); break;
        case mode::homing: take_homing_start(in); break;
        default: break;
    }
}

double Cia402Axis::enabled_torque(double dt) noexcept {
    if (mode::of_torque(mode_)) return ServoLoop::torque_control(plant_, torque_demand_, fastest_, torque_limit());
    if (mode::of_velocity(mode_)) return with_offset(loop_.velocity_control(plant_, velocity_demand_, 0, torque_limit(), dt));
    if (mode_ == mode::homing && homing_.state() != HomingRun::State::idle) homing_step(dt);
    else interpolate(dt);
    return with_offset(loop_.position_control(plant_, demand_, quantised() + zero_, torque_limit(), dt));
}

}  // namespace taktwerk::axes::sim
