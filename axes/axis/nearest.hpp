#pragma once
// Rounding to whole counts.

#include <cstdint>

namespace taktwerk::axes {

/// The nearest whole number, halves away from zero: std::llround without the call. For |value| < 2^63. The difference is exact, because
/// `value` and its whole part share the digits before the point.
[[nodiscard]] constexpr std::int64_t nearest(double value) noexcept {
    const auto whole = static_cast<std::int64_t>(value);
    const double rest = value - static_cast<double>(whole);
    return whole + static_cast<int>(rest >= 0.5) - static_cast<int>(rest <= -0.5);
}

}  // namespace taktwerk::axes
