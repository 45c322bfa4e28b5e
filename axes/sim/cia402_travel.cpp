// The ends of the travel where they are the drive's own: software limits (SV33-E 3.4.4(2), 607Dh) in all modes, and limit switches outside
// CSP of a drive that only warns of them (5.5, A.220, A.221). How it stops there is an option of the drive (P04.15). Its way back is a
// command that points back. Homing looks at switches by itself; what it does at a software limit is not stated, and it takes no notice.

#include <algorithm>
#include <cmath>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

bool Cia402Axis::limits_count(const AxisInputs& in) const noexcept {
    const bool on = in.software_limits == SoftwareLimits::on || (in.software_limits == SoftwareLimits::after_homing && homed_);
    return on && in.software_minimum < in.software_maximum;
}

/// In the position modes a target beyond 607Dh is moved to the limit, and nothing else happens.
double Cia402Axis::within_software_limits(double wanted, const AxisInputs& in) noexcept {
    if (!limits_count(in)) return wanted;
    const double held = std::clamp(wanted, static_cast<double>(in.software_minimum), static_cast<double>(in.software_maximum));
    limited_ = held != wanted;
    return held;
}

int Cia402Axis::past_switch() const noexcept {
    if (!has(Quirk::limit_stop_is_warning)) return 0;
    return plant_.negative_limit() ? -1 : plant_.positive_limit() ? 1 : 0;
}

/// "The actual position, 6064h": not the target.
int Cia402Axis::past_software_limit(const AxisInputs& in) const noexcept {
    if (!limits_count(in)) return 0;
    return actual() < static_cast<double>(in.software_minimum) ? -1 : actual() > static_cast<double>(in.software_maximum) ? 1 : 0;
}

/// Which way the command points: its sign.
double Cia402Axis::pushes(const AxisInputs& in) const noexcept {
    if (mode::of_velocity(mode_)) return static_cast<double>(in.target_velocity + in.velocity_offset);
    if (mode::of_torque(mode_)) return static_cast<double>(in.target_torque + in.torque_offset);
    return profile_position_.arrived() ? 0 : profile_position_.target() - plant_.position();
}

void Cia402Axis::watch_travel(const AxisInputs& in) noexcept {
    const bool here = mode_ == mode::profile_position || mode::of_velocity(mode_) || mode::of_torque(mode_);
    if (state_ != State::enabled || !here) {
        travel_stop_ = 0;
        return;
    }
    // With both at once the switch decides (SV33-E 3.4.4(2)).
    const int at_switch = past_switch();
    const int at_limit = mode_ == mode::profile_position ? 0 : past_software_limit(in);
    const int end = at_switch != 0 ? at_switch : at_limit;
    limited_ = limited_ || at_limit != 0;
    const int stops_at = end * pushes(in) < 0 ? 0 : end;
    if (stops_at != 0) profile_position_.forget(plant_.position());
    if (stops_at == travel_stop_) return;
    travel_stop_ = stops_at;
    end_warning();
    if (stops_at == 0) {
        demand_ = {plant_.position(), plant_.velocity(), 0};
        velocity_demand_ = stands() ? 0 : plant_.velocity();
        profile_position_.resume({plant_.position(), 0, 0});
        return;
    }
    begin_stop(stop_for(StopCause::overtravel));
    if (at_switch == 0) return;
    warning_ = true;
    error_code_ = at_switch < 0 ? codes_[DriveAlarmKind::negative_limit].code : codes_[DriveAlarmKind::positive_limit].code;
}

}  // namespace taktwerk::axes::sim
