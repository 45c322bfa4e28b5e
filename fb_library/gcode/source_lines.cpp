#include "fb_library/gcode/source_lines.hpp"

#include <cstring>

namespace taktwerk::gcode {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

std::string_view without_blanks(std::string_view text) noexcept {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

SourceLines::Step SourceLines::fail(FaultKind kind, std::uint32_t column) noexcept {
    fault_ = {};
    fault_.kind = kind, fault_.line = number_, fault_.column = column;
    return Step::fault;
}

SourceLines::Step SourceLines::raw_line() noexcept {
    constexpr std::size_t most = longest_line + 1;  // with the CR
    for (;;) {
        const auto waiting = end_ - begin_;
        const auto* from = buffer_.data() + begin_;
        if (const void* found = std::memchr(from + searched_, '\n', waiting - searched_)) {
            auto length = static_cast<std::size_t>(static_cast<const char*>(found) - from);
            begin_ += length + 1, searched_ = 0, ++number_;
            if (length > 0 && from[length - 1] == '\r') --length;
            text_ = {from, length};
            return length > longest_line ? fail(FaultKind::line_too_long, longest_line + 1) : Step::line;
        }
        searched_ = waiting;
        if (waiting > most) {
            ++number_;
            return fail(FaultKind::line_too_long, longest_line + 1);
        }
        if (source_ended_) {
            if (waiting == 0) return Step::end;
            begin_ = end_, searched_ = 0, ++number_;
            text_ = {from, waiting};
            return waiting > longest_line ? fail(FaultKind::line_too_long, longest_line + 1) : Step::line;
        }
        if (begin_ > 0) {
            std::memmove(buffer_.data(), from, waiting);
            begin_ = 0, end_ = waiting;
        }
        const auto piece = source_->read({buffer_.data() + end_, buffer_.size() - end_});
        switch (piece.state) {
            case TextState::some: end_ += piece.bytes; break;
            case TextState::none_yet: return Step::need_text;
            case TextState::end: source_ended_ = true; break;
            case TextState::failed: ++number_; return fail(FaultKind::read_failed, 0);
        }
    }
}

SourceLines::Step SourceLines::next() noexcept {
    if (fault_.kind != FaultKind::none) return Step::fault;
    for (;;) {
        if (const auto step = raw_line(); step != Step::line) return step;
        if (number_ == 1 && text_.starts_with(byte_order_mark)) text_.remove_prefix(byte_order_mark.size());
        const auto words = without_blanks(text_);
        if (tape_ == Tape::closed) {
            if (!words.empty()) return fail(FaultKind::text_behind_percent, static_cast<std::uint32_t>(words.data() - text_.data()) + 1);
            continue;
        }
        if (words == "%") {
            if (tape_ == Tape::plain) return fail(FaultKind::percent_unopened, static_cast<std::uint32_t>(words.data() - text_.data()) + 1);
            tape_ = tape_ == Tape::before ? Tape::open : Tape::closed;
            continue;
        }
        if (tape_ == Tape::before && !words.empty()) tape_ = Tape::plain;
        return Step::line;
    }
}

}  // namespace taktwerk::gcode
