#pragma once
// The time between two steps of physics and control in a simulated drive. It divides every cycle that a bus may have.

#include <chrono>

#include "core/time.hpp"

namespace taktwerk::axes::sim {

inline constexpr Duration inner_period = std::chrono::microseconds{125};
inline constexpr double inner_seconds = 125e-6;

}  // namespace taktwerk::axes::sim
