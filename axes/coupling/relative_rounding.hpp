#pragma once

namespace taktwerk::axes {

/// Of a limit or a time: exceeded by less, it is not exceeded.
inline constexpr double relative_rounding = 1e-9;

}  // namespace taktwerk::axes
