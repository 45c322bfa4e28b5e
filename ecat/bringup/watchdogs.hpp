#pragma once
// The watchdogs of a slave controller: what makes a drive react when the master dies. Service side only.
// Source: SV33-E manual 6.2.4 (0400h, 0410h, 0420h); default time: sm_watchdog() in bus_config.hpp.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// With the divider's power-on value 2498 a tick is 25 MHz / 2500.
inline constexpr Duration watchdog_tick = std::chrono::microseconds{100};

/// Ticks for at least this long; at most 6.5535 s.
[[nodiscard]] std::uint16_t watchdog_ticks(Duration time) noexcept;

/// Divider, SM watchdog, and the PDI watchdog where one is configured; read back and compared. A slave without outputs need
/// not have them. Errors: bus.watchdog, bus.no_slave, bus.no_frame.
[[nodiscard]] Script<Result<void>> program_watchdogs(Bus& bus, BusSlave& slave);

}  // namespace taktwerk::ecat
