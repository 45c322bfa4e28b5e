#pragma once
// The one way up (and down). bring_up() takes a bus from nothing to OP; keep_alive() watches each slave in OP and takes one
// that fell or was power-cycled through the same steps again; take_down() ends in INIT.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Ends in OP, or with the error that says why not. Sets bus.phase on its way.
[[nodiscard]] Script<Result<void>> bring_up(Bus& bus);

/// Runs until it is destroyed: reads each slave's AL status at a slow pace (at once when the cycle saw a wrong state).
[[nodiscard]] Script<void> keep_alive(Bus& bus);

/// OP -> SAFEOP -> PREOP -> INIT. Slaves that do not answer are skipped.
[[nodiscard]] Script<Result<void>> take_down(Bus& bus);

/// One slave back to OP from whatever it is in. The others go on.
[[nodiscard]] Script<Result<void>> recover(Bus& bus, BusSlave& slave);

}  // namespace taktwerk::ecat
