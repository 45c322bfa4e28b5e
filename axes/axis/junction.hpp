#pragma once
// How fast an axis passes from one blended move into the next: PLCopen Part 1, table 5 and appendix A, made feasible.
//
// The rule gives a velocity v_j at the end P1 of the first move: the lower, the first's, the second's or the higher of both commanded
// velocities. Blending visits the same positions as Buffered, only the velocities differ. Therefore v_j becomes 0 where the second move goes the
// other way, is lowered to what the second move and those behind it can still take away (a pass from the end of the chain
// forwards), and is the nearest reachable one where the first cannot have it at P1 any more. The acceleration at P1 is 0.
//
// Pure functions, real-time safe: at most one search per move and one more for the first. Positions u, velocities u/s.

#include <span>

#include "axes/planner/plan.hpp"
#include "axes/words/types.hpp"

namespace taktwerk::axes {

[[nodiscard]] constexpr bool blends(MC_BufferMode mode) noexcept { return mode >= mcBlendingLow && mode <= mcBlendingHigh; }

/// One move of a chain as it is going to run.
struct ChainMove {
    enum class End : unsigned char {
        rest,      ///< stops at its end, unless the next one blends
        velocity,  ///< passes its end with end_velocity, whatever comes behind it (MC_MoveContinuous...)
        none,      ///< has no end (MC_MoveVelocity)
    };

    double way = 0;                   ///< from where the one before ends, signed; for End::none only its sign counts
    double speed = 0;                 ///< as commanded and allowed, >= 0
    MC_BufferMode mode = mcBuffered;  ///< how it joins the one before
    End end = End::rest;
    double end_velocity = 0;  ///< signed; End::velocity
    MotionLimits limits;      ///< its ramps
};

/// The rule alone: magnitude, u/s.
[[nodiscard]] double blending_velocity(MC_BufferMode mode, double first, double second) noexcept;

/// Signed velocity that chain[0], the running move, should have at its end, as the moves behind it allow.
[[nodiscard]] double junction_velocity(std::span<const ChainMove> chain) noexcept;

/// The velocity nearest to `wanted` (which points to `position`) that a motion from `from` can have at `position` without passing it
/// before; 0 where it has to turn.
[[nodiscard]] double nearest_reachable(double wanted, const MotionState& from, double position, const SignedLimits& limits) noexcept;
[[nodiscard]] inline double nearest_reachable(double wanted, const MotionState& from, double position,
                                              const MotionLimits& limits) noexcept {
    return nearest_reachable(wanted, from, position, SignedLimits{limits});
}

/// To `target` at the limit of velocity, also where the target's velocity is higher: the ramp up to it is then the last part of the way, and
/// where the way is too short for that, the limit is exceeded earlier.
[[nodiscard]] Plan plan_through(const MotionState& from, const MotionState& target, const SignedLimits& limits) noexcept;
[[nodiscard]] inline Plan plan_through(const MotionState& from, const MotionState& target, const MotionLimits& limits) noexcept {
    return plan_through(from, target, SignedLimits{limits});
}

}  // namespace taktwerk::axes
