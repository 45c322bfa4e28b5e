#pragma once
// What is wrong with a program, as plain data: kind, place, the word it is about. Sentences are made when somebody reads them.

#include <cstdint>
#include <span>
#include <string_view>

#include "core/fixed_text.hpp"
#include "core/result.hpp"

namespace taktwerk::gcode {

enum class FaultKind : std::uint8_t {
    none,
    // text
    read_failed,
    line_too_long,
    no_end,
    text_behind_percent,
    percent_inside,
    percent_unopened,
    bad_character,
    not_plain_text,
    nested_comment,
    open_comment,
    active_comment,
    slash_not_first,
    n_not_first,
    no_letter,
    no_number,
    number_form,
    blank_in_number,
    comma,
    too_large,
    not_whole,
    negative,
    expression,
    o_word,
    // words of a block
    word_twice,
    unknown_letter,
    unknown_code,
    refused_code,
    same_group,
    unused_word,
    word_for_two,
    missing_word,
    axis_words_twice,
    rotary_word,
    // what a block asks for
    no_motion_mode,
    no_feed,
    no_inverse_time,
    feed_with_units,
    no_speed,
    no_tool,
    unknown_tool,
    g53_motion,
    g53_relative,
    g64_zero,
    g10_kind,
    g10_system,
    out_of_range,
    turns,
    // arcs
    arc_nothing,
    arc_both,
    arc_offset_plane,
    arc_zero_radius,
    arc_radii,
    arc_ends,
    arc_same_point,
    arc_too_far,
    // options
    start_beyond_end,
};
inline constexpr std::size_t fault_kinds = static_cast<std::size_t>(FaultKind::start_beyond_end) + 1;

struct Fault {
    FaultKind kind = FaultKind::none;
    std::uint32_t line = 0;     ///< of the text, from 1
    std::uint32_t column = 0;   ///< bytes from the beginning of the line, from 1; 0: the line as a whole
    FixedText<24> word{};       ///< as it was written, printable
    FixedText<24> other{};      ///< a second one, where two do not agree
    double a = 0, b = 0;        ///< lengths in mm, where the kind has some
    std::string_view reason{};  ///< of a refused code; never ends
};

/// The stable code of a kind: "gcode.no_feed".
[[nodiscard]] std::string_view fault_code(FaultKind kind) noexcept;
/// What an Error says. `file` stands in its subject: "part.ngc:12:5". Allocates.
[[nodiscard]] Error fault_error(const Fault& fault, std::string_view file);

/// One row a kind, in the order of FaultKind but for `none`: {word}, {other}, {a}, {b}, {reason} stand for what a fault has.
struct FaultWords {
    FaultKind kind;
    std::string_view code, what, remedy;
};
[[nodiscard]] std::span<const FaultWords> fault_words() noexcept;

}  // namespace taktwerk::gcode
