#pragma once
// Mixtures of two motions of the same duration between the same ends: inside every limit that both keep, since limits on
// velocity, acceleration and jerk are convex. Internal to the planner.

#include "axes/planner/extremal.hpp"

namespace taktwerk::axes {

/// A motion that begins with velocity v0, gone from its beginning to its end.
struct Walked {
    double travel = 0;  ///< signed, u
    double path = 0;    ///< sum of the ways without regard to sign
    double top = 0;     ///< highest speed at the end of a stretch, u/s
};
[[nodiscard]] Walked walk(double v0, const Motion& motion) noexcept;

/// Both motions move in one and the same direction all the time.
[[nodiscard]] bool keeps_direction(double v0, const Motion& a, const Motion& b) noexcept;

/// (1 - share) of `a` and `share` of `b`, 0 <= share <= 1: at most thirteen stretches for two of seven.
[[nodiscard]] Motion mixture(const Motion& a, const Motion& b, double share) noexcept;

}  // namespace taktwerk::axes
