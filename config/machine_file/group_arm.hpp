#pragma once
// `kinematics:` of a group as it is written. Includes Eigen, which is slow to compile.

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "axes/kinematics/description.hpp"
#include "axes/pose.hpp"

namespace taktwerk::config {

/// A joint that moves a motor which is not its own.
struct MovedBy {
    std::string axis;  ///< of the joint
    double ratio = 0;  ///< of the motor's axis for one of the joint's, each in its own unit
};

/// How one member counts its joint; in the axis' own unit.
struct JointEntry {
    std::string axis;
    bool reversed = false;
    double zero = 0;
    std::optional<std::pair<double, double>> limits;
    std::vector<MovedBy> moved_by;
};

/// How the link behind a member's joint differs from the written one; lengths in the group's unit, angles in rad.
struct DeviationEntry {
    std::string axis;
    axes::SixNumbers six{};
};

/// Exactly one of them is written.
struct ArmEntry {
    std::optional<axes::ArmDescription> arm;
    std::array<double, 3> base{};  ///< in the group's unit
    std::array<double, 3> tilt{};  ///< rad: turns about X, Y, Z of the machine's, as RX RY RZ
    std::vector<DeviationEntry> deviations;
    std::vector<JointEntry> joints;
};

}  // namespace taktwerk::config
