#pragma once
// What one slave gets on its way up. Each step is run for all slaves side by side at start, and for one slave alone when it
// returns (recovery): the same code. Order: enter_preop (mailbox_setup), compare_identity (at start only),
// prepare_process_data (modules, start-up SDOs, PDOs), program_process_data, write_startup_op.

#include "ecat/bringup/bus.hpp"
#include "ecat/bringup/mailbox_setup.hpp"
#include "ecat/bringup/pdo_assignment.hpp"
#include "ecat/bringup/startup_sdos.hpp"

namespace taktwerk::ecat {

/// In PREOP: modules, start-up SDOs, what is asked of it, then PDO assignment and mapping. Afterwards the planner can be asked.
[[nodiscard]] Script<Result<void>> prepare_process_data(Bus& bus, BusSlave& slave);

/// Sync managers, FMMUs and watchdogs from bus.plan.
[[nodiscard]] Script<Result<void>> program_process_data(Bus& bus, BusSlave& slave);

/// What the planner is told of a slave whose PDOs are known.
[[nodiscard]] PlanSlave plan_input(const BusSlave& slave);

}  // namespace taktwerk::ecat
