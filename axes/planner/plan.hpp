#pragma once
// The motion kernel: the fastest jerk-limited motion from any moving state to a position or to a velocity.
//
// Everything here is real-time safe: no allocation, no lock, noexcept, at most max_root_steps steps of root search per plan. Any
// thread. Results depend only on the arguments, not on the size of the unit: the same motion in micrometres or in counts has the
// same quality, because no tolerance is absolute.
//
// Limits are kept from a start inside them. A start outside them (a limit was lowered, an axis was taken over while moving)
// is brought inside with full jerk and full deceleration first, to the limit itself and not below it; nothing gets further outside than
// the start makes unavoidable. A start too fast to stop before the target passes it and returns.

#include <cstdint>

#include "axes/planner/motion.hpp"
#include "axes/planner/profile.hpp"

namespace taktwerk::axes {

enum class PlanError : std::uint8_t {
    none,
    invalid_input,  ///< a NaN, an infinity other than the jerk's, a limit <= 0
    out_of_bounds,  ///< a number outside PlanBounds, or a target velocity above the velocity limit
};

/// What the planner accepts. Inside these bounds no plan fails.
struct PlanBounds {
    static constexpr double largest = 1e30;          ///< any number handed in, in its unit
    static constexpr double smallest_limit = 1e-30;  ///< any limit, in its unit
    static constexpr double negligible = 1e-150;     ///< a smaller way, velocity or acceleration counts as 0: its square would vanish
};

/// With an error the profile moves on from the start position at the start velocity: not a motion to run.
struct Plan {
    Profile profile;
    PlanError error = PlanError::none;
};

/// Steps of the root search in the worst case; usually four to eight.
inline constexpr int max_root_steps = 100;

/// The fastest motion to `target` [u], ending there at rest: velocity 0, acceleration 0, position equal to the last bit.
[[nodiscard]] Plan plan_to_position(const MotionState& from, double target, const MotionLimits& limits) noexcept;

/// The fastest change to `target_velocity` [u/s, signed, at most limits.velocity], ending without acceleration; the profile moves on at
/// that velocity.
[[nodiscard]] Plan plan_to_velocity(const MotionState& from, double target_velocity, const MotionLimits& limits) noexcept;

/// The fastest stop. limits.velocity and limits.acceleration matter only where a start with acceleration forces a reversal.
[[nodiscard]] Plan plan_stop(const MotionState& from, const MotionLimits& limits) noexcept;

/// Signed way of plan_stop, u. NaN where plan_stop reports an error.
[[nodiscard]] double stopping_distance(const MotionState& from, const MotionLimits& limits) noexcept;

}  // namespace taktwerk::axes
