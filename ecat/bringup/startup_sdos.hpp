#pragma once
// The start-up SDOs of a slave, in the order of its list. `if_changed` reads first and spares the drive's EEPROM; `verify`
// reads back. Errors name the entry's origin: sdo.abort, bus.startup_verify, ... Service side only.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

[[nodiscard]] Script<Result<void>> write_startup_safeop(Bus& bus, BusSlave& slave);  ///< Transition::PreopToSafeop
[[nodiscard]] Script<Result<void>> write_startup_op(Bus& bus, BusSlave& slave);      ///< Transition::SafeopToOp

}  // namespace taktwerk::ecat
