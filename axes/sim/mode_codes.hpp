#pragma once
// Values of 6060h and 6061h. Source: CiA 402-2.

#include <cstdint>

namespace taktwerk::axes::sim::mode {

inline constexpr std::int64_t none = 0, profile_position = 1, profile_velocity = 3, profile_torque = 4, homing = 6, cyclic_position = 8,
                              cyclic_velocity = 9, cyclic_torque = 10;

[[nodiscard]] constexpr bool of_torque(std::int64_t mode) noexcept { return mode == profile_torque || mode == cyclic_torque; }
[[nodiscard]] constexpr bool of_velocity(std::int64_t mode) noexcept { return mode == profile_velocity || mode == cyclic_velocity; }
[[nodiscard]] constexpr bool cyclic(std::int64_t mode) noexcept {
    return mode == cyclic_position || mode == cyclic_velocity || mode == cyclic_torque;
}

}  // namespace taktwerk::axes::sim::mode
