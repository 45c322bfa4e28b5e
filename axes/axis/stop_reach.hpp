#pragma once
// How far a stop gets from a state of motion. Real-time safe.

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_config.hpp"
#include "axes/planner/plan.hpp"

namespace taktwerk::axes {

/// More than a stop from there takes, whatever its acceleration is on: cheap, for every cycle.
[[nodiscard]] inline double stops_within(const MotionState& state, const AxisLimits& limits) noexcept {
    const double ease = 1 / limits.jerk;
    const double a = std::abs(state.acceleration);
    const double speed = std::abs(state.velocity) + a * a * ease / 2;
    const double softest = std::min(limits.deceleration_towards(1), limits.deceleration_towards(-1));
    return speed * (a * ease + (speed / softest + std::max(limits.deceleration, a) * ease));
}

/// The acceleration that brakes a motion in `sense` turns it round while it runs out.
[[nodiscard]] inline bool turns_back(const MotionState& from, double jerk, double sense) noexcept {
    const double speed = sense * from.velocity, braking = -sense * from.acceleration;
    return speed > 0 && braking > 0 && braking * braking > 2 * jerk * speed;
}

/// How far a stop gets in `sense`, u. Where the acceleration drives the axis back, the stop ends on this side of that.
[[nodiscard]] inline double reach_of_stop(const MotionState& from, const SignedLimits& limits, double sense) noexcept {
    const double jerk = limits.positive.jerk;  // of both signs
    if (!turns_back(from, jerk, sense)) return sense * stopping_distance(from, limits);
    const double speed = sense * from.velocity, braking = -sense * from.acceleration;
    const double turns = braking * braking - 2 * jerk * speed;
    const double time = 2 * speed / (braking + std::sqrt(turns));  // until it turns, the acceleration running out
    return time * (speed + time * (jerk * time / 6 - braking / 2));
}

}  // namespace taktwerk::axes
