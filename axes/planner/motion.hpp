#pragma once
// What motion is made of: the state of one degree of freedom and the limits it keeps. Unit u is the axis' configured
// unit (mm, deg, counts, ...); nothing in this folder depends on its size.

namespace taktwerk::axes {

/// Where an axis is and how it moves. u, u/s, u/s2.
struct MotionState {
    double position = 0;
    double velocity = 0;
    double acceleration = 0;

    friend bool operator==(const MotionState&, const MotionState&) = default;
};

/// Magnitudes, all > 0. `acceleration` holds while |velocity| grows, `deceleration` while it shrinks (PLCopen): they swap
/// where the direction reverses. `jerk` may be infinity: the acceleration then jumps.
struct MotionLimits {
    double velocity = 0;      ///< u/s
    double acceleration = 0;  ///< u/s2
    double deceleration = 0;  ///< u/s2
    double jerk = 0;          ///< u/s3

    friend bool operator==(const MotionLimits&, const MotionLimits&) = default;
};

}  // namespace taktwerk::axes
