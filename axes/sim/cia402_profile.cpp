// The modes in which the drive makes the profile: PP, PV, PT. Sources: CiA 402-2; SV33-E 3.4.3(5) to (8), SV-DA200 3.2 and 3.5, SE-808X 3.2.3
// to 3.2.5.

#include <algorithm>
#include <cmath>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

namespace {

constexpr double default_position_window = 10;  // counts, of drives without 6067h

}  // namespace

void Cia402Axis::take_profile_position(const AxisInputs& in) noexcept {
    const bool start = (in.control & 0x10u) != 0, five = (in.control & 0x20u) != 0, relative = (in.control & 0x40u) != 0;
    if (start && gate_.loses(true, now_)) return;
    const double zero = origin_.zero();
    ProfileTarget target;
    target.relative = relative;
    target.position = static_cast<double>(in.target_position) + (relative ? 0 : zero);
    const double wanted = motor_.velocity_of(in.profile_velocity);
    target.limits.velocity = std::min(wanted, motor_.speed_limit(in));
    target.limits.acceleration = static_cast<double>(in.profile_acceleration);
    target.limits.deceleration = static_cast<double>(has(Quirk::pp_shared_ramp) ? in.profile_acceleration : in.profile_deceleration);
    if (TravelEnds::limits_count(in, origin_.homed())) {
        target.lowest = static_cast<double>(in.software_minimum) + zero;
        target.highest = static_cast<double>(in.software_maximum) + zero;
    }
    if (window_.told()) profile_position_.reached_was_told();
    profile_position_.exchange(start, five, target);
    travel_.limited(wanted > target.limits.velocity || profile_position_.clipped());
}

void Cia402Axis::take_profile_velocity(const AxisInputs& in) noexcept {
    if (gate_.loses(in.target_velocity != 0, now_)) return;
    const double wanted = motor_.velocity_of(in.target_velocity + in.velocity_offset);
    const double limit = motor_.speed_limit(in);
    velocity_.aim(std::clamp(wanted, -limit, limit));
    travel_.limited(velocity_.target() != wanted);
}

void Cia402Axis::take_profile_torque(const AxisInputs& in) noexcept {
    if (gate_.loses(in.target_torque != 0, now_)) return;
    torque_.aim(motor_.torque_of(in.target_torque + in.torque_offset));
    const double limit = motor_.speed_limit(in);
    torque_.limit_speed(limit);
    travel_.limited(std::isfinite(limit) && std::abs(plant().velocity()) >= 0.99 * limit);
}

bool Cia402Axis::ramps_velocity() const noexcept {
    return mode_ == mode::profile_velocity || (mode_ == mode::cyclic_velocity && has(Quirk::csv_ramps));
}

/// 6083h, 6084h.
void Cia402Axis::ramp_velocity(double dt) noexcept {
    velocity_.ramp(static_cast<double>(settings_.profile_acceleration), static_cast<double>(settings_.profile_deceleration), dt);
}

/// Inside the window of the mode, whatever its time.
bool Cia402Axis::profile_reached() const noexcept {
    if (stop_.halted()) return stands();  // CiA 402-2: with halt bit 10 means standstill
    switch (mode_) {
        case mode::profile_position: {
            if (state_ == State::quick_stop) return stop_.done();  // SV33-E 3.4.3(5)
            const double window = settings_.position_window < 0 ? default_position_window : static_cast<double>(settings_.position_window);
            // What the encoder counts: a window of 0 can be met (SV-DA200 6067h has no stated value).
            const double seen = std::floor(actual()) + origin_.zero();
            return profile_position_.arrived() && std::abs(profile_position_.reached_target() - seen) <= window;
        }
        case mode::profile_velocity: {
            const double turn = counts_per_revolution();
            const double window = settings_.velocity_window < 0        ? 0.01 * turn
                                  : has(Quirk::velocity_window_in_rpm) ? static_cast<double>(settings_.velocity_window) * turn / 60.0
                                                                       : motor_.velocity_of(settings_.velocity_window);
            return std::abs(velocity_.target() - motor_.velocity()) <= window;
        }
        case mode::profile_torque: return torque_.reached();
        default: return false;
    }
}

void Cia402Axis::watch_target() noexcept {
    const bool inside = profile_reached() && (state_ == State::enabled || state_ == State::quick_stop);
    const auto milliseconds = stop_.halted()                    ? 0
                              : mode_ == mode::profile_position ? settings_.position_window_time
                              : mode_ == mode::profile_velocity ? settings_.velocity_window_time
                                                                : 0;
    window_.step(inside, now_, std::chrono::milliseconds{milliseconds});
}

}  // namespace taktwerk::axes::sim
