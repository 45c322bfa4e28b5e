#pragma once
// The ramp of a stop. It never turns the axis round, and it makes it no faster than the motion that it ends would have been.
//
// A motion with velocity v that brakes with acceleration a loses another a^2 / (2 j) while its acceleration is taken away with jerk j. Where that is
// more than v, the axis would run backwards, as fast as the difference: with the jerk a^2 / (2 |v|) it comes to rest just as its acceleration
// does. It does so after 2 |v| / |a|; less than a cycle has no shape that a drive could see.

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/planner/plan.hpp"

namespace taktwerk::axes {

/// Of a stop from `from`: `limits`, with as much more jerk as it needs to end without a swing through zero. What would be over within a `period`
/// [s] comes to rest with the acceleration it has. From a motion that speeds up, `limits`.
[[nodiscard]] inline MotionLimits never_reversing(const MotionState& from, MotionLimits limits, double period) noexcept {
    constexpr double surely = 1 + 1e-12;  // rounding must not leave a last bit of velocity in the other sense
    const double speed = std::abs(from.velocity), a = std::abs(from.acceleration);
    if (a == 0 || from.velocity * from.acceleration > 0 || a * a <= 2 * speed * limits.jerk) return limits;
    if (2 * speed <= a * period) {
        limits.jerk = std::numeric_limits<double>::infinity();
        limits.deceleration = std::max(limits.deceleration, a);
    } else {
        limits.jerk = surely * a * a / (2 * speed);
    }
    return limits;
}

}  // namespace taktwerk::axes
