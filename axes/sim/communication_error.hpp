#pragma once
// Which communication error it was, on drives that tell (SE-808X 2001h:04). Its manual lists the three in this order (5.2) and leaves the
// numbers out: they are ours.

#include <cstdint>

namespace taktwerk::axes::sim::communication_error {

inline constexpr std::uint32_t general = 1, sync = 2, watchdog = 3;

}  // namespace taktwerk::axes::sim::communication_error
