// The modes in which the drive makes the profile: PP, PV, PT. Sources: CiA 402-2; SV33-E 3.4.3(5) to (8), SV-DA200 3.2 and 3.5, SE-808X 3.2.3
// to 3.2.5.

#include <algorithm>
#include <cmath>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

namespace {

constexpr double default_position_window = 10;       // counts, of drives without 6067h
constexpr std::int64_t torque_at_once = 0xFFFFFFFF;  // 6087h (SV33-E 7.3: default 2^32 - 1)

}  // namespace

/// counts/s; infinity: none.
double Cia402Axis::speed_limit(const AxisInputs& in) const noexcept {
    double limit = HUGE_VAL;
    if (in.maximum_velocity > 0) limit = static_cast<double>(in.maximum_velocity) / velocity_unit_;
    if (in.maximum_motor_speed > 0)
        limit = std::min(limit, static_cast<double>(in.maximum_motor_speed * motor_.counts_per_revolution) / 60.0);
    return limit;
}

void Cia402Axis::take_profile_position(const AxisInputs& in) noexcept {
    const bool start = (in.control & 0x10u) != 0, five = (in.control & 0x20u) != 0, relative = (in.control & 0x40u) != 0;
    if (start && too_early()) {
        ++early_commands_;
        return;
    }
    ProfileTarget target;
    target.relative = relative;
    target.position = static_cast<double>(in.target_position) + (relative ? 0 : zero_);
    const double wanted = static_cast<double>(in.profile_velocity) / velocity_unit_;
    target.limits.velocity = std::min(wanted, speed_limit(in));
    target.limits.acceleration = static_cast<double>(in.profile_acceleration);
    target.limits.deceleration = static_cast<double>(has(Quirk::pp_shared_ramp) ? in.profile_acceleration : in.profile_deceleration);
    if (limits_count(in)) {
        target.lowest = static_cast<double>(in.software_minimum) + zero_;
        target.highest = static_cast<double>(in.software_maximum) + zero_;
    }
    if (reached_told_) profile_position_.reached_was_told();
    profile_position_.exchange(start, five, target);
    limited_ = wanted > target.limits.velocity || profile_position_.clipped();
}

void Cia402Axis::take_profile_velocity(const AxisInputs& in) noexcept {
    if (too_early()) {
        if (in.target_velocity != 0) ++early_commands_;
        return;
    }
    const double wanted = static_cast<double>(in.target_velocity + in.velocity_offset) / velocity_unit_;
    const double limit = speed_limit(in);
    velocity_target_ = std::clamp(wanted, -limit, limit);
    limited_ = velocity_target_ != wanted;
}

void Cia402Axis::take_profile_torque(const AxisInputs& in) noexcept {
    if (too_early()) {
        if (in.target_torque != 0) ++early_commands_;
        return;
    }
    torque_target_ = torque_of(in.target_torque + in.torque_offset);
    const double limit = speed_limit(in);
    fastest_ = std::isfinite(limit) ? limit : 0;
    limited_ = std::isfinite(limit) && std::abs(plant_.velocity()) >= 0.99 * limit;
}

bool Cia402Axis::ramps_velocity() const noexcept {
    return mode_ == mode::profile_velocity || (mode_ == mode::cyclic_velocity && has(Quirk::csv_ramps));
}

/// 6083h away from standstill, 6084h towards it; a ramp of 0 moves nothing (SV33-E 8.5.5).
void Cia402Axis::ramp_velocity(double dt) noexcept {
    double left = dt;
    for (int part = 0; part < 2 && left > 0; ++part) {
        const double way = velocity_target_ - velocity_demand_;
        if (way == 0) return;
        const bool slower = velocity_demand_ != 0 && (velocity_demand_ > 0) != (way > 0);
        const double rate = static_cast<double>(slower ? settings_.profile_deceleration : settings_.profile_acceleration);
        const double span = slower ? std::min(std::abs(way), std::abs(velocity_demand_)) : std::abs(way);
        const double most = rate * left;
        velocity_demand_ += std::copysign(std::min(span, most), way);
        if (most <= span) return;
        left -= span / rate;
    }
}

void Cia402Axis::ramp_torque(double dt) noexcept {
    if (settings_.torque_slope < 0 || settings_.torque_slope == torque_at_once) {
        torque_demand_ = torque_target_;
        return;
    }
    const double most = torque_of(settings_.torque_slope) * dt;
    torque_demand_ += std::clamp(torque_target_ - torque_demand_, -most, most);
}

/// Inside the window of the mode, whatever its time.
bool Cia402Axis::profile_reached() const noexcept {
    if (halted_) return stands();  // CiA 402-2: with halt bit 10 means standstill
    switch (mode_) {
        case mode::profile_position: {
            if (state_ == State::quick_stop) return stop_done_;  // SV33-E 3.4.3(5)
            const double window = settings_.position_window < 0 ? default_position_window : static_cast<double>(settings_.position_window);
            // What the encoder counts: a window of 0 can be met (SV-DA200 6067h has no stated value).
            return profile_position_.arrived() && std::abs(profile_position_.reached_target() - (quantised() + zero_)) <= window;
        }
        case mode::profile_velocity: {
            const double turn = static_cast<double>(motor_.counts_per_revolution);
            const double raw = static_cast<double>(settings_.velocity_window);
            const double window = settings_.velocity_window < 0        ? 0.01 * turn
                                  : has(Quirk::velocity_window_in_rpm) ? raw * turn / 60.0
                                                                       : raw / velocity_unit_;
            return std::abs(velocity_target_ - seen_velocity()) <= window;
        }
        case mode::profile_torque: return torque_demand_ == torque_target_;
        default: return false;
    }
}

void Cia402Axis::watch_target() noexcept {
    if (!profile_reached() || (state_ != State::enabled && state_ != State::quick_stop)) {
        in_window_since_ = now_;
        target_reached_ = false;
        return;
    }
    const auto milliseconds = halted_                           ? 0
                              : mode_ == mode::profile_position ? settings_.position_window_time
                              : mode_ == mode::profile_velocity ? settings_.velocity_window_time
                                                                : 0;
    target_reached_ = now_ - in_window_since_ >= std::chrono::milliseconds{milliseconds};
}

}  // namespace taktwerk::axes::sim
