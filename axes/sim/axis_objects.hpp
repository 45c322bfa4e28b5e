#pragma once
// The objects of one simulated axis as plain numbers: what the master writes and what the drive answers.

#include <array>
#include <cstddef>
#include <cstdint>

#include "axes/sim/homing_run.hpp"

namespace taktwerk::axes::sim {

inline constexpr std::size_t most_stop_options = 8;

/// When 607Dh counts: SV33-E P05.43.
enum class SoftwareLimits : std::uint8_t { off, on, after_homing };
/// Objects that the master writes.
struct AxisInputs {
    std::uint16_t control = 0;
    std::int64_t mode = 0;
    std::int64_t target_position = 0, target_velocity = 0, target_torque = 0;
    std::int64_t velocity_offset = 0, torque_offset = 0;
    std::int64_t maximum_velocity = 0;  ///< 607Fh: bounds the speed in the torque modes; 0 = no limit
    static constexpr std::int64_t no_limit = -1;
    std::int64_t torque_limit = no_limit, torque_limit_positive = no_limit, torque_limit_negative = no_limit;  ///< 6072h, 60E0h, 60E1h
    HomingSettings homing;
    std::int64_t home_offset = 0;
    std::int64_t home_position_method = 0;  ///< 60E6h: 0 the reference gets 607Ch, 1 it gets its old position + 607Ch
    std::uint16_t probe_function = 0;
    std::int64_t maximum_motor_speed = 0;                                                   ///< 6080h, r/min: bounds it too; 0 = no limit
    std::int64_t profile_velocity = 0, profile_acceleration = 0, profile_deceleration = 0;  ///< 6081h, 6083h, 6084h
    std::int64_t quick_stop_deceleration = 0;                                               ///< 6085h
    std::int64_t torque_slope = -1;                                                         ///< 6087h, per s; -1: no such object, at once
    std::int64_t position_window = -1, position_window_time = 0;                            ///< 6067h, 6068h ms; -1: no such object
    std::int64_t velocity_window = -1, velocity_window_time = 0;                            ///< 606Dh, 606Eh ms
    std::int64_t emergency_torque = 0;                          ///< of StopBy::emergency_torque; 0 = all there is
    std::array<std::int64_t, most_stop_options> stop_values{};  ///< of DriveStops::options, in their order
    std::int64_t following_error_window = 0;                    ///< 6065h; 0: as the motor says, FFFFFFFFh: no check
    std::int64_t software_minimum = 0, software_maximum = 0;
    SoftwareLimits software_limits = SoftwareLimits::off;
};

/// Objects that the drive answers.
struct AxisOutputs {
    std::uint16_t status = 0;
    std::int64_t mode = 0;
    std::int64_t position = 0, velocity = 0, torque = 0, following_error = 0, demand = 0;
    std::uint16_t error_code = 0;
    std::uint32_t error_detail = 0;
    std::uint32_t digital_inputs = 0;
    std::uint16_t probe_status = 0;
    std::int64_t probe_rising[2] = {}, probe_falling[2] = {};
};

}  // namespace taktwerk::axes::sim
