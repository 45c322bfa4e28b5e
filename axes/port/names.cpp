#include "axes/port/drive_port.hpp"

namespace taktwerk::axes {

std::string_view name(DriveMode mode) noexcept {
    switch (mode) {
        case DriveMode::none: return "none";
        case DriveMode::profile_position: return "profile position";
        case DriveMode::profile_velocity: return "profile velocity";
        case DriveMode::profile_torque: return "profile torque";
        case DriveMode::homing: return "homing";
        case DriveMode::cyclic_position: return "cyclic position";
        case DriveMode::cyclic_velocity: return "cyclic velocity";
        case DriveMode::cyclic_torque: return "cyclic torque";
    }
    return "?";
}

std::string_view name(PowerState state) noexcept {
    switch (state) {
        case PowerState::unknown: return "unknown";
        case PowerState::not_ready: return "not ready";
        case PowerState::disabled: return "switch-on disabled";
        case PowerState::ready: return "ready to switch on";
        case PowerState::switched_on: return "switched on";
        case PowerState::enabled: return "operation enabled";
        case PowerState::quick_stop: return "quick stop";
        case PowerState::fault_reaction: return "fault reaction";
        case PowerState::fault: return "fault";
    }
    return "?";
}

}  // namespace taktwerk::axes
