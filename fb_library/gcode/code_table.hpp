#pragma once
// The G and M words that there are, by RS274/NGC (NIST RS274NGC Interpreter, version 3, 3.5 and 3.6; the further ones as LinuxCNC has them), and why some are refused.

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace taktwerk::gcode {

/// At most one word of each in a block.
enum class CodeGroup : std::uint8_t {
    non_modal,
    motion,
    plane,
    distance,
    arc_distance,
    feed_mode,
    units,
    compensation,
    length,
    coordinates,
    path_mode,
    spindle_mode,
    stop,
    tool_change,
    spindle,
    coolant,
    user,  // of M words
    count,
};
inline constexpr std::size_t code_groups = static_cast<std::size_t>(CodeGroup::count);

struct CodeEntry {
    int number = 0;  ///< G words: in tenths (G59.1 is 591)
    CodeGroup group = CodeGroup::count;
    std::string_view refused{};  ///< why; empty: it is offered
};

/// nullptr: nobody knows it.
[[nodiscard]] const CodeEntry* find_g(int tenths) noexcept;
/// M100 to M199 are the user's own.
[[nodiscard]] const CodeEntry* find_m(int number) noexcept;

}  // namespace taktwerk::gcode
