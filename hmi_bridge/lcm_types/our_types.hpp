#pragma once
// Every type of hmi_bridge/lcm/, in the program itself.

#include "hmi_bridge/lcm_types/type_catalog.hpp"

namespace taktwerk::hmi {

[[nodiscard]] TypeCatalog our_types();

}  // namespace taktwerk::hmi
