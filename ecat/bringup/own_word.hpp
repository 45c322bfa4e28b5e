#pragma once
// What a slave says of itself where nobody stated it: who it is and where its mailbox and sync managers lie (EEPROM), and its answers to
// SlaveConfig::asked. Service side only.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Behind the scan: BusSlave::own, for a description that leaves identity or controller open. Notes say whom it took.
void take_own_word(Bus& bus, BusSlave& slave);

/// In PREOP, behind the start-up SDOs: BusSlave::answers. A slave whose 1C32h:04 says that it does not work by SYNC0 is refused with its own
/// words before SYNC0 starts (error bus.no_sync0; ETG.1020 22.3), where nobody stated what it does. Other errors: those of sdo_upload().
[[nodiscard]] Script<Result<void>> ask(Bus& bus, BusSlave& slave);

}  // namespace taktwerk::ecat
