#pragma once
// Points that nobody may force, and why: what the emergency stop, the restart and drives read, and what holds a load or a drive. Not real-time.

#include <string>
#include <vector>

#include "runtime/machine_config.hpp"
#include "runtime/tasks/io_image.hpp"

namespace taktwerk::runtime {

/// By index, as the image has them. Empty: may be forced.
struct KeptPoints {
    std::vector<std::string> inputs, outputs;
};

[[nodiscard]] KeptPoints kept_points(const MachineConfig& config, const IoImage& io);

}  // namespace taktwerk::runtime
