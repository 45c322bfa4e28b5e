#pragma once
// Where the entries of an object stand in a complete transfer. Source: ETG.1000.6 5.6.2 (complete access): sub-index 0 takes 16
// bits (its 8 and 8 of padding), entries of single bits stand side by side, all others start at a byte.

#include <cstddef>
#include <cstdint>
#include <span>

#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::ecat::sim {

/// Walks over the entries from `first` (0 or 1) on: place(entry, bit offset). Returns the bits of all of them.
template <class Place>
std::size_t for_each_place(std::span<const Entry> object, std::uint8_t first, Place place) {
    std::size_t bit = 0;
    for (const auto& entry : object) {
        if (entry.sub() < first) continue;
        const bool single_bits = entry.type() == DataType::BOOL;
        if (!single_bits) bit = (bit + 7) / 8 * 8;
        place(entry, bit);
        bit += entry.sub() == 0 ? 16 : single_bits ? 1 : entry.byte_size() * 8;
    }
    return bit;
}

/// Values one after the other; what cannot be read is 0. Bytes written; 0 when `out` is too small.
[[nodiscard]] std::size_t pack_object(std::span<const Entry> object, std::uint8_t first, std::span<std::byte> out) noexcept;
/// The value of an entry of at most 64 bits at `bit` in `data`, sign-extended when its type is signed; `data` reaches that far.
[[nodiscard]] std::int64_t value_at(const Entry& entry, std::span<const std::byte> data, std::size_t bit) noexcept;

}  // namespace taktwerk::ecat::sim
