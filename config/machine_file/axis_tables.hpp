#pragma once
// The keys of one axis in a machine file.

#include "config/reading/field_table.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::config {

/// Keys under `axes.<name>`.
[[nodiscard]] Table<runtime::AxisBinding> axis_table();

}  // namespace taktwerk::config
