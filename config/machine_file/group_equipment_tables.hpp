#pragma once
// `frames:`, `tools:` and `payloads:` of a group.

#include <vector>

#include "config/machine_file/group_tables.hpp"

namespace taktwerk::config {

[[nodiscard]] std::vector<Field<GroupEntry>> equipment_fields();

/// What was read becomes the group's. Errors with their place: config.group_number (two of one number), config.group_selected (a name that is not there),
/// config.group_frames (without kinematics nothing has a frame).
void equip(Reader& reader, const Node& node, GroupEntry& entry);

}  // namespace taktwerk::config
