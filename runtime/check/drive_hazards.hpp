#pragma once
// What the drives' manuals warn of and this machine does not take care of. For `taktwerk check`; not real-time.

#include <string>
#include <vector>

#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

struct AxisHazard {
    std::string axis;
    const axes::DriveHazard* hazard = nullptr;  ///< in the profile of the axis' binding
};

/// How the machine uses the drive of this axis: start-up SDOs (those of the homing included), mapped objects.
[[nodiscard]] axes::DriveUse use_of_drive(const MachineConfig& config, const AxisBinding& axis);

/// By axis, in the order of the configuration. Virtual axes and those that are left out have none.
[[nodiscard]] std::vector<AxisHazard> drive_hazards(const MachineConfig& config);

}  // namespace taktwerk::runtime
