#pragma once
// What can be reached within a distance: the questions of blending, of limits, of a chain of commands. Answered with the bricks of the
// planner, so a plan agrees to the last digits. Real-time safe: at most two searches of max_root_steps steps. Any thread.
//
// All functions: NaN where PlanBounds are left or nothing is reached. A distance is signed; its sign is the direction of the motion,
// and the velocities that come out have this sign.

#include "axes/planner/motion.hpp"

namespace taktwerk::axes {

/// The plain stop of a moving axis.
struct Stopping {
    double distance = 0;  ///< signed, u
    double time = 0;      ///< s
};
[[nodiscard]] Stopping stopping(double velocity, double acceleration, const SignedLimits& limits) noexcept;

/// The highest velocity (without acceleration) that is reached from (velocity, acceleration) before `distance` is used up, at most the
/// limit. NaN where the distance is too short to take the acceleration away.
[[nodiscard]] double highest_reachable_velocity(double distance, double velocity, double acceleration, const SignedLimits& limits) noexcept;

/// The highest velocity (without acceleration) from which (end_velocity, no acceleration) can be reached within `distance`, at most the
/// limit. With end_velocity 0: from which one can stop. end_velocity against the direction is possible: the axis comes back for it.
[[nodiscard]] double highest_entry_velocity(double distance, double end_velocity, const SignedLimits& limits) noexcept;

}  // namespace taktwerk::axes
