#pragma once
// A program's lines out of pieces of text, with what a tape puts around them: % before and behind, a byte order mark. Bounded memory, no allocation; linear in the bytes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fb_library/gcode/fault.hpp"
#include "fb_library/gcode/text_source.hpp"

namespace taktwerk::gcode {

/// Bytes of a line without its end (LF or CR LF). RS274's own limit.
inline constexpr std::size_t longest_line = 256;

class SourceLines {
public:
    enum class Step : std::uint8_t {
        line,       ///< text() is the next one
        need_text,  ///< the source has nothing now
        end,        ///< behind the closing %, or the last line
        fault,      ///< fault() says what; stays
    };

    explicit SourceLines(TextSource& source) noexcept : source_(&source) {}

    /// Blank lines come too. Faults: read_failed, line_too_long, percent_unopened, text_behind_percent.
    Step next() noexcept;
    /// Valid until the next call; without its end.
    [[nodiscard]] std::string_view text() const noexcept { return text_; }
    [[nodiscard]] std::uint32_t number() const noexcept { return number_; }  ///< of that line, from 1
    /// Whether a % closed the program.
    [[nodiscard]] bool closed() const noexcept { return tape_ == Tape::closed; }
    [[nodiscard]] const Fault& fault() const noexcept { return fault_; }

private:
    enum class Tape : std::uint8_t { before, open, plain, closed };

    Step raw_line() noexcept;
    Step fail(FaultKind kind, std::uint32_t column) noexcept;

    TextSource* source_;
    std::array<char, 8192> buffer_{};
    std::size_t begin_ = 0, end_ = 0, searched_ = 0;
    bool source_ended_ = false;
    Tape tape_ = Tape::before;
    std::string_view text_;
    std::uint32_t number_ = 0;
    Fault fault_;
};

}  // namespace taktwerk::gcode
