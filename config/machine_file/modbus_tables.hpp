#pragma once
// The keys of a machine file that describe Modbus TCP devices.

#include "config/machine_file/machine_tables.hpp"

namespace taktwerk::config {

/// The section `modbus_tcp`.
[[nodiscard]] Field<MachineFile> modbus_field();

}  // namespace taktwerk::config
