#pragma once
// Where a program's text comes from: a file, a ring that another thread fills, a text in memory. Asked for pieces, whenever the reader has room.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace taktwerk::gcode {

enum class TextState : std::uint8_t {
    some,      ///< at least one byte
    none_yet,  ///< nothing now, there may be more later
    end,       ///< nothing any more
    failed,    ///< it cannot be read; the source knows why
};

struct TextPiece {
    TextState state = TextState::end;
    std::size_t bytes = 0;
};

class TextSource {
public:
    TextSource() = default;
    TextSource(const TextSource&) = delete;
    TextSource& operator=(const TextSource&) = delete;
    virtual ~TextSource() = default;
    /// Puts bytes at the front of `into`, which has room for at least one.
    virtual TextPiece read(std::span<char> into) noexcept = 0;
};

/// A text that somebody else keeps.
class TextInMemory final : public TextSource {
public:
    /// `piece`: most bytes that are given at once.
    explicit TextInMemory(std::string_view text, std::size_t piece = 4096) noexcept : text_(text), piece_(piece) {}
    TextPiece read(std::span<char> into) noexcept override {
        const auto bytes = std::min({into.size(), text_.size(), piece_});
        std::copy_n(text_.begin(), bytes, into.begin());
        text_.remove_prefix(bytes);
        return {bytes > 0 ? TextState::some : TextState::end, bytes};
    }

private:
    std::string_view text_;
    std::size_t piece_;
};

}  // namespace taktwerk::gcode
