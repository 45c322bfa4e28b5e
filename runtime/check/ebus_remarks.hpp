#pragma once
// Whether the couplers of a bus can feed the terminals behind them. Not real-time.

#include <vector>

#include "core/result.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// At the first terminal behind a coupler (or a feed terminal) whose current is used up. Devices whose current is not known count as 0.
/// Subjects name the slave ("bus.slaves.7"), the code is remark.ebus.
[[nodiscard]] std::vector<Error> ebus_remarks(const MachineConfig& config);

}  // namespace taktwerk::runtime
