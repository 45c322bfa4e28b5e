#pragma once
// Bytes as text of a JSON line: base64 of RFC 4648, with padding.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace taktwerk::hmi {

inline void append_base64(std::string& out, std::span<const std::byte> bytes) {
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const auto at = [&](std::size_t i) { return std::to_integer<std::uint32_t>(bytes[i]); };
    std::size_t i = 0;
    for (; i + 2 < bytes.size(); i += 3) {
        const auto three = at(i) << 16 | at(i + 1) << 8 | at(i + 2);
        const char four[] = {letters[three >> 18], letters[three >> 12 & 63], letters[three >> 6 & 63], letters[three & 63]};
        out.append(four, 4);
    }
    if (i == bytes.size()) return;
    const bool two = i + 1 < bytes.size();
    const auto rest = at(i) << 16 | (two ? at(i + 1) << 8 : 0);
    const char four[] = {letters[rest >> 18], letters[rest >> 12 & 63], two ? letters[rest >> 6 & 63] : '=', '='};
    out.append(four, 4);
}

}  // namespace taktwerk::hmi
