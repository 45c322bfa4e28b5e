#pragma once
// The one way up (and down). bring_up() takes a bus from nothing to OP; take_down() ends in INIT. What happens in between is
// watched by watch.hpp; who falls goes up again by recovery.hpp.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Ends in OP, or with the error that says why not. Sets bus.phase on its way.
[[nodiscard]] Script<Result<void>> bring_up(Bus& bus);

/// OP -> SAFEOP -> PREOP -> INIT. Slaves that do not answer are skipped.
[[nodiscard]] Script<Result<void>> take_down(Bus& bus);

}  // namespace taktwerk::ecat
