#pragma once
// Part of check(BusConfig): hot-connect groups. Not real-time.

#include <vector>

#include "ecat/bus_config.hpp"

namespace taktwerk::ecat {

/// A group is known by its first slave and described without being there; it shares no sync unit with others, and nobody's clock depends
/// on it. Appends to `errors`. Errors: bus.hot_connect.
void check_groups(const BusConfig& config, std::vector<Error>& errors);

}  // namespace taktwerk::ecat
