#include "axes/sim/trapezoid.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes::sim {

void Trapezoid::rest(double position) noexcept {
    count_ = 0;
    duration_ = 0;
    position_ = target_ = position;
    velocity_ = end_velocity_ = 0;
}

void Trapezoid::add(double seconds, double acceleration) noexcept {
    if (!(seconds > 0)) return;
    phases_[count_++] = {seconds, acceleration};
    duration_ += seconds;
}

void Trapezoid::go(double position, double velocity, double target, const TrapezoidLimits& limits, double through) noexcept {
    rest(position);
    if (!limits.usable()) return;
    velocity_ = velocity;
    target_ = target;
    const double up = limits.acceleration, down = limits.deceleration;
    double end = std::min(through, limits.velocity);

    double from = position, speed = std::abs(velocity);
    if (speed > 0) {
        const double heading = std::copysign(1.0, velocity);
        const double to_end_speed = std::max(0.0, speed * speed - end * end) / (2 * down);
        if ((target - (from + heading * to_end_speed)) * heading < 0) {  // away from it, or too fast: stand first
            add(speed / down, -heading * down);
            from += heading * speed * speed / (2 * down);
            speed = end = 0;
        }
    }
    const double heading = target >= from ? 1 : -1;
    double way = std::abs(target - from);
    if (speed > limits.velocity) {
        add((speed - limits.velocity) / down, -heading * down);
        way -= (speed * speed - limits.velocity * limits.velocity) / (2 * down);
        speed = limits.velocity;
    }
    const double reachable = std::sqrt(speed * speed + 2 * up * way);
    end = std::min(end, reachable);
    // Both ramps meet at the peak: way = (peak^2 - speed^2) / 2 up + (peak^2 - end^2) / 2 down.
    const double meeting = std::sqrt((2 * up * down * way + down * speed * speed + up * end * end) / (up + down));
    const double peak = std::min(std::max(meeting, speed), limits.velocity);
    add((peak - speed) / up, heading * up);
    const double cruise = way - (peak * peak - speed * speed) / (2 * up) - (peak * peak - end * end) / (2 * down);
    if (peak > 0) add(cruise / peak, 0);
    add((peak - end) / down, -heading * down);
    end_velocity_ = heading * end;
}

Demand Trapezoid::at(double t) const noexcept {
    if (t >= duration_) return {target_ + end_velocity_ * (t - duration_), end_velocity_, 0};
    Demand now{position_, velocity_, 0};
    for (std::size_t i = 0; i < count_; ++i) {
        const double dt = std::min(t, phases_[i].seconds);
        now.position += now.velocity * dt + phases_[i].acceleration * dt * dt / 2;
        now.velocity += phases_[i].acceleration * dt;
        t -= dt;
        if (t <= 0) {
            now.acceleration = phases_[i].acceleration;
            break;
        }
    }
    return now;
}

}  // namespace taktwerk::axes::sim
