#pragma once
// `kinematics:` of a group as it is written. Includes Eigen, which is slow to compile.

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "axes/kinematics/description.hpp"

namespace taktwerk::config {

/// How one member counts its joint; in the axis' own unit.
struct JointEntry {
    std::string axis;
    bool reversed = false;
    double zero = 0;
    std::optional<std::pair<double, double>> limits;
};

/// Exactly one of them is written.
struct ArmEntry {
    std::optional<axes::ArmDescription> arm;
    std::array<double, 3> base{};  ///< in the group's unit
    std::array<double, 3> tilt{};  ///< rad: turns about X, Y, Z of the machine's, as RX RY RZ
    std::vector<JointEntry> joints;
};

}  // namespace taktwerk::config
