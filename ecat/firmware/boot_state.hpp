#pragma once
// The way to BOOT, where a slave takes firmware, and back. Service side. Source: ETG.1000.6 (ESM), ETG.2010 (words 14h to 17h).

#include <cstddef>

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// INIT, the mailboxes that its EEPROM names for BOOT, BOOT. A slave that is in BOOT already stays there with the mailboxes it has.
/// Errors: foe.no_boot (its EEPROM names none), those of set_state().
[[nodiscard]] Script<Result<void>> enter_boot(Bus& bus, BusSlave& slave);

/// Asks for INIT and waits until the slave is there. Its application may start anew meanwhile: it is silent for a while, and has lost its
/// station address, which it gets again. Errors: firmware.not_back after `patience`; bus.refused_state.
[[nodiscard]] Script<Result<void>> leave_boot(Bus& bus, BusSlave& slave, Duration patience);

/// Switches the mailbox sync managers off, in INIT: while one is on the controller takes no other start and length for it.
[[nodiscard]] Script<Result<void>> clear_mailboxes(Bus& bus, BusSlave& slave);

/// Silent, or without its station address: waits until it answers, and gives it its address. Error firmware.not_back.
[[nodiscard]] Script<Result<void>> await_back(Bus& bus, BusSlave& slave, Duration patience);

}  // namespace taktwerk::ecat
