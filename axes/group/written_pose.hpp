#pragma once
// A pose of numbers as people write them, without Eigen for who includes this.

#include <array>

#include "axes/pose.hpp"

namespace taktwerk::axes {

/// RX RY RZ as MC_CART_REF has them: turned about Z, then about the new Y, then about the new X; rad.
[[nodiscard]] Pose pose_of_turns(const std::array<double, 3>& place, const std::array<double, 3>& turns) noexcept;

}  // namespace taktwerk::axes
