#pragma once
// Is there anything for `retain` to keep?

#include <algorithm>

#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// Some axis has a position that is worth keeping over a time without power.
[[nodiscard]] inline bool keeps_positions(const MachineConfig& config) {
    return std::any_of(config.axes.begin(), config.axes.end(),
                       [](const AxisBinding& binding) { return binding.axis.memory.absolute && !binding.axis.disabled; });
}

}  // namespace taktwerk::runtime
