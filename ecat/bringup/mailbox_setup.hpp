#pragma once
// A slave's mailbox: where it is, its two sync managers, PREOP, and who the slave says it is through it. Service side only.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Mailbox sync managers, then PREOP. A mailbox without CoE (FoE, EoE) is set up all the same: the slave checks it. Slaves
/// without mailbox only change state. Errors: bus.no_mailbox, those of set_state().
[[nodiscard]] Script<Result<void>> enter_preop(Bus& bus, BusSlave& slave);

/// Object 1018h beside the EEPROM. Devices are on the market whose product codes differ there, so a difference is a note in
/// bus.notes, never an error.
[[nodiscard]] Script<Result<void>> compare_identity(Bus& bus, BusSlave& slave);

/// Its mailboxes are sync managers 0 and 1, at `out` and `in`: nothing is written to the slave.
void place_mailboxes(BusSlave& slave, SiiMailbox out, SiiMailbox in);
/// As the slave's own sync managers 0 and 1 say, whoever set them up; false: they are no mailboxes. Error bus.no_slave, bus.no_frame.
[[nodiscard]] Script<Result<bool>> find_mailboxes(Bus& bus, BusSlave& slave);

/// Writes one sync manager. Error bus.no_slave, bus.no_frame.
[[nodiscard]] Script<Result<void>> write_sync_manager(Bus& bus, BusSlave& slave, std::uint8_t number, SyncManager registers);

}  // namespace taktwerk::ecat
