#pragma once
// The numbers of the format that recording_file.hpp describes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/bytes.hpp"
#include "core/crc32.hpp"

namespace taktwerk::runtime::recording_format {

inline constexpr std::array<char, 6> magic{'T', 'W', 'R', 'E', 'C', '\0'};
inline constexpr std::size_t preamble_bytes = 16, block_head = 12, end_bytes = 9;
inline constexpr std::uint8_t next_part_goes_on = 0xFF;
/// As much as one block can become, and some.
inline constexpr std::size_t most_packed_bytes = std::size_t{40} << 20;

/// Of the first eight bytes of its head, and of what stands behind the head.
[[nodiscard]] inline std::uint32_t block_sum(std::span<const std::byte> head, std::span<const std::byte> bytes) {
    return crc32(bytes, crc32(head.first(8)));
}

}  // namespace taktwerk::runtime::recording_format
