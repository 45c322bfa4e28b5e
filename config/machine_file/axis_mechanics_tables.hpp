#pragma once
// The keys of what an axis may have beside its motor: a second encoder, the other side of a portal, a holding brake. Each names something of the machine,
// so they are tables of the binding.

#include "config/reading/field_table.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::config {

[[nodiscard]] Table<runtime::AxisBinding> load_encoder_table();
[[nodiscard]] Table<runtime::AxisBinding> gantry_table();
[[nodiscard]] Table<runtime::AxisBinding> brake_table();

}  // namespace taktwerk::config
