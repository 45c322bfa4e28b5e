#include "core/one_line.hpp"

#include <algorithm>

namespace taktwerk {

namespace {

/// C0, C1 and DEL; U+2028, U+2029; U+FEFF, the byte order mark.
bool is_control(std::string_view character) noexcept {
    const auto first = static_cast<unsigned char>(character.front());
    if (character.size() == 1) return first < 0x20 || first == 0x7F;
    if (character.size() == 2) return first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0;
    return character == "\xE2\x80\xA8" || character == "\xE2\x80\xA9" || character == "\xEF\xBB\xBF";
}

}  // namespace

std::size_t utf8_length(std::string_view text, std::size_t at) noexcept {
    const auto byte = [&](std::size_t n) { return at + n < text.size() ? static_cast<unsigned char>(text[at + n]) : 0u; };
    const auto tail = [&](std::size_t n) { return (byte(n) & 0xC0u) == 0x80u; };
    const unsigned first = byte(0);
    if (first < 0x80) return 1;
    if (first >= 0xC2 && first < 0xE0) return tail(1) ? 2 : 0;
    if (first >= 0xE0 && first < 0xF0)
        return tail(1) && tail(2) && !(first == 0xE0 && byte(1) < 0xA0) && !(first == 0xED && byte(1) >= 0xA0) ? 3 : 0;
    if (first >= 0xF0 && first < 0xF5)
        return tail(1) && tail(2) && tail(3) && !(first == 0xF0 && byte(1) < 0x90) && !(first == 0xF4 && byte(1) >= 0x90) ? 4 : 0;
    return 0;
}

std::string on_one_line(std::string_view utf8) {
    std::string out;
    for (std::size_t at = 0; at < utf8.size();) {
        const auto length = utf8_length(utf8, at);
        const auto character = utf8.substr(at, std::max<std::size_t>(length, 1));
        at += character.size();
        if (length == 0) continue;
        if (is_control(character)) out += ' ';
        else out += character;
    }
    return out;
}

}  // namespace taktwerk
