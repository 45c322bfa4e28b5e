// The cyclic synchronous modes: CSP, CSV, CST.

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

void Cia402Axis::take_position_target(const AxisInputs& in, double seconds) noexcept {
    const double wanted = travel_.within_limits(static_cast<double>(in.target_position), in, origin_.homed()) + origin_.zero();
    const double increment = cyclic_.increment_to(wanted);
    if (gate_.loses(increment >= 1, now_)) return;  // what was lost shows as a leap afterwards
    if (cyclic_.leaps(increment, motor_.motor().maximum_velocity, seconds)) return raise(codes_[DriveAlarmKind::setpoint_leap]);
    alarms_.lower_warning();
    if (has(Quirk::limit_stop_is_warning)) {
        if (at_limit_switch(wanted)) return;
        alarms_.leave_limit();
    }
    cyclic_.go(motor_.demand(), wanted, seconds);
}

/// True: the target leads into a limit switch, and the axis stays where it is.
bool Cia402Axis::at_limit_switch(double wanted) noexcept {
    const double position = plant().position();
    const bool into_negative = plant().negative_limit() && wanted < position;
    const bool into_positive = plant().positive_limit() && wanted > position;
    if (!into_negative && !into_positive) return false;
    warn_at_switch(into_negative ? -1 : 1);
    cyclic_.rest(position);
    motor_.demand({position, 0, motor_.demand().acceleration});
    return true;
}

void Cia402Axis::interpolate(double dt) noexcept {
    auto demand = motor_.demand();
    cyclic_.step(demand, dt);
    motor_.demand(demand);
}

void Cia402Axis::take_velocity_target(const AxisInputs& in) noexcept {
    if (gate_.loses(in.target_velocity != 0, now_)) return;
    velocity_.aim(motor_.velocity_of(in.target_velocity + in.velocity_offset));
    if (!ramps_velocity()) velocity_.demand(velocity_.target());
}

void Cia402Axis::take_torque_target(const AxisInputs& in) noexcept {
    if (gate_.loses(in.target_torque != 0, now_)) return;
    torque_.demand(motor_.torque_of(in.target_torque + in.torque_offset));
    torque_.limit_speed(motor_.speed_limit(in));
}

void Cia402Axis::take_torque_offset(const AxisInputs& in) noexcept {
    const bool feeds_forward = mode_ == mode::cyclic_position || mode_ == mode::cyclic_velocity;
    torque_.offset(feeds_forward ? motor_.torque_of(in.torque_offset) : 0);
}

}  // namespace taktwerk::axes::sim
