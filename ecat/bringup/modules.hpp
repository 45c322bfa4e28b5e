#pragma once
// The modules of a modular slave in PREOP (ETG.5001): the configured list (F030h) is written, the detected one (F050h)
// compared. Either object may be absent: TSVM-D6 has modules that exist in its description only. Service side only.

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Nothing for slaves without slots or without chosen modules. Errors: bus.module_mismatch names slot, configured and found;
/// sdo.abort, ...
[[nodiscard]] Script<Result<void>> configure_modules(Bus& bus, BusSlave& slave);

}  // namespace taktwerk::ecat
