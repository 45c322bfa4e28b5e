#pragma once
// `workspace:` and `following_error:` of a group: what it watches of its tool's point.

#include <vector>

#include "config/machine_file/group_tables.hpp"

namespace taktwerk::config {

/// Errors: config.group_room (a room that is neither box nor cylinder).
[[nodiscard]] std::vector<Field<GroupEntry>> workspace_fields();

}  // namespace taktwerk::config
