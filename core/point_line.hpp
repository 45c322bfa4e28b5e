#pragma once
// What the number that a terminal carries means: a straight line between it and a value with a unit. Plain data, real-time safe.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace taktwerk {

/// value = number * factor + offset. The raw word of a point is its number, or of a real one its bit pattern (IEEE 754).
struct PointLine {
    enum class Number : std::uint8_t { whole, real32, real64 };
    double factor = 1, offset = 0;  ///< factor is not 0
    Number number = Number::whole;
    double least = -0x1p63, most = 0x1p63 - 1024;  ///< of a whole number: what the object holds, or the terminal does with it

    /// Narrower where an object of so many bits holds less. 0, or 64 and more bits: as it was.
    void fit(unsigned bits, bool is_signed) noexcept {
        if (bits == 0 || bits >= 64 || number != Number::whole) return;
        const double span = std::ldexp(1.0, static_cast<int>(bits));
        least = std::max(least, is_signed ? -span / 2 : 0);
        most = std::min(most, (is_signed ? span / 2 : span) - 1);
    }

    [[nodiscard]] constexpr bool is_plain() const noexcept { return factor == 1 && offset == 0 && number == Number::whole; }

    [[nodiscard]] double value_of(std::int64_t raw) const noexcept { return number_of(raw) * factor + offset; }

    /// The nearest raw word; beyond what the object holds its end. `value` is a number (not NaN).
    [[nodiscard]] std::int64_t raw_of(double value) const noexcept {
        const double wanted = (value - offset) / factor;
        switch (number) {
            case Number::real32:
                return std::bit_cast<std::int32_t>(static_cast<float>(std::clamp(wanted, -0x1.fffffep127, 0x1.fffffep127)));
            case Number::real64: return std::bit_cast<std::int64_t>(wanted);
            case Number::whole: break;
        }
        return static_cast<std::int64_t>(std::clamp(std::round(wanted), least, most));
    }

    /// The number of a value, as a whole one; whatever the object holds.
    [[nodiscard]] double number_at(double value) const noexcept { return std::round((value - offset) / factor); }

    /// Whether a value lies within what the object can hold, so that raw_of() cuts nothing off. False for NaN.
    [[nodiscard]] bool holds(double value) const noexcept {
        if (number != Number::whole) return std::isfinite(value);
        const double wanted = number_at(value);
        return wanted >= least && wanted <= most;
    }

private:
    [[nodiscard]] double number_of(std::int64_t raw) const noexcept {
        switch (number) {
            case Number::real32: return std::bit_cast<float>(static_cast<std::uint32_t>(raw));
            case Number::real64: return std::bit_cast<double>(raw);
            case Number::whole: break;
        }
        return static_cast<double>(raw);
    }
};

/// What a point says in this cycle.
struct PointValue {
    double value = 0;   ///< in its unit, filtered where it has a filter
    bool good = false;  ///< its slave was exchanged, its terminal reports no error, it is a finite number within its limits
};

}  // namespace taktwerk
