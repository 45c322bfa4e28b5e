#pragma once
// The frame check of Modbus RTU: CRC-16, reflected, polynomial A001h, start FFFFh (XP200 manual 9.3, steps one to five). The example
// printed there (3794h for 01 03 00 05 00 02) contradicts those steps: they give 0AD4h; 3794h belongs to 01 03 01 01 00 02.

#include <cstddef>
#include <cstdint>
#include <span>

namespace taktwerk::modbus {

/// On the wire its low byte comes first. Real-time safe.
[[nodiscard]] constexpr std::uint16_t crc16(std::span<const std::byte> bytes) noexcept {
    unsigned crc = 0xFFFF;
    for (const std::byte b : bytes) {
        crc ^= std::to_integer<unsigned>(b);
        for (int bit = 0; bit < 8; ++bit) crc = (crc & 1u) != 0 ? (crc >> 1) ^ 0xA001u : crc >> 1;
    }
    return static_cast<std::uint16_t>(crc);
}

}  // namespace taktwerk::modbus
