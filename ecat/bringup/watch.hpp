#pragma once
// Looks after a bus in OP: reads each slave's AL status at a slow pace, at once when the cycle saw a wrong state, and starts the
// recovery of those that are not in OP.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Runs until it is destroyed.
[[nodiscard]] Script<void> keep_alive(Bus& bus);

}  // namespace taktwerk::ecat
