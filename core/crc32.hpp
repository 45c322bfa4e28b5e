#pragma once
// CRC-32 as in IEEE 802.3 and zlib (reflected, polynomial 04C11DB7h, start and final XOR FFFFFFFFh).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace taktwerk {

namespace detail {
constexpr std::array<std::uint32_t, 256> make_crc32_table() noexcept {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
        std::uint32_t c = i;
        for (int k = 0; k < 8; ++k) c = (c & 1u) != 0 ? 0xEDB88320u ^ (c >> 1) : c >> 1;
        table[i] = c;
    }
    return table;
}
inline constexpr auto crc32_table = make_crc32_table();
}  // namespace detail

/// Real-time safe. Of pieces: pass the result for the bytes so far as `before`.
[[nodiscard]] constexpr std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before = 0) noexcept {
    std::uint32_t c = ~before;
    for (const std::byte b : bytes) c = detail::crc32_table[(c ^ std::to_integer<std::uint32_t>(b)) & 0xFFu] ^ (c >> 8);
    return ~c;
}

}  // namespace taktwerk
