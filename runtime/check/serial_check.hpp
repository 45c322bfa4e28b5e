#pragma once
// Problems of the drives on serial lines; check() asks for them.

#include <vector>

#include "core/result.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// Names that do not meet, stations given twice, lines without supervision, axes that cannot work over a line.
void check_serial(const MachineConfig& config, std::vector<Error>& errors);

}  // namespace taktwerk::runtime
