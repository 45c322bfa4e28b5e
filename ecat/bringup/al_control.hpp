#pragma once
// Asking a slave for a state, and finding out why it did not come. Service side only. Source: ETG.1000.6 (ESM).

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// AL status and code, kept in slave.link.al. Error bus.no_slave or bus.no_frame.
[[nodiscard]] Script<Result<std::uint16_t>> read_al_status(Bus& bus, BusSlave& slave);

/// Acknowledges an error the slave shows, asks for `target` (one step up, or any way down) and waits for it, at most
/// state_timeout(). What went wrong stands in slave.refusal, and in the error: bus.refused_state, bus.state_timeout.
[[nodiscard]] Script<Result<void>> set_state(Bus& bus, BusSlave& slave, AlState target);

/// Reads what decides about a state change (sync managers, FMMUs, clock, watchdog) and puts it beside the plan; judged.
/// Registers that do not answer are left out.
[[nodiscard]] Script<Refusal> read_refusal(Bus& bus, BusSlave& slave, AlState asked);

/// How long a slave may take on its way to `target`, as configured; see StateTimeouts.
[[nodiscard]] Duration state_timeout(const StateTimeouts& timeouts, AlState target) noexcept;

}  // namespace taktwerk::ecat
