#pragma once
// Figures that the planner's tests share.

#include <limits>

namespace taktwerk::axes {

inline constexpr double unlimited = std::numeric_limits<double>::infinity();
inline constexpr double eps = std::numeric_limits<double>::epsilon();
inline constexpr double tight = 1e-12;  ///< what a plan of some seconds and units is told to

}  // namespace taktwerk::axes
