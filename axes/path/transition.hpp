#pragma once
// PLCopen's TransitionMode as a request for a curve. What velocities decide about it is decided from the commanded ones when the move is accepted, so
// that no override changes the path (G-053, G-054). Pure.

#include "axes/path/path.hpp"

namespace taktwerk::axes {

/// mcTMStartVelocity: with factor 1 the curve begins where braking for the corner would, so d = v^2/2a + v a/2j of the slower of the two; smaller
/// factors in proportion. `factor` in [0, 1].
[[nodiscard]] BlendRequest start_velocity_transition(double factor, const PathFeed& before, const PathFeed& behind) noexcept;

/// mcTMConstantVelocity: a curve that can be passed at `factor` of the slower of the two velocities within the slower path acceleration taken
/// as centripetal. `before` and `behind`: unit tangents at the corner.
[[nodiscard]] BlendRequest constant_velocity_transition(double factor, const PathFeed& feed_before, const PathFeed& feed_behind,
                                                        const PathVector& before, const PathVector& behind) noexcept;

}  // namespace taktwerk::axes
