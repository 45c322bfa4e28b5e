#pragma once
// The machine as JSON text, for the command line and scripts: names with the values, alarms in words. Not real-time.

#include <string>

#include "hmi_bridge/machine_link.hpp"

namespace taktwerk::hmi {

/// Values of one snapshot with their names: {"cycle":...,"axes":[{"name":"x",...}],"alarms":[...],...}.
[[nodiscard]] std::string state_json(const runtime::Snapshot& snapshot, const MachineLink& machine);
/// What does not change while the machine runs: names, units, ranges, jogging speeds.
[[nodiscard]] std::string layout_json(const runtime::MachineLayout& layout);
/// Only the alarms, an array.
[[nodiscard]] std::string alarms_json(const runtime::Snapshot& snapshot, const MachineLink& machine);

}  // namespace taktwerk::hmi
