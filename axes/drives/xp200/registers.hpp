#pragma once
// Numbers of the XP200 by name: parameters, status registers, functions of its inputs and outputs. Sections are those of its user manual V1.0.
// Range, factory value and unit of each parameter stand in config/drives/xp200.objects.yaml.

#include <cstdint>

namespace taktwerk::axes::xp200 {

/// The address of a parameter is its number, decimal (9.4).
namespace pr {
inline constexpr std::uint16_t password = 0, control_mode = 4, speed_gain = 5, speed_integral = 6, position_gain = 9, speed_source = 25,
                               torque_source = 26, gear_numerator = 29, gear_denominator = 30, acceleration_time = 60,
                               deceleration_time = 61, stop_time = 63, torque_limit_ccw = 65, torque_limit_cw = 66, external_limit_ccw = 67,
                               external_limit_cw = 68, overload_ccw = 70, overload_cw = 71, overload_time = 72, highest_speed = 75,
                               torque_speed_limit = 78, torque_speed_slope = 79, deviation_limit = 80, encoder_lines = 82, limit_use = 97,
                               forced_enable = 98, motor_series = 99, motor_code = 2, input_function = 100, output_function = 108,
                               force_1 = 120, force_2 = 121, force_3 = 122, force_4 = 123, force_5 = 124, input_filter = 125,
                               stop_mode = 136, speed_1 = 137, torque_1 = 145, in_position = 150, in_position_hysteresis = 151,
                               near_range = 152, near_hysteresis = 153, reached_speed = 154, reached_speed_hysteresis = 155,
                               reached_torque = 157, reached_torque_hysteresis = 158, zero_speed = 160, zero_speed_hysteresis = 161,
                               zero_clamp = 162, emergency_mode = 164, standstill_speed = 165, brake_hold = 166, brake_wait = 167,
                               brake_speed = 168, brake_release = 169, station = 181, baud = 182, format = 183;
}
inline constexpr std::uint16_t parameter_count = 250;  ///< addresses 0 to 249 (9.4)
inline constexpr int input_count = 6, output_count = 4;

/// Status, function 04h; by 03h at 1000h higher (9.5). Of two words the low one comes first.
namespace status {
inline constexpr std::uint16_t speed = 0x00, raw_command = 0x01, command = 0x03, position = 0x05, deviation = 0x07, torque = 0x09,
                               peak_torque = 0x0A, current = 0x0B, peak_current = 0x0C, pulse_frequency = 0x0D, speed_command = 0x0E,
                               torque_command = 0x0F, inputs = 0x12, outputs = 0x13, single_turn = 0x14, multi_turn = 0x16,
                               brake_load = 0x17, average_load = 0x18, output_voltage = 0x19, alarm = 0x1A, fine_speed = 0x1B,
                               absolute = 0x1F;
inline constexpr std::uint16_t count = 0x28, by_parameters = 0x1000;
}  // namespace status

/// Functions of inputs (5.2); a negative number in Pr100 to Pr105 inverts.
enum class Input : std::uint8_t {
    none,
    servo_on,
    alarm_clear,
    ccw_allowed,
    cw_allowed,
    ccw_torque_limit,
    cw_torque_limit,
    zero_clamp,
    zero_command,
    invert,
    speed_1,
    speed_2,
    speed_3,
    torque_1,
    torque_2,
    emergency,
    mode,
    gain,
    gear_1,
    gear_2,
    clear_deviation,
    inhibit_pulses,
};
inline constexpr int input_functions = 22;

/// Functions of outputs (5.3); a negative number in Pr108 to Pr111 inverts.
enum class Output : std::uint8_t {
    off,
    on,
    ready,
    no_alarm,
    zero_speed,
    in_position,
    at_speed,
    at_torque,
    brake_released,
    running,
    near_position,
    torque_limited,
    speed_limited,
};
inline constexpr int output_functions = 13;

/// Digits of the words that force inputs on, as decimal numbers (5.4.2 Pr120 to Pr124).
namespace force {
inline constexpr std::uint16_t zero_clamp = 100, zero_command = 1000;                         // Pr121
inline constexpr std::uint16_t speed_2 = 1, speed_3 = 10, torque_2 = 1000, torque_3 = 10000;  // Pr122: SP1, SP2; TRQ1, TRQ2
inline constexpr std::uint16_t emergency = 1, mode = 10;                                      // Pr123: EMG, CMODE
}  // namespace force

}  // namespace taktwerk::axes::xp200
