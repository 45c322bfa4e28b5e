#pragma once
// PLCopen's limits, which hold in both directions, kept inside those of an axis that has others for each. Real-time safe.
//
// What a plan of the base gets are limits per sign (SignedLimits), so that velocity, acceleration and deceleration of each direction hold also where a motion
// turns round: what brakes a positive velocity is an acceleration of negative sign. Where several motions add up (a superimposed one, a slave's) no one
// knows beforehand which way the sum goes: there the smaller acceleration and deceleration of both directions hold, and the velocity of each.

#include <algorithm>

#include "axes/axis/axis_config.hpp"
#include "axes/planner/motion.hpp"

namespace taktwerk::axes {

/// Of a motion in the direction of `sense`. A deceleration beyond what is configured for both was given on purpose (an error, MC_Stop) and stays.
[[nodiscard]] inline MotionLimits towards(MotionLimits limits, const AxisLimits& axis, double sense) noexcept {
    if (!axis.differ()) return limits;
    limits.velocity = std::min(limits.velocity, axis.velocity_towards(sense));
    limits.acceleration = std::min(limits.acceleration, axis.acceleration_towards(sense));
    if (limits.deceleration <= axis.deceleration) limits.deceleration = std::min(limits.deceleration, axis.deceleration_towards(sense));
    return limits;
}

[[nodiscard]] inline SignedLimits in_each_direction(const MotionLimits& limits, const AxisLimits& axis) noexcept {
    if (!axis.differ()) return SignedLimits{limits};
    const auto up = towards(limits, axis, 1), down = towards(limits, axis, -1);
    return {SignLimits{up.velocity, up.acceleration, down.deceleration, limits.jerk},
            SignLimits{down.velocity, down.acceleration, up.deceleration, limits.jerk}};
}

/// Ramps that are allowed whichever way the axis goes; the velocity is as it was.
[[nodiscard]] inline MotionLimits gentlest(const MotionLimits& limits, const AxisLimits& axis) noexcept {
    if (!axis.differ()) return limits;
    const auto up = towards(limits, axis, 1), down = towards(limits, axis, -1);
    return {limits.velocity, std::min(up.acceleration, down.acceleration), std::min(up.deceleration, down.deceleration), limits.jerk};
}

/// u/s, whichever way the axis goes.
[[nodiscard]] inline double slowest(const AxisLimits& axis) noexcept {
    return std::min(axis.velocity_towards(1), axis.velocity_towards(-1));
}

}  // namespace taktwerk::axes
