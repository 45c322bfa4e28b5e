#pragma once
// A machine's `pdo: rx: [...]` list as PDOs: either whole PDOs of the drive, or objects packed into its variable ones.

#include <span>

#include "config/reading/quantity.hpp"
#include "core/result.hpp"
#include "ecat/bus_config.hpp"

namespace taktwerk::config {

enum class PdoWay : std::uint8_t { rx, tx };

/// `modules`: those in the slots of a modular drive, whose PDOs can be chosen too. Errors (subject empty): config.mapping. An
/// empty list gives an empty selection.
[[nodiscard]] Result<ecat::PdoSelection> select_pdos(const ecat::DeviceDescription& device, std::span<const ecat::ModuleSelection> modules,
                                                     PdoWay way, const std::vector<ObjectAddress>& wanted);

}  // namespace taktwerk::config
