#include "axes/axis/torque_control.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {

void TorqueControl::start(double torque_now, double velocity_now, double acceleration_now) noexcept {
    ramped_ = torque_ = torque_now;
    high_ = velocity_now;
    low_ = -velocity_now;
    observed_velocity_ = velocity_now;
    observed_load_ = torque_now - inertia_ * acceleration_now;
    braking_ = in_torque_ = limited_ = false;
}

void TorqueControl::command(double torque, double ramp, const TorqueLimits& limits, TorqueSense sense) noexcept {
    wanted_ = torque;
    ramp_ = ramp;
    limits_ = limits;
    sense_ = sense;
    braking_ = false;
}

void TorqueControl::brake(double deceleration) noexcept {
    braking_ = true;
    wanted_ = ramped_ = 0;
    limits_.deceleration = deceleration;
}

/// Luenberger, both poles at half the bandwidth: velocity and load that explain what was measured.
void TorqueControl::observe(double velocity, double dt) noexcept {
    const double pole = bandwidth_ / 2;
    const double error = velocity - observed_velocity_;
    observed_velocity_ += dt * ((torque_ - observed_load_) / inertia_ + 2 * pole * error);
    observed_load_ -= dt * pole * pole * inertia_ * error;
}

/// The highest torque, load apart, for a motor whose velocity may not rise above `top`.
double TorqueControl::bound(double& reference, double velocity, double top, double dt) const noexcept {
    const double rate =
        velocity < 0 ? limits_.deceleration : limits_.acceleration;  // P1-183: upwards is braking while it runs the other way
    const double before = reference;
    // Never more than a cycle's change ahead of the motor, and into the limit without a corner.
    const double ahead = std::min(before + rate * dt, velocity + rate * dt);
    const double eased = before + std::max(0.0, top - before) * bandwidth_ / 2 * dt;
    double slope = rate;
    if (before > top) {  // the limit has been lowered, or the motor was faster when this began
        reference = std::max(top, before - limits_.deceleration * dt);
        slope = (reference - before) / dt;
        if (ahead < reference) {
            reference = ahead;
            slope = rate;
        }
    } else if (ahead <= eased) {
        reference = ahead;
    } else {
        reference = eased;
        slope = (eased - before) / dt;
    }
    return inertia_ * (slope + bandwidth_ * (reference - velocity));
}

double TorqueControl::step(double velocity, Duration period) noexcept {
    const double dt = to_seconds(period);
    if (inertia_ > 0) observe(velocity, dt);
    const double way = wanted_ - ramped_;
    ramped_ = ramp_ > 0 && std::abs(way) > ramp_ * dt * (1 + 1e-9) ? ramped_ + std::copysign(ramp_ * dt, way) : wanted_;
    const double bounded = std::clamp(ramped_, least_, most_);
    torque_ = bounded;
    if (inertia_ > 0) {
        const double top = braking_ || sense_ == TorqueSense::only_negative ? 0 : limits_.velocity;
        const double bottom = braking_ || sense_ == TorqueSense::only_positive ? 0 : limits_.velocity;
        const double highest = observed_load_ + bound(high_, velocity, top, dt);
        const double lowest = observed_load_ - bound(low_, -velocity, bottom, dt);
        torque_ = std::clamp(std::clamp(bounded, std::min(lowest, highest), std::max(lowest, highest)), least_, most_);
    }
    limited_ = torque_ != ramped_;
    in_torque_ = !limited_ && !braking_ && torque_ == wanted_;
    return torque_;
}

}  // namespace taktwerk::axes
