#pragma once
// What the machine tells all its axes at once.

#include <cstdint>

namespace taktwerk::axes {

/// Mode of the machine as far as it concerns an axis: who owns it by default, and how fast it may be.
///   automatic  program; the axis' limit     manual  operator; manual.fast     setup  operator; manual.setup_velocity
enum class OperatingMode : std::uint8_t { automatic, manual, setup };

/// A level, never queued: given in each cycle in which it changes, holds until taken back.
///   stop_and_power_off  power goes when the axis stands     power_off_now  power goes, wherever the axis is: the time is up
enum class EmergencyStop : std::uint8_t { none, stop, stop_and_power_off, power_off_now };

}  // namespace taktwerk::axes
