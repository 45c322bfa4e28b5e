#pragma once
// How long an axis needs to stop, for whoever must wait for it or cut its power.

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_config.hpp"

namespace taktwerk::runtime {

/// Seconds a jerk-limited stop from full speed takes, braking alone: the trapezoid of acceleration, or the triangle when the
/// deceleration is not reached. `limits` have passed axes::check().
[[nodiscard]] inline double stop_seconds(const axes::AxisLimits& limits) noexcept {
    const double softest = std::min(limits.deceleration_towards(1), limits.deceleration_towards(-1));
    const double given = limits.stop_deceleration > 0 ? limits.stop_deceleration : limits.deceleration;
    const double d = given > limits.deceleration ? given : std::min(given, softest);
    const double j = limits.stop_jerk > 0 ? limits.stop_jerk : limits.jerk;
    if (std::isinf(j)) return limits.velocity / d;
    if (limits.velocity >= d * d / j) return limits.velocity / d + d / j;
    return 2 * std::sqrt(limits.velocity / j);
}

}  // namespace taktwerk::runtime
