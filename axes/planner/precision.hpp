#pragma once
// What a double can tell apart. Tolerances of the planner are multiples of it, never lengths or times: a machine may be in metres or in
// counts. Internal to the planner.

#include <limits>

namespace taktwerk::axes {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();
inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace taktwerk::axes
