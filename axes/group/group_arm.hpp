#pragma once
// Of a group's arm, for who does without Eigen.

#include <array>

namespace taktwerk::axes {

class Kinematics;

/// Which of X Y Z RX RY RZ it commands, in its own base.
[[nodiscard]] std::array<bool, 6> commands_of(const Kinematics& arm) noexcept;

}  // namespace taktwerk::axes
