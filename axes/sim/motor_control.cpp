#include "axes/sim/motor_control.hpp"

#include <algorithm>
#include <limits>

namespace taktwerk::axes::sim {

namespace {

constexpr double shorted_damping = 20.0;  // 1/s: a motor with shorted phases loses its speed in some 50 ms

}  // namespace

MotorControl::MotorControl(const PlantConfig& plant, const SimulatedMotor& motor, const DriveProfile& profile) noexcept
    : motor_(motor),
      velocity_unit_(profile.velocity_counts_per_unit),
      torque_rated_raw_(profile.torque_rated_raw),
      turn_(static_cast<double>(motor.counts_per_revolution)),
      plant_(plant) {
    limit_torque({});
}

double MotorControl::rescale(double counts_per_revolution) noexcept {
    const double factor = counts_per_revolution / turn_;
    if (factor == 1) return factor;
    plant_.rescale(factor);
    for (double* count : {&demand_.position, &demand_.velocity, &motor_.following_error_limit, &motor_.maximum_velocity, &motor_.overspeed,
                          &motor_.start_speed})
        *count *= factor;
    turn_ = counts_per_revolution;
    motor_.counts_per_revolution = std::llround(turn_);
    return factor;
}

void MotorControl::open_loop(std::optional<double> standby) noexcept {
    stepper_.reset();
    if (standby) stepper_.emplace(*standby);
}

bool MotorControl::stands() const noexcept { return std::abs(velocity()) < 0.01 * static_cast<double>(motor_.counts_per_revolution); }

bool MotorControl::too_fast_to_start() const noexcept { return motor_.start_speed > 0 && std::abs(plant_.velocity()) > motor_.start_speed; }

double MotorControl::torque_of(std::int64_t raw) const noexcept {
    return static_cast<double>(raw) / torque_rated_raw_ * plant_.config().rated_torque;
}

void MotorControl::tell_torque() noexcept {
    told_torque_ = since_told_ > 0 && torque_ != 0 ? impulse_ / since_told_ : torque_;  // without power there is none, at once
    impulse_ = since_told_ = 0;
}

std::int64_t MotorControl::raw_torque() const noexcept {
    return stepper_ ? 0 : std::llround(told_torque_ / plant_.config().rated_torque * torque_rated_raw_);
}

double MotorControl::speed_limit(const AxisInputs& in) const noexcept {
    double limit = HUGE_VAL;
    if (in.maximum_velocity > 0) limit = velocity_of(in.maximum_velocity);
    if (in.maximum_motor_speed > 0)
        limit = std::min(limit, static_cast<double>(in.maximum_motor_speed * motor_.counts_per_revolution) / 60.0);
    return limit;
}

/// A limit is a number without sign, the negative one too.
void MotorControl::limit_torque(const AxisInputs& in) noexcept {
    const auto limit = [&](std::int64_t raw) { return raw < 0 ? std::numeric_limits<double>::infinity() : torque_of(raw); };
    torque_most_ = std::min({torque_limit(), limit(in.torque_limit), limit(in.torque_limit_positive)});
    torque_least_ = -std::min({torque_limit(), limit(in.torque_limit), limit(in.torque_limit_negative)});
}

double MotorControl::position_torque(double zero, double dt) noexcept {
    if (stepper_) return stepper_->torque(plant_, demand_, torque_limit(), dt);
    const double measured = std::floor(position() - zero) + zero;
    return loop_.position_control(plant_, demand_, measured, torque_limit(), dt);
}

double MotorControl::velocity_torque(double velocity, double acceleration, double limit, double dt) noexcept {
    if (!stepper_) return loop_.velocity_control(plant_, velocity, acceleration, limit, dt);
    demand_.velocity = velocity;
    demand_.position += velocity * dt;
    return stepper_->torque(plant_, demand_, limit, dt);
}

double MotorControl::brake_torque() const noexcept {
    return std::clamp(-plant_.torque_for(shorted_damping * plant_.velocity()), -torque_limit(), torque_limit());
}

void MotorControl::give(double torque) noexcept { torque_ = std::clamp(torque, torque_least_, torque_most_); }

void MotorControl::release_field() noexcept {
    if (!stepper_) return;
    demand_.velocity = 0;
    stepper_->release();
}

}  // namespace taktwerk::axes::sim
