#pragma once
// Asking a slave for a state, and saying why it did not come. Source: ETG.1000.6 (ESM), reference/ethercat-masters.md 3, pain 1.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// AL status and code, kept in slave.al. Error bus.no_slave or bus.no_frame.
[[nodiscard]] Script<Result<std::uint16_t>> read_al_status(Bus& bus, BusSlave& slave);

/// Acknowledges an error the slave shows, asks for `target` (one step up, or any way down) and waits for it.
/// Errors: bus.refused_state (code, text, sizes, clock, last abort), bus.state_timeout.
[[nodiscard]] Script<Result<void>> set_state(Bus& bus, BusSlave& slave, AlState target);

/// How long a slave may take (ETG.1020: PREOP 3 s, SAFEOP and OP 10 s, down 5 s).
[[nodiscard]] Duration state_timeout(AlState target) noexcept;

}  // namespace taktwerk::ecat
