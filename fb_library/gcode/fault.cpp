#include "fb_library/gcode/fault.hpp"

#include <array>

#include <fmt/format.h>

namespace taktwerk::gcode {
namespace {

using K = FaultKind;

constexpr std::array<FaultWords, fault_kinds - 1> table{{
    {K::read_failed, "gcode.read_failed", "the text cannot be read any further", "Look after the file or its medium."},
    {K::line_too_long, "gcode.line_too_long", "the line has more than 256 bytes", "Break it into several blocks, or shorten its comment."},
    {K::no_end, "gcode.no_end", "the program ends without M2, M30 or a closing %: it may have been cut off",
     "End it with M30; or copy the file again if it had an end."},
    {K::text_behind_percent, "gcode.text_behind_percent", "text stands behind the closing %, and would never be carried out",
     "Delete it, or the %."},
    {K::percent_inside, "gcode.percent_inside", "a % shares its line with other text", "Put it on a line of its own."},
    {K::percent_unopened, "gcode.percent_unopened", "a % closes the program, but none opened it",
     "Begin the file with a line %, or end the program with M30 alone."},
    {K::bad_character, "gcode.bad_character", "{word} is no character of a block", "Delete it, or put it into a comment: ( ) or ;."},
    {K::not_plain_text, "gcode.not_plain_text", "{word} is in no plain text: this seems to be UTF-16, or no text at all",
     "Save the program as plain text (ASCII, UTF-8)."},
    {K::nested_comment, "gcode.nested_comment", "a comment begins inside a comment: which ) would end it?", "Use other brackets inside."},
    {K::open_comment, "gcode.open_comment", "the comment has no ) in its line", "Close it; a comment ends in its line."},
    {K::active_comment, "gcode.active_comment", "{word} is a comment that other controls act upon, and this one does not",
     "Remove it; only (MSG, text) is known here."},
    {K::slash_not_first, "gcode.slash_not_first", "/ marks a block that may be left out, and stands at its beginning only",
     "Put it in front of the block, without a number."},
    {K::n_not_first, "gcode.n_not_first", "the block's number {word} does not stand first", "Put it in front of the other words."},
    {K::no_letter, "gcode.no_letter", "the number {word} has no letter", "A word is a letter and a number: X10."},
    {K::no_number, "gcode.no_number", "the letter {word} has no number", "A word is a letter and a number: X10."},
    {K::number_form, "gcode.number_form", "{word} is no number: it wants one sign at most, one point at most, and a digit",
     "Write it like 12.5, -.5 or 3."},
    {K::blank_in_number, "gcode.blank_in_number",
     "a blank stands inside the number of {word}: RS274 reads X1 5 as X15, which is seldom what was meant",
     "Remove the blank, or add the letter that is missing."},
    {K::comma, "gcode.comma", "{word} is followed by a comma; the decimal sign is the point", "Write a point."},
    {K::too_large, "gcode.too_large", "{word} is larger than 1,000,000", "Check the number; nothing is that far away."},
    {K::not_whole, "gcode.not_whole", "{word} wants a whole number", "Write it without a fraction."},
    {K::negative, "gcode.negative", "{word} must not be negative", "Write it without the sign."},
    {K::expression, "gcode.expression", "variables and expressions (# [ ] =) are not offered",
     "Write numbers; or have the program expanded by what made it."},
    {K::o_word, "gcode.o_word", "subprograms, loops and conditions (O words) are not offered",
     "Write the blocks out; or have the program expanded by what made it."},

    {K::word_twice, "gcode.word_twice", "{word} stands twice in its block: first as {other}", "Keep one of them."},
    {K::unknown_letter, "gcode.unknown_letter", "there is no word with the letter of {word}",
     "Words are A B C F G H I J K L M N P Q R S T X Y Z; numbers have no exponent."},
    {K::unknown_code, "gcode.unknown_code", "{word} is not known", "docs/gcode.md lists the words that are."},
    {K::refused_code, "gcode.refused_code", "{word} is not offered: {reason}", "docs/gcode.md lists the words that are."},
    {K::same_group, "gcode.same_group", "{word} and {other} exclude each other in one block", "Keep one of them, or use two blocks."},
    {K::unused_word, "gcode.unused_word", "no code of this block uses {word}", "Delete it, or add the code that it belongs to."},
    {K::word_for_two, "gcode.word_for_two", "two codes of this block want {word}", "Use two blocks."},
    {K::missing_word, "gcode.missing_word", "{word} lacks {reason}", "Add it to the block."},
    {K::axis_words_twice, "gcode.axis_words_twice", "{word} and {other} both want the axis words of this block", "Use two blocks."},
    {K::rotary_word, "gcode.rotary_word", "{word}: A, B and C have no meaning here, because none was declared",
     "Declare them (the option `rotary` of the reader, --rotary of the command), or remove the word."},

    {K::no_motion_mode, "gcode.no_motion_mode", "{word} has no motion: neither this block nor one before it says G0, G1, G2 or G3",
     "Write the motion into the block. G80 ends the one before."},
    {K::no_feed, "gcode.no_feed", "{word} has no feed: F was not given since the feed mode was chosen, or is 0",
     "Give F in this block or before it."},
    {K::no_inverse_time, "gcode.no_inverse_time", "under G93 each block that cuts has its own F, and this one has none",
     "Add F (1 / minutes that this move takes), or go back to G94."},
    {K::feed_with_units, "gcode.feed_with_units",
     "{word} stands in a block that changes the units ({other}): controls read F before units, people behind them",
     "Put {other} into a block of its own, before F."},
    {K::no_speed, "gcode.no_speed", "{word} has no speed: S was never given", "Give S in this block or before it."},
    {K::no_tool, "gcode.no_tool", "{word} has no tool: {reason}", "Select one with T."},
    {K::unknown_tool, "gcode.unknown_tool", "{word}: this tool does not stand in the tool table",
     "Enter its length there (--tool of the command), or correct the number."},
    {K::g53_motion, "gcode.g53_motion", "G53 wants G0 or G1, and axis words, in its block or in force", "Write G53 G0 Z0 or G53 G1 Z0."},
    {K::g53_relative, "gcode.g53_relative", "G53 while G91 is in force: positions of the machine, or distances?",
     "Put G90 in front of it."},
    {K::g64_zero, "gcode.g64_zero", "G64 P0 means any deviation on some controls and none on others",
     "Write G61 for none, G64 for any, or a P above 0."},
    {K::g10_kind, "gcode.g10_kind", "G10 is offered with L2 and L20 only", "Enter tools in the tool table."},
    {K::g10_system, "gcode.g10_system", "{word}: coordinate systems are P1 (G54) to P9 (G59.3), P0 is the one in force",
     "Correct the number."},
    {K::out_of_range, "gcode.out_of_range", "{word} leads beyond 1,000,000 mm (or deg) from the machine's zero",
     "Check units, offsets and distance mode."},
    {K::turns, "gcode.turns", "{word}: an arc has 1 to 10,000 turns", "Correct the number, or leave it out."},

    {K::arc_nothing, "gcode.arc_nothing", "{word} has neither a centre (I J K) nor a radius (R)", "Add one; for a full circle the centre."},
    {K::arc_both, "gcode.arc_both", "{word} has a centre and a radius", "Keep one of them."},
    {K::arc_offset_plane, "gcode.arc_offset_plane", "{word} {reason}", "G17 has I and J, G18 I and K, G19 J and K."},
    {K::arc_zero_radius, "gcode.arc_zero_radius", "{word} has radius 0: the centre is one of the arc's ends, or R is 0",
     "Correct the centre."},
    {K::arc_radii, "gcode.arc_radii", "the centre of {word} is {a} mm from the start and {b} mm from the end, which is more than rounding",
     "Check I J K (distances from the start under G91.1, positions under G90.1), the plane, and the end."},
    {K::arc_ends, "gcode.arc_ends",
     "the ends of {word} are {a} mm apart and lie at different distances from its centre: no circle near the one given goes through both "
     "(off by {b} mm)",
     "For a full circle repeat the start as the end, or leave the end out."},
    {K::arc_same_point, "gcode.arc_same_point", "{word} ends where it begins, and a radius does not say where its centre is",
     "Use I J K for a full circle."},
    {K::arc_too_far, "gcode.arc_too_far", "the ends of {word} are {a} mm apart, and its radius is {b} mm: it does not reach",
     "Check R and the end."},

    {K::start_beyond_end, "gcode.start_beyond_end", "the program ends before the line at which it is to start", "Choose an earlier line."},
}};

constexpr bool in_order() {
    for (std::size_t i = 0; i < table.size(); ++i)
        if (static_cast<std::size_t>(table[i].kind) != i + 1) return false;
    return true;
}
static_assert(in_order(), "a row a kind, in their order");

std::string filled(std::string_view text, const Fault& fault) {
    std::string out;
    while (!text.empty()) {
        const auto open = text.find('{');
        out += text.substr(0, open);
        if (open == std::string_view::npos) break;
        const auto close = text.find('}', open);
        const auto name = text.substr(open + 1, close - open - 1);
        if (name == "word") out += fault.word.view();
        else if (name == "other") out += fault.other.view();
        else if (name == "a") out += fmt::format("{:.6g}", fault.a);
        else if (name == "b") out += fmt::format("{:.6g}", fault.b);
        else out += fault.reason;
        text.remove_prefix(close + 1);
    }
    return out;
}

}  // namespace

std::span<const FaultWords> fault_words() noexcept { return table; }

std::string_view fault_code(FaultKind kind) noexcept { return kind == K::none ? "" : table[static_cast<std::size_t>(kind) - 1].code; }

Error fault_error(const Fault& fault, std::string_view file) {
    if (fault.kind == K::none) return {};
    const auto& row = table[static_cast<std::size_t>(fault.kind) - 1];
    std::string subject(file);
    if (fault.line > 0) subject += fmt::format(":{}", fault.line);
    if (fault.line > 0 && fault.column > 0) subject += fmt::format(":{}", fault.column);
    return {std::string(row.code), std::move(subject), filled(row.what, fault), filled(row.remedy, fault)};
}

}  // namespace taktwerk::gcode
