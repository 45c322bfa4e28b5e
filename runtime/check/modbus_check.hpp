#pragma once
// What is wrong with the Modbus TCP devices of a configuration, and with what their points are used for.

#include <vector>

#include "core/result.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

void check_modbus(const MachineConfig& config, std::vector<Error>& errors);

}  // namespace taktwerk::runtime
