#pragma once
// What a path may take of an axis. Real-time safe.

namespace taktwerk::axes {

class Axis;

/// u/s, u/s2, u/s3, the same in both directions; u where its software limits hold, else infinite.
struct MemberLimits {
    double velocity = 0, acceleration = 0, jerk = 0;
    double low = 0, high = 0;
    double speeding = 0, braking = 0;  ///< u/s2, of a jog in ACS: `acceleration` is the greater of both
};

/// Of its configuration; without a jerk limit the one that a path keeps in its place.
[[nodiscard]] MemberLimits path_limits_of(const Axis& axis) noexcept;

}  // namespace taktwerk::axes
