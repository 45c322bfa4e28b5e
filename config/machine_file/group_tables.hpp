#pragma once
// `groups:` of a machine file: which axes move together, and the arm that they are.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "axes/group/group_config.hpp"
#include "config/reading/field_table.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::config {

struct ArmEntry;  ///< group_arm.hpp, which includes Eigen: only group_tables.cpp needs it

/// A tool or a payload as it is written, by the name that only the file and its messages know.
struct CarriedEntry {
    std::string name;
    std::uint8_t number = 0;
    axes::SixNumbers frame{};  ///< of a tool
    axes::RigidBody body{};
};

struct GroupEntry {
    axes::AxisGroupConfig group;          ///< without kinematics
    std::string unit = "mm";              ///< of lengths and paths
    std::shared_ptr<const ArmEntry> arm;  ///< none: axes alone
    std::vector<CarriedEntry> tools, payloads;
    std::string tool, payload;  ///< names of those that are selected at the beginning; empty: none
};

/// Errors of the names in it: config.group_member (an axis twice), config.group_joint (of no member).
[[nodiscard]] Table<GroupEntry> group_table();

/// The group as the machine has it. `units`: of the axes, by name. Errors with their place: config.group_unit, config.group_arm, and those of Kinematics::make; of equip().
[[nodiscard]] axes::AxisGroupConfig made_of(Reader& reader, const GroupEntry& entry,
                                            const std::map<std::string, std::string, std::less<>>& units);

/// Once the axes are known. Error: config.group_joint (limits of a joint that its axis never reaches).
void check_travel(Reader& reader, const GroupEntry& entry, const std::vector<runtime::AxisBinding>& axes);

}  // namespace taktwerk::config
