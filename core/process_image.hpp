#pragma once
// The bytes a bus exchanges each cycle, and signals in them that were resolved once, before the first cycle.

#include <cstddef>
#include <cstdint>
#include <span>

namespace taktwerk {

/// Where a value lies in an image. Any bit offset, 1..64 bits: PDOs pack 8-bit objects between 32-bit ones.
struct Signal {
    std::uint32_t bit_offset = 0;
    std::uint8_t bits = 0;  ///< 0: not mapped; reads give 0, writes do nothing
    bool is_signed = false;

    [[nodiscard]] constexpr bool mapped() const noexcept { return bits != 0; }
};

/// Value of a signal, sign-extended when it is signed. Real-time safe. The image is at least as long as the signal needs
/// (checked once by whoever resolved it).
[[nodiscard]] std::int64_t read_signal(std::span<const std::byte> image, const Signal& signal) noexcept;

/// Writes the low `bits` bits; neighbours in the same byte are kept. Real-time safe.
void write_signal(std::span<std::byte> image, const Signal& signal, std::int64_t value) noexcept;

}  // namespace taktwerk
