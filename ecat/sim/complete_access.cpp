#include "ecat/sim/complete_access.hpp"

#include <algorithm>

namespace taktwerk::ecat::sim {

std::size_t pack_object(std::span<const Entry> object, std::uint8_t first, std::span<std::byte> out) noexcept {
    const std::size_t bits = for_each_place(object, first, [](const Entry&, std::size_t) {});
    const std::size_t bytes = (bits + 7) / 8;
    if (bytes > out.size()) return 0;
    std::fill_n(out.begin(), bytes, std::byte{0});
    for_each_place(object, first, [&](const Entry& entry, std::size_t bit) {
        if (entry.access() == Access::wo) return;
        const std::size_t at = bit / 8;
        if (entry.type() == DataType::STRING) {
            std::transform(entry.text().begin(), entry.text().end(), out.begin() + static_cast<std::ptrdiff_t>(at),
                           [](char c) { return static_cast<std::byte>(c); });
            return;
        }
        const auto value = static_cast<std::uint64_t>(entry.get());
        if (entry.type() == DataType::BOOL) {
            out[at] |= static_cast<std::byte>((value & 1u) << (bit % 8));
            return;
        }
        for (std::size_t i = 0; i < entry.byte_size(); ++i) out[at + i] = static_cast<std::byte>((value >> (8 * i)) & 0xFFu);
    });
    return bytes;
}

std::int64_t value_at(const Entry& entry, std::span<const std::byte> data, std::size_t bit) noexcept {
    if (entry.type() == DataType::BOOL) return (static_cast<unsigned>(data[bit / 8]) >> (bit % 8)) & 1;
    std::uint64_t raw = 0;
    const std::size_t size = entry.byte_size();
    for (std::size_t i = 0; i < size; ++i) raw |= static_cast<std::uint64_t>(data[bit / 8 + i]) << (8 * i);
    if (entry.is_signed() && size > 0 && size < 8 && (raw >> (8 * size - 1) & 1u) != 0) raw |= ~std::uint64_t{0} << (8 * size);
    return static_cast<std::int64_t>(raw);
}

}  // namespace taktwerk::ecat::sim
