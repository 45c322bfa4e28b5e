// The cyclic synchronous modes: CSP, CSV, CST.

#include <algorithm>
#include <cmath>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

namespace {

// SV33-E E.424, "several times above the single maximum speed"; how often: P0A.33, 3 times from the factory.
constexpr std::uint32_t allowed_strikes = 3;
constexpr double increment_factor = 1.0;

}  // namespace

void Cia402Axis::take_position_target(const AxisInputs& in, double seconds) noexcept {
    const double wanted = within_software_limits(static_cast<double>(in.target_position), in) + zero_;
    const double increment = std::abs(wanted - target_);
    if (too_early()) {  // the drive does not listen yet; what was lost shows as a leap afterwards
        if (increment >= 1) ++early_commands_;
        return;
    }
    largest_increment_ = std::max(largest_increment_, increment);
    if (motor_.maximum_velocity > 0 && increment > increment_factor * motor_.maximum_velocity * seconds) {
        if (++strikes_ >= allowed_strikes) {
            raise(codes_[DriveAlarmKind::setpoint_leap]);
            return;
        }
    } else {
        strikes_ = 0;
    }
    warning_ = false;
    if (has(Quirk::limit_stop_is_warning)) {
        const bool into_negative = plant_.negative_limit() && wanted < plant_.position();
        const bool into_positive = plant_.positive_limit() && wanted > plant_.position();
        if (into_negative || into_positive) {
            warning_ = true;
            error_code_ = into_negative ? codes_[DriveAlarmKind::negative_limit].code : codes_[DriveAlarmKind::positive_limit].code;
            target_ = demand_.position = plant_.position();
            demand_.velocity = 0;
            steps_left_ = 0;
            return;
        }
        error_code_ = 0;
    }
    target_ = wanted;
    steps_left_ = std::max<std::int64_t>(1, std::llround(seconds / inner_seconds));
    demand_step_ = (target_ - demand_.position) / (static_cast<double>(steps_left_) * inner_seconds);
}

void Cia402Axis::interpolate(double dt) noexcept {
    if (steps_left_ == 0) {
        demand_.velocity = 0;
        return;
    }
    --steps_left_;
    demand_.velocity = demand_step_;
    demand_.position = steps_left_ == 0 ? target_ : demand_.position + demand_step_ * dt;
}

void Cia402Axis::take_velocity_target(const AxisInputs& in) noexcept {
    if (too_early()) {
        if (in.target_velocity != 0) ++early_commands_;
        return;
    }
    velocity_target_ = static_cast<double>(in.target_velocity + in.velocity_offset) / velocity_unit_;
    if (!ramps_velocity()) velocity_demand_ = velocity_target_;
}

void Cia402Axis::take_torque_target(const AxisInputs& in) noexcept {
    if (too_early()) {
        if (in.target_torque != 0) ++early_commands_;
        return;
    }
    torque_demand_ = torque_of(in.target_torque + in.torque_offset);
    const double limit = speed_limit(in);
    fastest_ = std::isfinite(limit) ? limit : 0;
}

void Cia402Axis::take_torque_offset(const AxisInputs& in) noexcept {
    const bool feeds_forward = mode_ == mode::cyclic_position || mode_ == mode::cyclic_velocity;
    torque_offset_ = feeds_forward ? torque_of(in.torque_offset) : 0;
}

double Cia402Axis::with_offset(double torque) const noexcept {
    return std::clamp(torque + torque_offset_, -torque_limit(), torque_limit());
}

double Cia402Axis::torque_of(std::int64_t raw) const noexcept {
    return static_cast<double>(raw) / profile_->torque_rated_raw * plant_.config().rated_torque;
}

}  // namespace taktwerk::axes::sim
