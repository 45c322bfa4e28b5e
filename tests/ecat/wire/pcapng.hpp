#pragma once
// The packets of a little-endian pcapng file. Any bytes are safe. Source: draft-ietf-opsawg-pcapng (blocks 3 and 6).

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bytes.hpp"

namespace taktwerk::ecat::test {

/// Enhanced and simple packet blocks (types 6 and 3), as views into `file`; everything else is skipped.
inline std::vector<std::span<const std::byte>> parse_pcapng(std::span<const std::byte> file) {
    std::vector<std::span<const std::byte>> packets;
    const auto add = [&](std::span<const std::byte> body, std::size_t header, std::size_t length_at) {
        if (body.size() < header) return;
        packets.push_back(body.subspan(header, std::min<std::size_t>(load_le<std::uint32_t>(body, length_at), body.size() - header)));
    };
    for (std::size_t at = 0; at + 12 <= file.size();) {
        const auto type = load_le<std::uint32_t>(file, at);
        const std::size_t length = load_le<std::uint32_t>(file, at + 4);
        if (length < 12 || length > file.size() - at) break;
        const auto body = file.subspan(at + 8, length - 12);
        if (type == 6) add(body, 20, 12);
        if (type == 3) add(body, 4, 0);
        at += length;
    }
    return packets;
}

}  // namespace taktwerk::ecat::test
