#pragma once
// PDO assignment and mapping of one slave in PREOP, and what it really maps afterwards. Service side only.
// Source: ETG.1000.6 5.6.7.4, SV33-E manual 7.1.
//
// Written by the zero-count rule (count 0, entries, count) for every sync manager of a direction (assignment object 1C10h + its
// number), then read back and compared: manuals contradict themselves about entries and defaults, so offsets always come from
// what the slave says. Who cannot be asked is believed by its EEPROM, then by the configuration; bus.notes says which.
//
//     CoE with assignment objects      written (where a selection or modules ask for it), read back, compared
//     CoE, assignment fixed or absent  read where it can be read, else EEPROM, else configuration; compared with the selection
//     no CoE (terminals, FoE, EoE)     EEPROM, else configuration
//     PDOs that nobody stated          given as far as the slave takes them, else found among those it has (pdo_search.hpp)

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Fills slave.rx and slave.tx; each PDO names its sync manager. Errors: bus.pdo_mismatch, sdo.abort, ...
[[nodiscard]] Script<Result<void>> assign_pdos(Bus& bus, BusSlave& slave);

}  // namespace taktwerk::ecat
