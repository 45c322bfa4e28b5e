#pragma once
// How far a start beyond the velocity limit is braked before the way to the target is looked for. Internal to the planner.

#include "axes/planner/brake.hpp"

namespace taktwerk::axes {

/// A brake ends where giving its deceleration back would just end on the limit. From a velocity 10^10 times the limit and more the limit is lost in
/// the rounding of what was braked; there it goes on to the limit itself, where that is no detour: the way that is left must be at least
/// that from (limit, 0) to the end (v1, a1). A target nearer than that is crossed, or met on the way down. Beyond 10^15 nothing else can be
/// told apart. `way`: u from the start to the target.
[[nodiscard]] Brake brake_towards(double v, double a, double v1, double a1, double way, const FrameLimits& limits) noexcept;

}  // namespace taktwerk::axes
