#pragma once
// What a page makes of the text of an answer: the bytes, the doubles in it.

#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace taktwerk::hmi {

inline std::string bytes_of(const std::string& text) {
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0, held = 0;
    for (const char c : text) {
        const auto digit = letters.find(c);
        if (digit == std::string_view::npos) break;  // padding
        bits = bits << 6 | static_cast<unsigned>(digit);
        held += 6;
        if (held < 8) continue;
        held -= 8;
        bytes += static_cast<char>(bits >> held & 0xFF);
    }
    return bytes;
}

inline std::vector<double> numbers_of(const std::string& text) {
    const auto bytes = bytes_of(text);
    std::vector<double> out(bytes.size() / sizeof(double));
    if (!out.empty()) std::memcpy(out.data(), bytes.data(), out.size() * sizeof(double));
    return out;
}

}  // namespace taktwerk::hmi
