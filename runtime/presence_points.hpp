#pragma once
// The inputs by which everybody sees whether a group of hot connect is there (docs/hot-connect.md).

#include <vector>

#include "ecat/bus_config.hpp"
#include "runtime/io_point.hpp"

namespace taktwerk::runtime {

/// Of each group GROUP.present and GROUP.joining, both BOOL; in the order of the groups. Whoever puts a machine together adds them to its points.
[[nodiscard]] std::vector<IoPoint> presence_points(const ecat::BusConfig& bus);

}  // namespace taktwerk::runtime
