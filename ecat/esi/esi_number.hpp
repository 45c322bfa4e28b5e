#pragma once
// Numbers as ESI files write them. ETG.2000, HexDecValue: decimal, or hexadecimal behind "#x"; in the field also behind "0x".

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace taktwerk::ecat::esi {

/// The largest values of fields.
inline constexpr std::int64_t u8 = 0xFF, u16 = 0xFFFF, i32 = 0x7FFF'FFFF, u32 = 0xFFFF'FFFF;

/// Decimal with a sign or without, "#x1F", "0x1F", "#x0x1F"; blanks around it. Nothing: it is no number, or needs more than 64 bits.
[[nodiscard]] std::optional<std::int64_t> parse_number(std::string_view text) noexcept;

/// "0", "1", "true", "false".
[[nodiscard]] std::optional<bool> parse_flag(std::string_view text) noexcept;

/// Pairs of hexadecimal digits, blanks anywhere between: "0A 0b", "#x0A0B". Nothing: it is none.
[[nodiscard]] std::optional<std::vector<std::byte>> parse_bytes(std::string_view text);

/// Without blanks at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;

}  // namespace taktwerk::ecat::esi
