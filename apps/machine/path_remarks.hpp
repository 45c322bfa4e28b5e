#pragma once
// Programs in G-code that a machine file names, read through: one that a group would refuse is found before somebody waits for its workpiece.

#include <span>
#include <vector>

#include "core/result.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::apps {

/// Of each path the first fault, by its options (tools, offsets, units) and with nothing left out. The machine runs all the same: MC_PathSelect refuses the path.
/// Code: that of the fault; subject: file:line:column.
[[nodiscard]] std::vector<Error> path_remarks(std::span<const runtime::PathConfig> paths);

}  // namespace taktwerk::apps
