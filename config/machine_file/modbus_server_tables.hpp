#pragma once
// The keys of a machine file that say what is offered to Modbus TCP clients.

#include "config/machine_file/machine_tables.hpp"

namespace taktwerk::config {

/// The section `modbus_server`.
[[nodiscard]] Field<MachineFile> modbus_server_field();

}  // namespace taktwerk::config
