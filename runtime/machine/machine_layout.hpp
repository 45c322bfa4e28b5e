#pragma once
// Names and units that go with the snapshots of a machine.

#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/machine_drives.hpp"
#include "runtime/tasks/program_host.hpp"

namespace taktwerk::runtime {

[[nodiscard]] MachineLayout layout_of(const MachineBody& body, const MachineDrives& drives, const ProgramHost& programs);

}  // namespace taktwerk::runtime
