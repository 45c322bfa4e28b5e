#pragma once
// The four coordinate systems in which the planner asks the same question. Internal to the planner.
//
// Mirrored: p -> -p. Reversed: t -> T - t. Every family of motions is written once, for a push upwards, and used in the frame
// where it is one. Jerks are kept as their reciprocals too ("ease"): an infinite jerk is an ease of 0, and 0 is a number one can
// multiply with.

#include <cmath>

#include "axes/planner/motion.hpp"

namespace taktwerk::axes {

/// Limits of one sign, as seen in a frame.
struct Bounds {
    double velocity = 0;
    double speeding_up = 0;
    double slowing_down = 0;
    double jerk = 0;
    double ease = 0;  ///< 1 / jerk
};

struct FrameLimits {
    Bounds up;
    Bounds down;

    [[nodiscard]] FrameLimits mirrored() const noexcept { return {down, up}; }
    /// Backwards in time velocities and jerks change their sign, accelerations do not.
    [[nodiscard]] FrameLimits reversed() const noexcept {
        return {{down.velocity, up.slowing_down, up.speeding_up, down.jerk, down.ease},
                {up.velocity, down.slowing_down, down.speeding_up, up.jerk, up.ease}};
    }
    /// Neither sign has a jerk limit: accelerations mean nothing at the ends.
    [[nodiscard]] bool jerk_free() const noexcept { return up.ease == 0 && down.ease == 0; }
    /// The same bounds on both sides of velocity 0: then the motions within the limits form a convex set.
    [[nodiscard]] bool convex() const noexcept { return up.speeding_up == up.slowing_down && down.speeding_up == down.slowing_down; }
};

[[nodiscard]] inline Bounds bounds(const SignLimits& l) noexcept { return {l.velocity, l.speeding_up, l.slowing_down, l.jerk, 1 / l.jerk}; }
[[nodiscard]] inline FrameLimits frame_limits(const SignedLimits& l) noexcept { return {bounds(l.positive), bounds(l.negative)}; }

/// What the velocity becomes when the acceleration is just taken away.
[[nodiscard]] inline double release(double a, const FrameLimits& l) noexcept {
    return a > 0 ? a * a * l.down.ease / 2 : -(a * a * l.up.ease / 2);
}
[[nodiscard]] inline double released_velocity(double v, double a, const FrameLimits& l) noexcept { return v + release(a, l); }

/// From (v0, a0) to (v1, a1) over `way`, inside the limits at both ends.
struct Problem {
    double v0 = 0;
    double a0 = 0;
    double v1 = 0;
    double a1 = 0;
    double way = 0;
    double released0 = 0;  ///< released velocity of the start
    bool braked = false;   ///< a brake led to it: it is the limit exactly, v0 and a0 have the brake's rounding errors
    FrameLimits limits;

    [[nodiscard]] Problem mirrored() const noexcept { return {-v0, -a0, -v1, -a1, -way, -released0, braked, limits.mirrored()}; }
    [[nodiscard]] Problem reversed() const noexcept {
        const FrameLimits l = limits.reversed();
        return {-v1, a1, -v0, a0, -way, released_velocity(-v1, a1, l), false, l};
    }
};

}  // namespace taktwerk::axes
