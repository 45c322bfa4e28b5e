#pragma once
// How a drive brings its motor to rest by itself: CiA 402 option codes 605Ah to 605Eh and what vendors put in their place. Plain data, filled
// from a drive YAML; the simulated drive plays it.

#include <cstdint>
#include <vector>

#include "axes/port/drive_port.hpp"

namespace taktwerk::axes {

/// Where a drive documents no options.
enum class DriveStop : std::uint8_t {
    coast,  ///< power off at once, the motor runs out
    ramp,   ///< decelerates, then power off
};

/// What makes the drive stop.
enum class StopCause : std::uint8_t {
    quick_stop,  ///< control word bit 2 (605Ah)
    off,         ///< power taken away by command, as far as the two below say nothing of it
    shutdown,    ///< Operation enabled -> Ready to switch on (605Bh)
    disable,     ///< Operation enabled -> Switched on (605Ch)
    halt,        ///< control word bit 8 (605Dh)
    fault,       ///< fault reaction (605Eh; SV33-E P04.10, P04.11)
    overtravel,  ///< a limit switch or software limit (SV33-E P04.15)
};

/// How the motor is slowed down.
enum class StopBy : std::uint8_t {
    coast,             ///< no power
    dynamic_brake,     ///< motor phases shorted
    ramp,              ///< 6084h; while homing 609Ah
    quick_ramp,        ///< 6085h
    torque_slope,      ///< the torque goes to 0 by 6087h
    emergency_torque,  ///< speed 0 at once, with the torque of DriveStops::emergency_torque at most (SV33-E P04.23)
    zero_speed,        ///< speed 0 at once, with all the torque there is
};

/// What holds the motor when it stands.
enum class StopThen : std::uint8_t {
    free,           ///< no power
    lock,           ///< position control
    clamp,          ///< speed control at 0 (SV-DA200 3.2.7)
    dynamic_brake,  ///< phases stay shorted
};

/// One value of an option, in some modes.
struct StopWay {
    std::int16_t value = 0;
    std::vector<DriveMode> modes;  ///< empty: all; the first row that fits counts
    StopBy by = StopBy::ramp;
    StopThen then = StopThen::free;
};

/// An option of a drive. A value without a row is not documented: the simulated drive then stops with the first row.
struct StopOption {
    StopCause cause = StopCause::quick_stop;
    ParameterAddress object{};  ///< that holds the value; index 0: there is none, the only row counts
    std::vector<StopWay> ways;
};

}  // namespace taktwerk::axes
