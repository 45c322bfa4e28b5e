#pragma once
// One block: the words of a line, each letter once, G and M words by their modal groups. A value; no allocation; linear in the line's bytes.

#include <array>
#include <cstdint>
#include <string_view>

#include "fb_library/gcode/code_table.hpp"
#include "fb_library/gcode/fault.hpp"
#include "fb_library/gcode/source_lines.hpp"

namespace taktwerk::gcode {

inline constexpr double largest_number = 1e6;
inline constexpr std::uint32_t no_block_number = 0xFFFF'FFFF;

/// "X" is 23.
[[nodiscard]] constexpr std::uint32_t letter_bit(char letter) noexcept { return 1u << static_cast<unsigned>(letter - 'A'); }

struct BlockCode {
    const CodeEntry* entry = nullptr;  ///< nullptr: the group has no word in this block
    std::uint16_t column = 0;
};

struct Block {
    std::string_view text;  ///< its line
    std::uint32_t line = 0;
    std::uint32_t number = no_block_number;  ///< N
    bool deletable = false;                  ///< begins with /
    std::uint32_t letters = 0;               ///< letter_bit() of the words but G, M, N
    std::array<double, 26> value{};          ///< of letters that there are
    std::array<std::uint16_t, 26> column{};
    std::array<BlockCode, code_groups> codes{};
    std::string_view message{};  ///< of (MSG, ...), part of `text`

    [[nodiscard]] bool has(char letter) const noexcept { return (letters & letter_bit(letter)) != 0; }
    [[nodiscard]] double of(char letter) const noexcept { return value[static_cast<std::size_t>(letter - 'A')]; }
    [[nodiscard]] std::uint16_t column_of(char letter) const noexcept { return column[static_cast<std::size_t>(letter - 'A')]; }
    [[nodiscard]] const BlockCode& code(CodeGroup group) const noexcept { return codes[static_cast<std::size_t>(group)]; }
    /// The number of that group's word, or -1.
    [[nodiscard]] int number_of(CodeGroup group) const noexcept { return code(group).entry ? code(group).entry->number : -1; }
};

enum class Deletable : std::uint8_t { carried_out, left_out };

/// `block` is overwritten. A block that is left out is not looked at behind its /. What came before a fault stays in `block`.
/// Returns the fault's kind; `fault` is written only where there is one.
FaultKind parse_block(std::string_view line, std::uint32_t number, Deletable deletable, Block& block, Fault& fault) noexcept;

/// The word at a column (from 1) as it is written, printable, at most 24 bytes.
[[nodiscard]] FixedText<24> word_at(std::string_view line, std::uint32_t column) noexcept;

}  // namespace taktwerk::gcode
