#pragma once
// Explicit little-endian loads and stores: no packed structs, no casts, no alignment traps. Real-time safe.

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace taktwerk {

/// Little-endian value of sizeof(T) bytes at `offset`. The caller has checked the bounds.
template <std::integral T>
[[nodiscard]] constexpr T load_le(std::span<const std::byte> bytes, std::size_t offset = 0) noexcept {
    using U = std::make_unsigned_t<T>;
    U value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) value = static_cast<U>(value | (static_cast<U>(bytes[offset + i]) << (8 * i)));
    return static_cast<T>(value);
}

template <std::integral T>
constexpr void store_le(std::span<std::byte> bytes, std::size_t offset, T value) noexcept {
    using U = std::make_unsigned_t<T>;
    auto rest = static_cast<U>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        bytes[offset + i] = static_cast<std::byte>(rest & 0xFFu);
        if constexpr (sizeof(T) > 1) rest = static_cast<U>(rest >> 8);
    }
}

}  // namespace taktwerk
