#pragma once
// The file format of what is kept. Text, one line each:
//
//     taktwerk retain 1                    format and version
//     number 17                            rises with each writing
//     axis x homed 1 shift 12.5 counts -4711 at_rest 1 gearing 10000 1 1 10 0
//     value cell.pieces retain LINT 4711 0
//     block cell.batch persistent CTU 9f3a0c11d2e45b67 0 0100...
//     parameter cell.speed 180 200 0       its value, what was configured then
//     crc 1a2b3c4d                         CRC-32 (IEEE 802.3) of all bytes before this line
//
// shift [u] is the coordinate of count 0, counts [counts] where the axis was, unwrapped; gearing: counts_per_revolution, motor and load
// revolutions, feed [u], inverted. The 0 (of a block the one before its bytes): starts without anybody who claimed it. In names all but
// letters, digits, `_ - . [ ]` and bytes above 127 stand as %20. Numbers are written so that they read back as the very same; such that
// nobody can have (an axis beyond what its counts resolve, 300 in a USINT) are damage, whatever the check sum says. A file of an older
// runtime (`taktwerk positions 1`, axes alone) is read as well. Pure functions; they never throw but for want of memory.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/retain/kept.hpp"

namespace taktwerk::runtime {

/// What the programs of a machine may keep: more is a problem of its file, for it could not be read again.
inline constexpr std::size_t most_kept_values = 8192;                 ///< elements of arrays and pins of blocks count as one each
inline constexpr std::size_t largest_kept_block = 8192;               ///< bytes
inline constexpr std::size_t most_kept_bytes = std::size_t{1} << 20;  ///< of all of it in memory
/// A file with more of one kind is damage: those of the programs, and what is kept aside (KeptValues).
inline constexpr std::size_t most_kept_items = 16384;

/// Two hexadecimal digits a byte. Nothing where the text is none of these, or of more than largest_kept_block.
[[nodiscard]] std::string hex_of(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<std::vector<std::byte>> bytes_of_hex(std::string_view digits);

[[nodiscard]] std::string text_of(const Kept& kept);
/// Nothing where the file is torn, altered, or of another kind.
[[nodiscard]] std::optional<Kept> kept_of(std::string_view text);

}  // namespace taktwerk::runtime
