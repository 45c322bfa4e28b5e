#pragma once
// The machine as JSON text, for pages, the command line and scripts: names with the values, alarms in words. Not real-time.

#include <cstdint>
#include <string>
#include <string_view>

#include "hmi_bridge/machine_link.hpp"
#include "hmi_bridge/state/whole_state.hpp"

namespace taktwerk::hmi {

/// What `state` answers, of what the machine has filled or LCM has brought: {"cycle":...,"axes":[{"name":"x",...}],"alarms":[...],...}.
[[nodiscard]] std::string state_json(const whole_state_v5_t& state);
/// The same of one snapshot. `who`: a client's name, for what people hold.
[[nodiscard]] std::string state_json(
    const runtime::Snapshot& snapshot, const MachineLink& machine,
    const NameOfClient& who = [](std::uint32_t) { return std::string_view{}; });
/// Those of the bus and its slaves alone, and its numbers (`bus` of the state).
[[nodiscard]] std::string bus_alarms_json(const runtime::Snapshot& snapshot, const MachineLink& machine);
[[nodiscard]] std::string bus_statistics_json(const runtime::Snapshot& snapshot);
/// Only the alarms, an array.
[[nodiscard]] std::string alarms_json(const runtime::Snapshot& snapshot, const MachineLink& machine);

}  // namespace taktwerk::hmi
