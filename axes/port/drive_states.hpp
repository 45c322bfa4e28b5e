#pragma once
// Modes and power states of CiA 402 by their meaning, for drives with and without a status word.

#include <cstdint>
#include <string_view>

namespace taktwerk::axes {

/// CiA 402 6060h by meaning; a drive without a status word (XP200) maps its own modes to these.
enum class DriveMode : std::uint8_t {
    none,
    profile_position,
    profile_velocity,
    profile_torque,
    homing,
    cyclic_position,
    cyclic_velocity,
    cyclic_torque,
};
[[nodiscard]] std::string_view name(DriveMode mode) noexcept;

/// CiA 402 power state by meaning. `unknown`: a status word that fits no state; treated like a fault (never "keep the last").
enum class PowerState : std::uint8_t {
    unknown,
    not_ready,
    disabled,
    ready,
    switched_on,
    enabled,
    quick_stop,
    fault_reaction,
    fault,
};
[[nodiscard]] std::string_view name(PowerState state) noexcept;

}  // namespace taktwerk::axes
