// What the axis does at the ends of its travel, outside of CSP and homing. Where they are: travel_ends.hpp.

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

/// Which way the command points: its sign.
double Cia402Axis::pushes(const AxisInputs& in) const noexcept {
    if (mode::of_velocity(mode_)) return static_cast<double>(in.target_velocity + in.velocity_offset);
    if (mode::of_torque(mode_)) return static_cast<double>(in.target_torque + in.torque_offset);
    return profile_position_.arrived() ? 0 : profile_position_.target() - plant().position();
}

void Cia402Axis::watch_travel(const AxisInputs& in) noexcept {
    const bool here = mode_ == mode::profile_position || mode::of_velocity(mode_) || mode::of_torque(mode_);
    if (state_ != State::enabled || !here) return travel_.leave();
    const double position = plant().position();
    const int at_switch = travel_.past_switch(plant());
    const int at_limit = mode_ == mode::profile_position ? 0 : TravelEnds::past_limit(actual(), in, origin_.homed());
    const int end = at_switch != 0 ? at_switch : at_limit;
    if (at_limit != 0) travel_.limited(true);
    const int stops_at = end * pushes(in) < 0 ? 0 : end;
    if (stops_at != 0) profile_position_.forget(position);
    if (!travel_.stop_at(stops_at)) return;
    alarms_.end_warning();
    if (stops_at == 0) {
        motor_.demand({position, plant().velocity(), 0});
        velocity_.demand(stands() ? 0 : plant().velocity());
        profile_position_.resume({position, 0, 0});
        return;
    }
    begin_stop(stop_for(StopCause::overtravel));
    if (at_switch != 0) warn_at_switch(at_switch);
}

void Cia402Axis::warn_at_switch(int end) noexcept {
    alarms_.warn_at_limit(codes_[end < 0 ? DriveAlarmKind::negative_limit : DriveAlarmKind::positive_limit].code);
}

}  // namespace taktwerk::axes::sim
