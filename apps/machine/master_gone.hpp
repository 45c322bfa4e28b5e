#pragma once
// What each drive does alone when the master is gone (process killed, computer dead, cable cut): read off the configuration, in
// words, so that somebody can decide whether that is enough. Nothing of it is a safety function.

#include <string>
#include <vector>

#include "runtime/machine_config.hpp"

namespace taktwerk::apps {

/// Sentences for one axis: watchdog, then the drive's reaction objects as the start-up list or the drive's defaults have them.
[[nodiscard]] std::vector<std::string> master_gone(const runtime::MachineConfig& config, const runtime::AxisBinding& axis);

}  // namespace taktwerk::apps
