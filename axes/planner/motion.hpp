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

/// PLCopen's limits: magnitudes, all > 0, the same in both directions. `acceleration` holds while |velocity| grows, `deceleration`
/// while it shrinks: they swap where the direction reverses. Each may be infinity: with an infinite jerk the acceleration jumps, with
/// an infinite acceleration as well the velocity does.
struct MotionLimits {
    double velocity = 0;      ///< u/s
    double acceleration = 0;  ///< u/s2
    double deceleration = 0;  ///< u/s2
    double jerk = 0;          ///< u/s3

    friend bool operator==(const MotionLimits&, const MotionLimits&) = default;
};

/// Limits of one sign: of positive velocities, accelerations and jerks, or of negative ones. Magnitudes, > 0, infinity allowed.
struct SignLimits {
    double velocity = 0;      ///< u/s
    double speeding_up = 0;   ///< acceleration of this sign while the velocity has this sign too (or is 0), u/s2
    double slowing_down = 0;  ///< acceleration of this sign while the velocity has the other one, u/s2
    double jerk = 0;          ///< u/s3

    friend bool operator==(const SignLimits&, const SignLimits&) = default;
};

/// Limits per sign: what the planner works with. PLCopen's limits are the case in which both signs are alike; plain limits per sign
/// (a highest and a lowest acceleration) the one in which speeding_up equals slowing_down.
struct SignedLimits {
    SignLimits positive;
    SignLimits negative;

    constexpr SignedLimits(const SignLimits& up, const SignLimits& down) noexcept : positive{up}, negative{down} {}
    constexpr explicit SignedLimits(const MotionLimits& l) noexcept
        : positive{l.velocity, l.acceleration, l.deceleration, l.jerk}, negative{positive} {}

    friend bool operator==(const SignedLimits&, const SignedLimits&) = default;
};

}  // namespace taktwerk::axes
