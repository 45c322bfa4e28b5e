#pragma once
// What people see of one cycle, with names and words: the snapshot as the local socket and LCM tell it. Service side, not real-time.

#include <cstdint>
#include <functional>
#include <string_view>

#include "hmi_bridge/machine_link.hpp"
#include "taktwerk_lcm/whole_alarm_v1_t.hpp"
#include "taktwerk_lcm/whole_bus_v1_t.hpp"
#include "taktwerk_lcm/whole_group_v3_t.hpp"
#include "taktwerk_lcm/whole_state_v5_t.hpp"

namespace taktwerk::hmi {

using taktwerk_lcm::whole_alarm_v1_t;
using taktwerk_lcm::whole_axis_v1_t;
using taktwerk_lcm::whole_bus_v1_t;
using taktwerk_lcm::whole_event_v2_t;
using taktwerk_lcm::whole_group_v3_t;
using taktwerk_lcm::whole_state_v5_t;

/// A client's name, for what people hold.
using NameOfClient = std::function<std::string_view(std::uint32_t client)>;

/// Everything but what belongs to the message (time, counts, check). `out` keeps its memory from one call to the next.
void fill(whole_state_v5_t& out, const runtime::Snapshot& snapshot, const MachineLink& machine, const NameOfClient& who);
void fill(whole_bus_v1_t& out, const runtime::Snapshot& snapshot);
void fill(whole_axis_v1_t& out, const runtime::Snapshot& snapshot, const runtime::MachineLayout& layout, std::size_t axis);
void fill(whole_group_v3_t& out, const runtime::Snapshot& snapshot, const runtime::MachineLayout& layout, std::size_t group);
void fill(whole_alarm_v1_t& out, const runtime::ActiveAlarm& alarm, const MachineLink& machine);
void fill(whole_event_v2_t& out, const runtime::CommandEvent& event, const runtime::MachineLayout& layout);

}  // namespace taktwerk::hmi
