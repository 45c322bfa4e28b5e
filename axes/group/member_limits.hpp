#pragma once
// What a path may take of an axis, for who shows it. Real-time safe.

namespace taktwerk::axes {

class Axis;

/// u/s, u/s2, u/s3, the same in both directions.
struct UsableLimits {
    double velocity = 0, acceleration = 0, jerk = 0;
};

/// Of its configuration; without a jerk limit the one that a path keeps in its place.
[[nodiscard]] UsableLimits path_limits_of(const Axis& axis) noexcept;

}  // namespace taktwerk::axes
