#pragma once
// Status word and control word of CiA 402: pure functions, so that the tables of the manuals can be checked against them.
// Source: CiA 402-2; SV33-E manual 3.4.1, SE-808X manual 3.2.2. Real-time safe.

#include <cstdint>

#include "axes/port/drive_port.hpp"

namespace taktwerk::axes::cia402 {

// Control word commands (the bits that matter; see each manual's table of commands).
inline constexpr std::uint16_t disable_voltage = 0x0000;
inline constexpr std::uint16_t shutdown = 0x0006;
inline constexpr std::uint16_t switch_on = 0x0007;  ///< also Disable Operation
inline constexpr std::uint16_t enable_operation = 0x000F;
inline constexpr std::uint16_t quick_stop = 0x0002;
inline constexpr std::uint16_t fault_reset = 0x0080;
inline constexpr std::uint16_t homing_start = 0x0010;  ///< bit 4 in homing mode
inline constexpr std::uint16_t halt = 0x0100;

// Status word bits that every manual gives the same meaning.
inline constexpr std::uint16_t bit_fault = 1u << 3;
inline constexpr std::uint16_t bit_voltage = 1u << 4;
inline constexpr std::uint16_t bit_warning = 1u << 7;
inline constexpr std::uint16_t bit_clock = 1u << 8;  ///< where the drive has it: its clock follows SYNC0
inline constexpr std::uint16_t bit_target_reached = 1u << 10;
inline constexpr std::uint16_t bit_internal_limit = 1u << 11;
inline constexpr std::uint16_t bit_follows_target = 1u << 12;  ///< cyclic modes; SE-808X and SV-DA200 leave it open
inline constexpr std::uint16_t bit_homing_attained = 1u << 12;
inline constexpr std::uint16_t bit_homing_error = 1u << 13;

/// Power state of a status word. A pattern that fits no row is `unknown` (TSVM 02B6h is one): the caller stops safely.
/// `fault_low_nibble_f`: the quirk of drives whose Fault reads like Fault Reaction.
[[nodiscard]] constexpr PowerState power_state(std::uint16_t status, bool fault_low_nibble_f) noexcept {
    switch (status & 0x4Fu) {
        case 0x00: return PowerState::not_ready;
        case 0x40: return PowerState::disabled;
        case 0x08: return PowerState::fault;
        case 0x0F: return fault_low_nibble_f ? PowerState::fault : PowerState::fault_reaction;
        default: break;
    }
    switch (status & 0x6Fu) {
        case 0x21: return PowerState::ready;
        case 0x23: return PowerState::switched_on;
        case 0x27: return PowerState::enabled;
        case 0x07: return PowerState::quick_stop;
        default: return PowerState::unknown;
    }
}

/// CSP, CSV, CST: a new set-point each bus cycle.
[[nodiscard]] constexpr bool is_cyclic(DriveMode mode) noexcept {
    return mode == DriveMode::cyclic_position || mode == DriveMode::cyclic_velocity || mode == DriveMode::cyclic_torque;
}

/// An object of a further axis, from that of the first: `offset` beyond it. Below 2000h they belong to the communication, not to an axis.
[[nodiscard]] constexpr std::uint16_t object_of_axis(std::uint16_t index, std::uint16_t offset) noexcept {
    return index < 0x2000 ? index : static_cast<std::uint16_t>(index + offset);
}

/// 6060h / 6061h value of a mode, and back; 0 / none where there is none.
[[nodiscard]] constexpr std::int8_t mode_code(DriveMode mode) noexcept {
    switch (mode) {
        case DriveMode::profile_position: return 1;
        case DriveMode::profile_velocity: return 3;
        case DriveMode::profile_torque: return 4;
        case DriveMode::homing: return 6;
        case DriveMode::cyclic_position: return 8;
        case DriveMode::cyclic_velocity: return 9;
        case DriveMode::cyclic_torque: return 10;
        case DriveMode::none: break;
    }
    return 0;
}
[[nodiscard]] constexpr DriveMode mode_of(std::int64_t code) noexcept {
    switch (code) {
        case 1: return DriveMode::profile_position;
        case 3: return DriveMode::profile_velocity;
        case 4: return DriveMode::profile_torque;
        case 6: return DriveMode::homing;
        case 8: return DriveMode::cyclic_position;
        case 9: return DriveMode::cyclic_velocity;
        case 10: return DriveMode::cyclic_torque;
        default: return DriveMode::none;
    }
}

/// The next step towards `enabled` (6 - 7 - 15). `may_enable` holds the last step back until mode and target agree.
[[nodiscard]] constexpr std::uint16_t towards_enabled(PowerState state, bool may_enable) noexcept {
    switch (state) {
        case PowerState::disabled: return shutdown;
        case PowerState::ready: return switch_on;
        case PowerState::switched_on: return may_enable ? enable_operation : switch_on;
        case PowerState::enabled: return enable_operation;
        default: return disable_voltage;
    }
}

/// The next step down. Stepwise (15 - 7 - 6 - 0), because Disable Voltage from Operation Enabled lets some drives coast
/// (SV33-E 3.4.1 transitions 8 and 9).
[[nodiscard]] constexpr std::uint16_t towards_off(PowerState state) noexcept {
    switch (state) {
        case PowerState::enabled: return switch_on;
        case PowerState::switched_on: return shutdown;
        default: return disable_voltage;
    }
}

}  // namespace taktwerk::axes::cia402
