#include "apps/terminal/terminal_text.hpp"

#include <cstdint>

namespace taktwerk::apps {
namespace {

struct Character {
    std::size_t bytes, width;
};

/// The character at the front; a broken byte counts as one column.
Character front(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text.front());
    const std::size_t bytes = lead < 0x80 ? 1 : lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 1;
    if (bytes > text.size() || bytes == 1) return {1, 1};
    std::uint32_t code = lead & (0xFFu >> (bytes + 1));
    for (std::size_t i = 1; i < bytes; ++i) code = code << 6 | (static_cast<unsigned char>(text[i]) & 0x3Fu);
    // Unicode Annex 11, as far as our texts go: CJK punctuation, ideographs, Hangul, fullwidth forms.
    const bool wide = (code >= 0x2E80 && code <= 0xA4CF) || (code >= 0xAC00 && code <= 0xD7A3) || (code >= 0xF900 && code <= 0xFAFF) ||
                      (code >= 0xFE30 && code <= 0xFE6F) || (code >= 0xFF00 && code <= 0xFF60) || (code >= 0xFFE0 && code <= 0xFFE6) ||
                      (code >= 0x20000 && code <= 0x3FFFD);
    return {bytes, wide ? 2u : 1u};
}

}  // namespace

std::size_t columns(std::string_view text) {
    std::size_t width = 0;
    while (!text.empty()) {
        const auto next = front(text);
        width += next.width;
        text.remove_prefix(next.bytes);
    }
    return width;
}

std::string cut(std::string_view text, std::size_t width) {
    if (columns(text) <= width) return std::string(text);
    if (width == 0) return {};
    std::size_t used = 0, bytes = 0;
    while (bytes < text.size()) {
        const auto next = front(text.substr(bytes));
        if (used + next.width > width - 1) break;
        used += next.width;
        bytes += next.bytes;
    }
    return std::string(text.substr(0, bytes)) + "…";
}

std::string left(std::string_view text, std::size_t width) {
    auto out = cut(text, width);
    out.append(width - columns(out), ' ');
    return out;
}

std::string right(std::string_view text, std::size_t width) {
    const auto shown = cut(text, width);
    return std::string(width - columns(shown), ' ') + shown;
}

}  // namespace taktwerk::apps
