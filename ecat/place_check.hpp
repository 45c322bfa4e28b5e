#pragma once
// Part of check(BusConfig): names, places and sync units, which concern several slaves at once. Not real-time.

#include <vector>

#include "ecat/bus_config.hpp"

namespace taktwerk::ecat {

/// Names are there and different; each slave has exactly one of position, alias and device id, nobody else's; sync units that
/// are listed have members and a divisor. Appends to `errors`.
void check_places(const BusConfig& config, std::vector<Error>& errors);

}  // namespace taktwerk::ecat
