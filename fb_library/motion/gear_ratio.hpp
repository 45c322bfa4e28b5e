#pragma once
// The pins RatioNumerator and RatioDenominator as the axis takes them.

#include <cstdint>
#include <limits>

#include "axes/axis/command_details.hpp"

namespace taktwerk::fb {

/// A denominator that does not fit becomes 0, which the axis refuses with invalid_ratio.
[[nodiscard]] constexpr axes::GearRatio gear_ratio(std::int32_t numerator, std::uint32_t denominator) noexcept {
    constexpr auto most = static_cast<std::uint32_t>(std::numeric_limits<std::int32_t>::max());
    return {numerator, denominator <= most ? static_cast<std::int32_t>(denominator) : 0};
}

}  // namespace taktwerk::fb
