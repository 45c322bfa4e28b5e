#pragma once
// The motion kernel: the fastest jerk-limited motion from any moving state to a position, to a moving state, to a velocity; and a motion
// to a moving state that takes a given time.
//
// Everything here is real-time safe: no allocation, no lock, noexcept, at most max_roots searches of max_root_steps steps per plan. Any
// thread. Results depend only on the arguments, not on the size of the unit: the same motion in micrometres or in counts has the
// same quality, because no tolerance is absolute. mathematics.md explains the method.
//
// Limits are kept from a start inside them. A start outside them (a limit was lowered, an axis was taken over while moving)
// is brought inside with full jerk and full deceleration first, to the limit itself and not below it; nothing gets further outside than
// the start makes unavoidable. A start too fast to stop before the target passes it and returns.
//
// Limits come as PLCopen's (MotionLimits) or per sign (SignedLimits). Any of them may be infinity as long as something is left that
// limits: not velocity, acceleration and jerk of one direction at once.

#include <cstdint>

#include "axes/planner/motion.hpp"
#include "axes/planner/plan_limits.hpp"
#include "axes/planner/profile.hpp"

namespace taktwerk::axes {

enum class PlanError : std::uint8_t {
    none,
    invalid_input,          ///< a NaN, an infinity that is not a limit, a limit <= 0, nothing that limits, a time < 0
    out_of_bounds,          ///< a number outside PlanBounds, or a target velocity above the velocity limit
    target_outside_limits,  ///< no motion inside the limits can arrive with this velocity and acceleration
    no_solution,            ///< in this time the target cannot be reached: too short, or one of the times that are left out
};

/// With an error the profile moves on from the start position at the start velocity: not a motion to run.
struct Plan {
    Profile profile;
    PlanError error = PlanError::none;
    int looked_at = 0;  ///< motions that the search for the fastest one looked at: what it cost, on whatever machine
};

/// The fastest motion to `target` [u], ending there at rest: velocity 0, acceleration 0, position equal to the last bit.
[[nodiscard]] Plan plan_to_position(const MotionState& from, double target, const SignedLimits& limits) noexcept;
[[nodiscard]] inline Plan plan_to_position(const MotionState& from, double target, const MotionLimits& limits) noexcept {
    return plan_to_position(from, target, SignedLimits{limits});
}

/// The fastest motion that arrives at the position, velocity and acceleration of `target`, each equal to the last bit. Without a
/// jerk limit the acceleration of the target means nothing (the motion arrives with that of its last piece).
[[nodiscard]] Plan plan_to_state(const MotionState& from, const MotionState& target, const SignedLimits& limits) noexcept;
[[nodiscard]] inline Plan plan_to_state(const MotionState& from, const MotionState& target, const MotionLimits& limits) noexcept {
    return plan_to_state(from, target, SignedLimits{limits});
}

/// A motion that arrives in the state `target` after `duration` [s], inside the limits: at one velocity between a ramp up and a ramp down
/// where there is such a motion, otherwise a mixture of the motions that get furthest and least far in this time. For a moving target
/// not every longer time has a solution (one may be too fast to wait and too slow to come round again): no_solution then.
/// Where acceleration and deceleration differ and the direction reverses, and no constant velocity in between will do, the smaller
/// of the two is kept on both sides; this may miss a solution.
[[nodiscard]] Plan plan_in_time(const MotionState& from, const MotionState& target, double duration, const SignedLimits& limits) noexcept;
[[nodiscard]] inline Plan plan_in_time(const MotionState& from, const MotionState& target, double duration,
                                       const MotionLimits& limits) noexcept {
    return plan_in_time(from, target, duration, SignedLimits{limits});
}

/// The fastest change to `target_velocity` [u/s, signed, at most the limit], ending without acceleration; the profile moves on at
/// that velocity.
[[nodiscard]] Plan plan_to_velocity(const MotionState& from, double target_velocity, const SignedLimits& limits) noexcept;
[[nodiscard]] inline Plan plan_to_velocity(const MotionState& from, double target_velocity, const MotionLimits& limits) noexcept {
    return plan_to_velocity(from, target_velocity, SignedLimits{limits});
}

/// The fastest stop. The limits of velocity and of speeding up matter only where a start with acceleration forces a reversal.
[[nodiscard]] Plan plan_stop(const MotionState& from, const SignedLimits& limits) noexcept;
[[nodiscard]] inline Plan plan_stop(const MotionState& from, const MotionLimits& limits) noexcept {
    return plan_stop(from, SignedLimits{limits});
}

/// Signed way of plan_stop, u. NaN where plan_stop reports an error.
[[nodiscard]] double stopping_distance(const MotionState& from, const SignedLimits& limits) noexcept;
[[nodiscard]] inline double stopping_distance(const MotionState& from, const MotionLimits& limits) noexcept {
    return stopping_distance(from, SignedLimits{limits});
}

}  // namespace taktwerk::axes
