#pragma once
// What can be said of the programs of a machine without building it.

#include <vector>

#include "core/result.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// Loads the programs and lets them declare: libraries that cannot be loaded, names that the machine does not have, parameters out of range.
/// The machine need not be sound. Codes: program....
[[nodiscard]] std::vector<Error> check_programs(const MachineConfig& config);

}  // namespace taktwerk::runtime
