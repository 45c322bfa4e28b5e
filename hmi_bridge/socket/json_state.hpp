#pragma once
// The machine as JSON text, for the command line and scripts: names with the values, alarms in words. Not real-time.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "hmi_bridge/machine_link.hpp"

namespace taktwerk::hmi {

/// Values of one snapshot with their names: {"cycle":...,"axes":[{"name":"x",...}],"alarms":[...],...}.
/// `who`: a client's name, for what people hold.
[[nodiscard]] std::string state_json(
    const runtime::Snapshot& snapshot, const MachineLink& machine,
    const std::function<std::string_view(std::uint32_t client)>& who = [](std::uint32_t) { return std::string_view{}; });
/// What does not change while the machine runs: names, units, ranges, jogging speeds.
[[nodiscard]] std::string layout_json(const runtime::MachineLayout& layout);
/// Those of the bus and its slaves alone, and its numbers (`bus` of the state).
[[nodiscard]] std::string bus_alarms_json(const runtime::Snapshot& snapshot, const MachineLink& machine);
[[nodiscard]] std::string bus_statistics_json(const runtime::Snapshot& snapshot);
/// Only the alarms, an array.
[[nodiscard]] std::string alarms_json(const runtime::Snapshot& snapshot, const MachineLink& machine);

}  // namespace taktwerk::hmi
