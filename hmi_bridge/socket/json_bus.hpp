#pragma once
// The bus as a tree of slaves, for people: who stands where, how their cables do, what the trouble is. Not real-time.

#include <string>

#include "ecat/diagnosis/survey.hpp"
#include "ecat/master.hpp"
#include "hmi_bridge/machine_link.hpp"

namespace taktwerk::hmi {

/// `survey`: of the bus of `master`, as it was seen last. `snapshot`: nullptr before the first cycle.
[[nodiscard]] std::string bus_json(ecat::Master& master, const ecat::Survey& survey, const runtime::Snapshot* snapshot,
                                   const MachineLink& machine);

}  // namespace taktwerk::hmi
