#pragma once
// The numbers of the conditions that an axis announces; their words are in alarms.hpp.

#include <cstddef>

#include "core/alarm.hpp"

namespace taktwerk::axes {

enum class AxisAlarm : AlarmId {
    following_error = 0x3001,
    drive_fault = 0x3002,
    drive_power_lost = 0x3003,
    axis_feedback_lost = 0x3004,
    enable_timeout = 0x3005,
    software_limit_reached = 0x3006,
    negative_limit_switch = 0x3007,
    positive_limit_switch = 0x3008,
    homing_failed = 0x3009,
    homing_timeout = 0x300A,
    jog_lease_expired = 0x300B,
    drive_unknown_state = 0x300C,
    drive_mode_mismatch = 0x300D,
    drive_warning = 0x300E,
    emergency_stop = 0x300F,
    stopped_by_machine = 0x3010,
    planner_refused = 0x3011,
    master_lost = 0x3012,
    moved_while_off = 0x3013,
    retained_gearing_differs = 0x3014,
    drive_homing_failed = 0x3015,
    drive_homing_timeout = 0x3016,
    drive_homing_refused = 0x3017,
    reference_lost = 0x3018,
    drive_setup_refused = 0x3019,
    drive_too_fast = 0x301A,
    coupling_start_passed = 0x301B,
    both_limit_switches = 0x301C,
    motor_turns = 0x301D,
    gantry_skew_warning = 0x301E,
    gantry_skew = 0x301F,
    gantry_side_lost = 0x3020,
    load_deviation = 0x3021,
    encoder_invalid = 0x3022,
    drive_polarity = 0x3023,
    encoder_lost = 0x3024,
    amplifier_fault = 0x3025,
    drive_not_ready = 0x3026,
};
inline constexpr std::size_t axis_alarm_count = 38;

[[nodiscard]] constexpr AlarmId id(AxisAlarm alarm) noexcept { return static_cast<AlarmId>(alarm); }

}  // namespace taktwerk::axes
