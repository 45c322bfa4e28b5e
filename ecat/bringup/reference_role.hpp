#pragma once
// Who serves as reference clock. The first slave with a clock does; while it does not answer, the next one that does. Every clock
// shows the same system time, so nothing jumps when the role changes hands: what changes is only whose quartz the others follow,
// and with it the propagation delays (0928h), which count from the one that serves. When the first returns, its clock is set by
// the substitute's, and it takes the role back. On a line nobody is left behind a lost reference: then the cycle coasts until
// it returns.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Frames of so many cycles may still be under way when something has been changed for the cycle.
inline constexpr std::int64_t frames_under_way = 3;

/// From now on `slave` serves, its clock shows system time already. Slaves behind it that do not answer are left out: they get
/// their delay when they return.
[[nodiscard]] Script<Result<void>> serve_as_reference(Bus& bus, BusSlave& slave);

/// Looks after the role while the bus runs. Ends with the bus.
[[nodiscard]] Script<void> watch_reference(Bus& bus);

}  // namespace taktwerk::ecat
