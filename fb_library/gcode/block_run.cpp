#include "fb_library/gcode/block_run.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace taktwerk::gcode {
namespace {

using Kind = Handshake::Kind;
using ItemKind = ProgramItem::Kind;
using Distance = ModalState::Distance;
using FeedMode = ModalState::FeedMode;

}  // namespace

bool BlockRun::fail(FaultKind kind, std::uint32_t column, double a, double b) noexcept {
    auto& fault = program_.fault_;
    fault = {};
    fault.kind = kind, fault.line = block_.line, fault.column = column, fault.a = a, fault.b = b;
    fault.word = word_at(block_.text, column);
    return false;
}

bool BlockRun::fail_missing(std::uint32_t column, std::string_view what) noexcept {
    fail(FaultKind::missing_word, column);
    program_.fault_.reason = what;
    return false;
}

bool BlockRun::take(char letter, double& value) noexcept {
    if ((used_ & letter_bit(letter)) != 0) return fail(FaultKind::word_for_two, block_.column_of(letter));
    used_ |= letter_bit(letter);
    value = block_.of(letter);
    return true;
}

bool BlockRun::take_whole(char letter, double most, std::uint32_t& value) noexcept {
    double number = 0;
    if (!take(letter, number)) return false;
    if (number < 0) return fail(FaultKind::negative, block_.column_of(letter));
    if (number != std::floor(number)) return fail(FaultKind::not_whole, block_.column_of(letter));
    if (number > most) return fail(FaultKind::too_large, block_.column_of(letter));
    value = static_cast<std::uint32_t>(number);
    return true;
}

std::uint32_t BlockRun::axis_words() const noexcept {
    constexpr std::uint32_t all = letter_bit('X') | letter_bit('Y') | letter_bit('Z') | letter_bit('A') | letter_bit('B') | letter_bit('C');
    return block_.letters & all;
}

std::uint16_t BlockRun::first_axis_column() const noexcept {
    std::uint16_t first = 0;
    for (std::size_t axis = 0; axis < axis_count; ++axis)
        if (has(axis_letters[axis]))
            if (const auto column = block_.column_of(axis_letters[axis]); first == 0 || column < first) first = column;
    return first;
}

bool BlockRun::take_axes() noexcept {
    used_ |= axis_words();
    axes_taken_ = true;
    return true;
}

bool BlockRun::all_used() noexcept {
    auto left = block_.letters & ~used_;
    if (left == 0) return true;
    std::uint16_t first = 0xFFFF;
    for (; left != 0; left &= left - 1) first = std::min(first, block_.column[static_cast<std::size_t>(std::countr_zero(left))]);
    return fail(FaultKind::unused_word, first);
}

ProgramItem BlockRun::item(ItemKind kind) const noexcept {
    ProgramItem item;
    item.kind = kind, item.line = block_.line, item.number = block_.number;
    return item;
}

void BlockRun::put(Kind kind, std::uint32_t number, double value, double second) noexcept {
    auto out = item(ItemKind::handshake);
    out.handshake = {kind, number, value, second};
    program_.emit(out);
}

void BlockRun::put_move(const Move& move) noexcept {
    if (move.kind == Move::Kind::line && move.from == move.to) {
        ++program_.counts_.standing;
        return;
    }
    auto out = item(ItemKind::move);
    out.move = move;
    out.move.path = state_.path;
    program_.emit(out);
    program_.position_ = move.to;
}

bool BlockRun::run() noexcept {
    if (!rotary()) return false;
    if (!block_.message.empty()) program_.emit(item(ItemKind::message));
    if (!feed_mode() || !feed() || !speed_and_tool() || !machine_words() || !user_word() || !dwell()) return false;
    plane_and_units();
    if (!tool_length() || !path_mode()) return false;
    modes();
    if (!non_modal() || !motion() || !all_used()) return false;
    stop();
    bool words = block_.letters != 0;
    for (const auto& code : block_.codes) words = words || code.entry != nullptr;
    if (words) ++program_.counts_.blocks;
    const bool did = program_.count_ > 0 && program_.items_[program_.count_ - 1].kind != ItemKind::resume;
    if (program_.options_.single_block && did && program_.phase_ == Interpreter::Phase::running) put(Kind::block_stop);
    return true;
}

bool BlockRun::rotary() noexcept {
    if (program_.options_.rotary == InterpreterOptions::Rotary::offered) return true;
    for (std::size_t axis = linear_axes; axis < axis_count; ++axis)
        if (has(axis_letters[axis])) return fail(FaultKind::rotary_word, block_.column_of(axis_letters[axis]));
    return true;
}

bool BlockRun::feed_mode() noexcept {
    if (g(Group::feed_mode) < 0) return true;
    const auto wanted = g(Group::feed_mode) == 930 ? FeedMode::inverse_time : FeedMode::per_minute;
    if (wanted != state_.feed_mode) state_.feed = 0;
    state_.feed_mode = wanted;
    return true;
}

bool BlockRun::feed() noexcept {
    // Under G93 it belongs to the move of this block and is taken there.
    if (!has('F') || state_.feed_mode == FeedMode::inverse_time) return true;
    double value = 0;
    if (!take('F', value)) return false;
    if (value < 0) return fail(FaultKind::negative, block_.column_of('F'));
    const auto units = g(Group::units);
    if (units >= 0 && (units == 200) != (state_.unit_mm != 1)) {
        fail(FaultKind::feed_with_units, block_.column_of('F'));
        program_.fault_.other = word_at(block_.text, code_column(Group::units));
        return false;
    }
    state_.feed = value, state_.feed_unit_mm = state_.unit_mm;
    return true;
}

bool BlockRun::speed_and_tool() noexcept {
    auto& out = program_.outputs_;
    if (has('S')) {
        double value = 0;
        if (!take('S', value)) return false;
        if (value < 0) return fail(FaultKind::negative, block_.column_of('S'));
        out.speed = value;
        const bool turns = out.spindle != ProgramOutputs::Spindle::off && g(Group::spindle) < 0;
        if (turns) put(Kind::spindle_speed, 0, value);
    }
    if (has('T')) {
        std::uint32_t tool = 0;
        if (!take_whole('T', 99999, tool)) return false;
        out.selected = tool;
        put(Kind::tool_prepare, tool);
    }
    return true;
}

bool BlockRun::machine_words() noexcept {
    auto& out = program_.outputs_;
    if (g(Group::tool_change) == 6) {
        if (out.selected < 0) {
            fail(FaultKind::no_tool, code_column(Group::tool_change));
            program_.fault_.reason = "none was selected with T";
            return false;
        }
        out.tool = static_cast<std::uint32_t>(out.selected);
        put(Kind::tool_change, out.tool);
    }
    switch (const int number = g(Group::spindle); number) {
        case 3:
        case 4:
            if (out.speed < 0) return fail(FaultKind::no_speed, code_column(Group::spindle));
            out.spindle = number == 3 ? ProgramOutputs::Spindle::clockwise : ProgramOutputs::Spindle::counter;
            put(number == 3 ? Kind::spindle_clockwise : Kind::spindle_counter, 0, out.speed);
            break;
        case 5:
            out.spindle = ProgramOutputs::Spindle::off;
            put(Kind::spindle_off);
            break;
        default: break;
    }
    switch (g(Group::coolant)) {
        case 7: out.mist = true, put(Kind::mist); break;
        case 8: out.flood = true, put(Kind::flood); break;
        case 9: out.mist = out.flood = false, put(Kind::coolant_off); break;
        default: break;
    }
    return true;
}

bool BlockRun::user_word() noexcept {
    const int number = g(Group::user);
    if (number < 0) return true;
    double p = std::numeric_limits<double>::quiet_NaN(), q = p;
    if (has('P') && !take('P', p)) return false;
    if (has('Q') && !take('Q', q)) return false;
    if (program_.phase_ == Interpreter::Phase::skipping) ++program_.outputs_.user_codes_left_out;
    put(Kind::user, static_cast<std::uint32_t>(number), p, q);
    return true;
}

bool BlockRun::dwell() noexcept {
    if (g(Group::non_modal) != 40) return true;
    const auto column = code_column(Group::non_modal);
    if (!has('P')) return fail_missing(column, "P, the time in seconds");
    double seconds = 0;
    if (!take('P', seconds)) return false;
    if (seconds < 0) return fail(FaultKind::negative, block_.column_of('P'));
    auto out = item(ItemKind::dwell);
    out.seconds = seconds;
    program_.emit(out);
    return true;
}

void BlockRun::plane_and_units() noexcept {
    switch (g(Group::plane)) {
        case 170: state_.plane = {0, 1, 2}; break;
        case 180: state_.plane = {2, 0, 1}; break;
        case 190: state_.plane = {1, 2, 0}; break;
        default: break;
    }
    switch (g(Group::units)) {
        case 200: state_.unit_mm = 25.4; break;
        case 210: state_.unit_mm = 1; break;
        default: break;
    }
}

bool BlockRun::tool_length() noexcept {
    const int code = g(Group::length);
    if (code == 490) state_.length = {};
    if (code != 430) return true;
    const auto column = has('H') ? block_.column_of('H') : code_column(Group::length);
    std::uint32_t number = program_.outputs_.tool;
    if (has('H')) {
        if (!take_whole('H', 99999, number)) return false;
    } else if (number == 0) {
        fail(FaultKind::no_tool, column);
        program_.fault_.reason = "there is no H, and no tool was put in with M6";
        return false;
    }
    state_.length = {};
    if (number == 0) return true;
    for (const auto& tool : program_.options_.tools)
        if (tool.number == number) {
            state_.length = tool.offset;
            return true;
        }
    return fail(FaultKind::unknown_tool, column);
}

bool BlockRun::path_mode() noexcept {
    switch (g(Group::path_mode)) {
        case 610: state_.path = {PathMode::Kind::exact_path}; return true;
        case 611: state_.path = {PathMode::Kind::exact_stop}; return true;
        case 640: break;
        default: return true;
    }
    PathMode mode{PathMode::Kind::blend};
    if (!has('P')) {
        if (has('Q')) return fail_missing(block_.column_of('Q'), "a P beside it");
        state_.path = mode;
        return true;
    }
    double p = 0, q = 0;
    if (!take('P', p)) return false;
    if (p < 0) return fail(FaultKind::negative, block_.column_of('P'));
    if (p == 0) return fail(FaultKind::g64_zero, block_.column_of('P'));
    q = p;
    if (has('Q') && !take('Q', q)) return false;
    if (q < 0) return fail(FaultKind::negative, block_.column_of('Q'));
    mode.deviation_mm = p * state_.unit_mm, mode.merge_mm = q * state_.unit_mm;
    state_.path = mode;
    return true;
}

void BlockRun::modes() noexcept {
    switch (const int code = g(Group::coordinates); code) {
        case -1: break;
        case 591:
        case 592:
        case 593: state_.system = static_cast<std::size_t>(code - 591) + 6; break;
        default: state_.system = static_cast<std::size_t>(code - 540) / 10; break;
    }
    if (g(Group::distance) >= 0) state_.distance = g(Group::distance) == 900 ? Distance::absolute : Distance::relative;
    if (g(Group::arc_distance) >= 0) state_.arc_distance = g(Group::arc_distance) == 901 ? Distance::absolute : Distance::relative;
}

void BlockRun::stop() noexcept {
    auto& program = program_;
    switch (const int number = g(Group::stop); number) {
        case 0: put(Kind::program_stop); break;
        case 1:
            if (program.options_.optional_stop) put(Kind::optional_stop);
            else ++program.counts_.optional_stops;
            break;
        case 2:
        case 30: {
            // RS274: the end switches off what turns and what flows.
            auto& out = program.outputs_;
            if (out.spindle != ProgramOutputs::Spindle::off) put(Kind::spindle_off);
            if (out.mist || out.flood) put(Kind::coolant_off);
            out.spindle = ProgramOutputs::Spindle::off, out.mist = out.flood = false;
            put(Kind::end, static_cast<std::uint32_t>(number));
            program.phase_ = Interpreter::Phase::ended;
            break;
        }
        default: break;
    }
}

}  // namespace taktwerk::gcode
