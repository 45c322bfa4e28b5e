#pragma once
// Problems of the axes of a machine, each against its drive, its slave and the machine; check() asks for them.

#include "runtime/check/problems.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

void check_axes(const MachineConfig& config, std::vector<Error>& errors);

}  // namespace taktwerk::runtime
