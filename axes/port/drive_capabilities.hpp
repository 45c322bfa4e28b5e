#pragma once
// What a drive can do, as its port says it once: an axis asks nothing beyond it.

#include <cstdint>
#include <limits>

#include "axes/port/drive_states.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

/// How set-points get through.
enum class SetpointClass : std::uint8_t {
    cyclic,        ///< a new set-point each bus cycle (CSP, CSV, CST)
    low_dynamics,  ///< speed steps at the pace of a poll schedule; no interpolation, no coupling (XP200)
};

/// Rare, guarded actions of a drive that no cycle asks for by itself.
enum class DriveService : std::uint8_t {
    clear_multi_turn,    ///< the encoder forgets its turns: the axis is unreferenced afterwards (TSVM bit 12, SV33-E P20.05, XP200: none)
    save_parameters,     ///< into the EEPROM (SE-808X 1010h, XP200 FC41H); the drive may be silent for seconds
    restore_parameters,  ///< to factory values
    restart,             ///< the drive's own soft restart, where it has one
};

struct DriveCapabilities {
    std::uint16_t modes = 0;  ///< bit per DriveMode
    SetpointClass setpoints = SetpointClass::cyclic;
    bool velocity_feed_forward = false;  ///< 60B1h mapped
    bool torque_feed_forward = false;    ///< 60B2h mapped
    bool torque_limits = false;          ///< 6072h or 60E0h/60E1h mapped: they hold from the next exchange on
    bool digital_inputs = false;         ///< limits and home are reported (60FDh)
    bool digital_outputs = false;        ///< 60FEh mapped
    std::uint8_t probes = 0;             ///< touch probes with hardware latch
    std::uint8_t probe_edges = 0b1111;   ///< whose latched position is exchanged: bit 2 * probe rising, bit 2 * probe + 1 falling
    bool drive_homing = false;
    bool motor_has_encoder = true;  ///< false: "actual" is the command (open-loop stepper)
    bool absolute_encoder = false;
    std::uint8_t position_bits = 32;                                  ///< width of the raw position before unwrapping
    double rated_velocity = std::numeric_limits<double>::infinity();  ///< counts/s the drive can follow; infinity = not stated
    Duration minimum_cycle{};
    Duration enable_delay{};       ///< motion must wait this long after `enabled` (brake, servo-on dwell)
    Duration mode_change_delay{};  ///< set-points must wait this long after the mode is confirmed
    bool mode_change_at_standstill = false;
    Duration feedback_period{};  ///< 0 = every bus cycle; else the poll period
    // What the later drives need beyond it; a port that says nothing has none of it.
    bool velocity_limit = false;     ///< 607Fh mapped (or Pr078): speed limit in torque modes
    bool reports_following = false;  ///< DriveFeedback::follows_target means something
    bool homing_per_run = false;     ///< DriveCommand::homing is obeyed; else the start-up values hold
    std::uint8_t profile_buffer =
        0;                         ///< set-points the drive takes ahead in profile position mode (SV33-E 1, SV-DA200 8); 0: mode not served
    bool profile_replaces = true;  ///< ProfileSetpoint::immediately abandons the running set-point (SE-808X goes on after it, sheet 4.1)
    std::uint8_t services = 0;     ///< bit per DriveService
    bool torque_limits_written = false;       ///< they are not mapped, but the drive has them: DriveFeedback says when it has taken them
    bool torque_limit_per_direction = false;  ///< 60E0h and 60E1h; false: 6072h alone, one limit for both directions
    bool brake = false;                       ///< its holding brake is worked by DriveCommand::brake (60FEh)
    double velocity_step = 0;    ///< counts/s between two velocity set-points the drive can tell apart (XP200: 1 r/min); 0 = none
    Duration command_latency{};  ///< worst time from encode() to effect beyond setpoint_effective() (a slow line); 0 = none

    [[nodiscard]] constexpr bool has(DriveMode mode) const noexcept { return (modes >> static_cast<unsigned>(mode)) & 1u; }
    [[nodiscard]] constexpr bool has(DriveService service) const noexcept { return (services >> static_cast<unsigned>(service)) & 1u; }
};

}  // namespace taktwerk::axes
