#pragma once
// Values of 6060h and 6061h. Source: CiA 402-2.

#include <cstdint>

#include "axes/port/drive_port.hpp"

namespace taktwerk::axes::sim::mode {

inline constexpr std::int64_t none = 0, profile_position = 1, profile_velocity = 3, profile_torque = 4, homing = 6, cyclic_position = 8,
                              cyclic_velocity = 9, cyclic_torque = 10;

[[nodiscard]] constexpr bool of_torque(std::int64_t mode) noexcept { return mode == profile_torque || mode == cyclic_torque; }
[[nodiscard]] constexpr bool of_velocity(std::int64_t mode) noexcept { return mode == profile_velocity || mode == cyclic_velocity; }
[[nodiscard]] constexpr bool cyclic(std::int64_t mode) noexcept {
    return mode == cyclic_position || mode == cyclic_velocity || mode == cyclic_torque;
}
[[nodiscard]] constexpr DriveMode meaning(std::int64_t mode) noexcept {
    switch (mode) {
        case profile_position: return DriveMode::profile_position;
        case profile_velocity: return DriveMode::profile_velocity;
        case profile_torque: return DriveMode::profile_torque;
        case homing: return DriveMode::homing;
        case cyclic_position: return DriveMode::cyclic_position;
        case cyclic_velocity: return DriveMode::cyclic_velocity;
        case cyclic_torque: return DriveMode::cyclic_torque;
        default: return DriveMode::none;
    }
}

}  // namespace taktwerk::axes::sim::mode
