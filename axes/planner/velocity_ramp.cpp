#include "axes/planner/velocity_ramp.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

// In the plane of velocity and acceleration a jerk of constant magnitude draws parabolas, v = c + a^2/2j and v = c - a^2/2j.
// The fastest change of velocity keeps the acceleration, at every velocity, as high as three curves allow: the parabola that
// rises from the start, the acceleration limit of that velocity, and the parabola that falls into the target.

namespace taktwerk::axes {

TwoWayLimits two_way(const MotionLimits& limits) noexcept {
    const PushLimits push{limits.velocity, limits.acceleration, limits.deceleration, limits.jerk, limits.jerk};
    return {push, push};
}

VelocityRamp::VelocityRamp(double velocity, double acceleration, double target, const TwoWayLimits& limits) noexcept : velocity_{velocity} {
    const bool unlimited_jerk = std::isinf(limits.up.jerk_on);
    // Where the velocity ends when the acceleration is just taken away: the target lies above or below that.
    double released = velocity;
    if (!unlimited_jerk) {
        const double jerk = acceleration > 0 ? limits.up.jerk_off : limits.up.jerk_on;
        released += acceleration * std::abs(acceleration) / (2 * jerk);
    }
    const bool up = target >= released;
    sign_ = up ? 1 : -1;
    const PushLimits& push = up ? limits.up : limits.down;
    if (unlimited_jerk) {
        step(sign_ * velocity, sign_ * target, push);
    } else {
        rise(sign_ * velocity, sign_ * acceleration, sign_ * target, push);
    }
}

void VelocityRamp::add(double duration, double acceleration, double jerk) noexcept {
    if (!(duration > 0)) return;
    stretches_[static_cast<std::size_t>(count_++)] = {duration, sign_ * acceleration, sign_ * jerk};
    const double way = duration * (velocity_ + sign_ * duration * (acceleration / 2 + duration * (jerk / 6)));
    velocity_ += sign_ * duration * (acceleration + duration * (jerk / 2));
    travel_ += way;
    path_ += std::abs(way);
    duration_ += duration;
}

void VelocityRamp::step(double velocity, double target, const PushLimits& limits) noexcept {
    if (velocity < 0) add((std::min(target, 0.0) - velocity) / limits.slowing_down, limits.slowing_down, 0);
    if (target > 0) add((target - std::max(velocity, 0.0)) / limits.speeding_up, limits.speeding_up, 0);
}

void VelocityRamp::rise(double velocity, double acceleration, double target, const PushLimits& limits) noexcept {
    const double lowest = acceleration < 0 ? velocity - acceleration * acceleration / (2 * limits.jerk_on) : velocity;
    if (!(lowest < 0 && target > 0)) {
        leg(target - velocity, acceleration, 0, target > 0 ? limits.speeding_up : limits.slowing_down, limits);
        return;
    }
    // Two legs. The first one may arrive at velocity 0 only with what the second one can take over: its own limit, and what can
    // still be taken away before the target.
    const double takeover = std::min({limits.slowing_down, limits.speeding_up, std::sqrt(2 * limits.jerk_off * target)});
    const double crossing = leg(-velocity, acceleration, takeover, limits.slowing_down, limits);
    leg(target, crossing, 0, limits.speeding_up, limits);
}

/// From acceleration a0 to a1 while the velocity grows by dv, never above `bound`: rise, hold, fall. Returns the acceleration at
/// the end: less than a1 where dv is too short to build it up, more where it is too short to take it away (only a leg that ends
/// at velocity 0 can be too short).
double VelocityRamp::leg(double dv, double a0, double a1, double bound, const PushLimits& limits) noexcept {
    const double on = limits.jerk_on;
    const double off = limits.jerk_off;
    if (a0 > bound) {
        const double dv_to_bound = (a0 - bound) * (a0 + bound) / (2 * off);
        if (dv <= dv_to_bound && a1 > 0) {
            const double end = std::sqrt(std::max(a0 * a0 - 2 * off * dv, 0.0));
            add((a0 - end) / off, a0, -off);
            return end;
        }
        add((a0 - bound) / off, a0, -off);
        dv -= dv_to_bound;
        a0 = bound;
    }

    const double peak = std::sqrt(std::max((2 * dv * on * off + a0 * a0 * off + a1 * a1 * on) / (on + off), 0.0));
    if (a1 > 0 && peak < a0) {
        const double end = std::sqrt(std::max(a0 * a0 - 2 * off * dv, 0.0));
        add((a0 - end) / off, a0, -off);
        return end;
    }
    if (a1 > 0 && peak < a1) {
        const double end = std::sqrt(std::max(a0 * a0 + 2 * on * dv, 0.0));
        add((end - a0) / on, a0, on);
        return end;
    }
    if (peak > bound) {
        add((bound - a0) / on, a0, on);
        const double dv_rise = (bound - a0) * (bound + a0) / (2 * on);
        const double dv_fall = (bound - a1) * (bound + a1) / (2 * off);
        add((dv - dv_rise - dv_fall) / bound, bound, 0);
        add((bound - a1) / off, bound, -off);
    } else {
        const double top = std::max(peak, a0);  // differs only by rounding
        add((top - a0) / on, a0, on);
        add((top - a1) / off, top, -off);
    }
    return a1;
}

}  // namespace taktwerk::axes
