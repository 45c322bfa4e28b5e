#pragma once
// How an XP200 names the speed and the character format of its line: Pr182 and Pr183 (manual 9.2).

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "modbus/line/line_settings.hpp"

namespace taktwerk::axes::xp200 {

inline constexpr std::array<std::uint32_t, 4> baud_rates{4800, 9600, 19200, 38400};                            ///< by Pr182
inline constexpr std::array<std::string_view, 6> character_formats{"8N1", "8E1", "8O1", "8N2", "8E2", "8O2"};  ///< by Pr183

/// Pr182; -1: no rate of this drive.
[[nodiscard]] constexpr int baud_code(std::uint32_t baud) noexcept {
    const auto found = std::find(baud_rates.begin(), baud_rates.end(), baud);
    return found == baud_rates.end() ? -1 : static_cast<int>(found - baud_rates.begin());
}

/// Pr183.
[[nodiscard]] constexpr int format_code(const modbus::LineSettings& line) noexcept {
    const int parity = line.parity == modbus::Parity::none ? 0 : line.parity == modbus::Parity::even ? 1 : 2;
    return parity + (line.stop_bits == 2 ? 3 : 0);
}

[[nodiscard]] constexpr std::string_view format_text(const modbus::LineSettings& line) noexcept {
    return character_formats[static_cast<std::size_t>(format_code(line))];
}

}  // namespace taktwerk::axes::xp200
