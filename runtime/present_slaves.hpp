#pragma once
// Which of the configured slaves are on the cable: for the machine that drives them and the world that plays them.

#include <vector>

#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// A slave whose axes are all `simulated: true` is not there yet (commissioning one axis at a time): the cable goes past it, and
/// the positions of those behind it count without it.
[[nodiscard]] std::vector<ecat::SlaveConfig> present_slaves(const MachineConfig& config);

}  // namespace taktwerk::runtime
