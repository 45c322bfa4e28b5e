#pragma once
// A ratio of whole numbers that a floating point number stands for.

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace taktwerk::axes {

struct Rational {
    std::int64_t numerator = 1;
    std::int64_t denominator = 1;
};

/// The fraction p/q with the smallest q, both at most 10^6, that equals `value` [> 0] to within its rounding; nothing where there is none
/// (0.667 is 667/1000, not two thirds). By continued fractions.
[[nodiscard]] inline std::optional<Rational> rational_of(double value) noexcept {
    constexpr std::int64_t most = 1'000'000;
    if (!(value > 0) || std::isinf(value)) return std::nullopt;
    std::int64_t p0 = 0, q0 = 1, p1 = 1, q1 = 0;
    double rest = value;
    for (int i = 0; i < 40; ++i) {
        const double whole = std::floor(rest);
        if (whole > static_cast<double>(most)) return std::nullopt;
        const auto digit = static_cast<std::int64_t>(whole);
        const std::int64_t p = digit * p1 + p0;
        const std::int64_t q = digit * q1 + q0;
        if (p > most || q > most) return std::nullopt;
        const double error = std::abs(static_cast<double>(p) / static_cast<double>(q) - value);
        if (p > 0 && error <= 4 * std::numeric_limits<double>::epsilon() * value) return Rational{p, q};
        p0 = p1, q0 = q1, p1 = p, q1 = q;
        rest = 1 / (rest - whole);
    }
    return std::nullopt;
}

}  // namespace taktwerk::axes
