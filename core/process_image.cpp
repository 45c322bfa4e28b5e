#include "core/process_image.hpp"

#include "core/bytes.hpp"

namespace taktwerk {
namespace {

constexpr std::uint64_t low_bits(unsigned bits) noexcept { return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1; }

constexpr std::uint64_t octet(std::byte b) noexcept { return std::to_integer<std::uint64_t>(b); }

/// Touches only the bytes the signal covers (1..9): the last signal of an image has nothing behind it.
std::uint64_t read_any(std::span<const std::byte> image, std::size_t first, unsigned shift, unsigned bits) noexcept {
    const std::size_t count = (shift + bits + 7) / 8;
    std::uint64_t value = octet(image[first]) >> shift;
    for (std::size_t i = 1; i < count; ++i) value |= octet(image[first + i]) << (8 * i - shift);
    return value & low_bits(bits);
}

void write_any(std::span<std::byte> image, std::size_t first, unsigned shift, unsigned bits, std::uint64_t value) noexcept {
    unsigned left = bits;
    for (std::size_t at = first; left > 0; ++at, shift = 0) {
        const unsigned here = left < 8 - shift ? left : 8 - shift;
        const auto mask = static_cast<unsigned>(low_bits(here) << shift);
        const auto fresh = static_cast<unsigned>(value << shift) & mask;
        image[at] = static_cast<std::byte>((std::to_integer<unsigned>(image[at]) & ~mask) | fresh);
        value >>= here;
        left -= here;
    }
}

}  // namespace

std::int64_t read_signal(std::span<const std::byte> image, const Signal& signal) noexcept {
    const std::size_t first = signal.bit_offset / 8;
    const unsigned shift = signal.bit_offset % 8;
    if (shift == 0) {
        switch (signal.bits) {
            case 8: return signal.is_signed ? load_le<std::int8_t>(image, first) : load_le<std::uint8_t>(image, first);
            case 16: return signal.is_signed ? load_le<std::int16_t>(image, first) : load_le<std::uint16_t>(image, first);
            case 32:
                return signal.is_signed ? std::int64_t{load_le<std::int32_t>(image, first)}
                                        : std::int64_t{load_le<std::uint32_t>(image, first)};
            case 64: return load_le<std::int64_t>(image, first);
            default: break;
        }
    }
    if (!signal.mapped()) return 0;
    const std::uint64_t raw = read_any(image, first, shift, signal.bits);
    if (!signal.is_signed || signal.bits >= 64) return static_cast<std::int64_t>(raw);
    const std::uint64_t sign = std::uint64_t{1} << (signal.bits - 1);
    return static_cast<std::int64_t>((raw ^ sign) - sign);
}

void write_signal(std::span<std::byte> image, const Signal& signal, std::int64_t value) noexcept {
    const std::size_t first = signal.bit_offset / 8;
    const unsigned shift = signal.bit_offset % 8;
    if (shift == 0) {
        switch (signal.bits) {
            case 8: return store_le(image, first, static_cast<std::uint8_t>(value));
            case 16: return store_le(image, first, static_cast<std::uint16_t>(value));
            case 32: return store_le(image, first, static_cast<std::uint32_t>(value));
            case 64: return store_le(image, first, value);
            default: break;
        }
    }
    if (signal.mapped()) write_any(image, first, shift, signal.bits, static_cast<std::uint64_t>(value));
}

}  // namespace taktwerk
