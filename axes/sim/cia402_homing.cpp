// What a homing of the drive's own does to the axis: its demand, its zero, its alarms. The run itself: drive_homing.hpp.

#include <cmath>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

HomingView Cia402Axis::homing_view() const noexcept {
    return {terminals_.switches(), motor_.position(), std::abs(motor_.torque()) / motor_.torque_limit(), stands(), motor_.index_pulses()};
}

void Cia402Axis::take_homing_start(const AxisInputs& in) noexcept {
    if (!homing_.asked(in) || gate_.loses(true, now_)) return;
    alarms_.end_warning();
    homing_.start(in, *profile_, homing_view());
}

void Cia402Axis::homing_step(double dt) noexcept {
    const bool pressed = homing_.presses();
    const double zero = origin_.zero();
    const auto news = homing_.step(dt, homing_view());
    auto demand = motor_.demand();
    demand.velocity = homing_.velocity();
    demand.position = pressed ? std::floor(actual()) + zero : demand.position + demand.velocity * dt;
    motor_.demand(demand);
    if (pressed && !homing_.presses()) motor_.forget_integral();  // the torque that pressed is of no use on the way back
    if (news == DriveHoming::News::failed) homing_failed();
    // The actual position jumps, the motor does not; the encoder's counts stay where they are.
    if (news == DriveHoming::News::attained) origin_.reference(homing_.shift(zero), plant().position(), motor_.position());
}

void Cia402Axis::homing_failed() noexcept {
    switch (homing_.failure()) {
        case HomingRun::Failure::method: raise_or_warn(codes_[DriveAlarmKind::homing_method]); break;
        case HomingRun::Failure::time: raise_or_warn(codes_[DriveAlarmKind::homing_timeout]); break;
        case HomingRun::Failure::limit:
            if (has(Quirk::homing_limit_is_fault)) raise_or_warn(codes_[DriveAlarmKind::homing_limit]);
            break;
        case HomingRun::Failure::speed:
        case HomingRun::Failure::none: break;
    }
}

}  // namespace taktwerk::axes::sim
