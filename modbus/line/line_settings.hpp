#pragma once
// Speed and character format of a serial line, and the times that follow from them.

#include <cstddef>
#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::modbus {

enum class Parity : std::uint8_t { none, even, odd };

/// The XP200 as delivered: 19200 baud, 8E1 (manual 9.2, Pr182 = 2, Pr183 = 1).
struct LineSettings {
    std::uint32_t baud = 19200;
    Parity parity = Parity::even;
    std::uint8_t stop_bits = 1;

    friend bool operator==(const LineSettings&, const LineSettings&) = default;

    /// Start bit, eight data bits, parity, stop bits.
    [[nodiscard]] constexpr int bits_per_character() const noexcept { return 1 + 8 + (parity == Parity::none ? 0 : 1) + stop_bits; }
    /// On the wire, for so many characters.
    [[nodiscard]] constexpr Duration duration(std::size_t characters) const noexcept {
        return Duration{static_cast<std::int64_t>(characters) * bits_per_character() * 1'000'000'000 / baud};
    }
    /// Silence before and after a frame: 3.5 characters (manual 9.3).
    [[nodiscard]] constexpr Duration frame_gap() const noexcept { return duration(7) / 2; }
    /// A longer silence inside a frame ends it: 1.5 characters (manual 9.3).
    [[nodiscard]] constexpr Duration character_gap() const noexcept { return duration(3) / 2; }
};

}  // namespace taktwerk::modbus
