#pragma once
// Where something is and how it stands in space: what paths, kinematics and groups hand to each other. Plain data, so that it goes through
// rings, views and pins as bytes; the arithmetic of it is axes/pose_math.hpp.

#include <array>

namespace taktwerk::axes {

/// The same as people write it: X Y Z, then RX RY RZ in rad: turned about Z by RZ, then about the new Y by RY, then about the new X by RX (G-078 of
/// docs/motion/group-decisions.md).
using SixNumbers = std::array<double, 6>;

/// A frame seen from another one: its origin and the rotation of its axes. Right-handed.
struct Pose {
    std::array<double, 3> position{};               ///< x, y, z in the machine's unit of length
    std::array<double, 4> orientation{1, 0, 0, 0};  ///< unit quaternion w, x, y, z; q and -q are the same orientation

    friend bool operator==(const Pose&, const Pose&) = default;
};

}  // namespace taktwerk::axes
