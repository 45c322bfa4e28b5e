#pragma once
// `groups:` of a machine file: which axes move together, and the arm that they are.

#include <optional>
#include <string>
#include <vector>

#include "axes/group/group_config.hpp"
#include "axes/kinematics/description.hpp"
#include "config/reading/field_table.hpp"

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

struct GroupEntry {
    axes::AxisGroupConfig group;  ///< without kinematics
    std::string unit = "mm";      ///< of lengths and paths
    std::optional<ArmEntry> arm;
};

[[nodiscard]] Table<GroupEntry> group_table();

/// The group as the machine has it. `units`: of the axes, by name. Errors with their place: config.group_unit, config.group_joint, config.group_arm, and
/// those of Kinematics::make.
[[nodiscard]] axes::AxisGroupConfig made_of(Reader& reader, const GroupEntry& entry,
                                            const std::map<std::string, std::string, std::less<>>& units);

}  // namespace taktwerk::config
