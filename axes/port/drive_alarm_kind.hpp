#pragma once
// What an alarm of a drive means, whatever its number: so that axis, simulator and messages can tell kinds apart without
// knowing a vendor.

#include <cstdint>

namespace taktwerk::axes {

enum class DriveAlarmKind : std::uint8_t {
    other,
    overspeed,
    following_error,  ///< the drive's own check (6065h)
    setpoint_leap,    ///< a cyclic target stepped too far
    undervoltage,     ///< main power
    overload,
    encoder,
    communication,  ///< the bus or line fell silent
    sync_lost,      ///< SYNC0 no longer comes
    negative_limit,
    positive_limit,
    emergency_stop,  ///< an input of the drive
    battery_low,     ///< of the encoder; the position still holds
    reference_lost,  ///< turns or zero are gone: home again
    turn_overflow,
    homing_timeout,       ///< the drive's own homing took too long (SV33-E A.425)
    homing_limit,         ///< the drive's own homing met a limit switch that it did not look for (SV-DA200 Er25-6)
    homing_method,        ///< the drive does not know the homing method (SV33-E A.D35, SV-DA200 Er05-4)
    mode_change,          ///< a change of mode that the drive does not take
    power_cycle_pending,  ///< a parameter takes effect after a restart only
    mode_not_set,         ///< enabled without a mode of operation (TSVM 43)
    left_operational,     ///< the bus left OP while the drive was enabled (TSVM 44)
    link_changed,         ///< a network port lost or found its link (TSVM 92)
    torque_overload,      ///< more torque than the user allows, for too long (TSVM 29)
    parameter_storage,    ///< the EEPROM is written too often
    cycle_setting,        ///< the bus cycle is none that the drive takes
    limits_crossed,       ///< software limits: minimum not below maximum
    home_outside_limits,  ///< the home offset lies outside the software limits
    start_too_fast,       ///< enabled while the motor turns
    enabled_twice,        ///< enabled from the bus and by the drive's own input
    phase_lost,           ///< of the mains
    phase_warning,        ///< the same as a warning (SV33-E A.222)
    safe_torque_off,
    stall,
    overvoltage,  ///< of the supply
};

}  // namespace taktwerk::axes
