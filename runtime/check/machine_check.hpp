#pragma once
// Problems between the floors of one configuration, before a machine is built of it.

#include <vector>

#include "core/result.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// Cross-floor problems (names that do not exist, two axes on one drive axis, cycle against drive minimum, ...), all of them.
[[nodiscard]] std::vector<Error> check(const MachineConfig& config);

}  // namespace taktwerk::runtime
