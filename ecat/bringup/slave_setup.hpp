#pragma once
// What one slave gets on its way up. Each step is run for all slaves side by side at start, and for one slave alone when it
// returns (recovery): the same code. Order: enter_preop, write_startup(PreopToSafeop), assign_pdos, program_process_data.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Mailbox sync managers, then PREOP. Slaves without mailbox only change state.
[[nodiscard]] Script<Result<void>> enter_preop(Bus& bus, BusSlave& slave);

/// PDO assignment and mapping by the zero-count rule (count 0, entries, count), then what the slave really maps is read back
/// into slave.rx and slave.tx and compared with what was asked for. Without CoE: from the description.
/// Errors: bus.pdo_mismatch, sdo.abort, ...
[[nodiscard]] Script<Result<void>> assign_pdos(Bus& bus, BusSlave& slave);

/// Start-up SDOs of a transition, in the order of the list. Errors name the entry's origin.
[[nodiscard]] Script<Result<void>> write_startup_safeop(Bus& bus, BusSlave& slave);
[[nodiscard]] Script<Result<void>> write_startup_op(Bus& bus, BusSlave& slave);

/// The two above that come before the plan: start-up SDOs of PREOP -> SAFEOP, then the PDOs.
[[nodiscard]] Script<Result<void>> prepare_process_data(Bus& bus, BusSlave& slave);

/// Sync managers, FMMUs and the SM watchdog from bus.plan.
[[nodiscard]] Script<Result<void>> program_process_data(Bus& bus, BusSlave& slave);

/// The watchdog this slave gets: configured, or three cycles and at least 10 ms.
[[nodiscard]] Duration sm_watchdog(const BusConfig& bus, const SlaveConfig& slave) noexcept;

/// What the planner is told of a slave whose PDOs are known.
[[nodiscard]] PlanSlave plan_input(const BusSlave& slave);

}  // namespace taktwerk::ecat
