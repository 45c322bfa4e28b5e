#include "modbus/tcp/channel_words.hpp"

namespace taktwerk::modbus::tcp {

namespace {

std::size_t high_place(WordOrder order) noexcept { return order == WordOrder::high_first ? 0 : 1; }

}  // namespace

std::int64_t word_of(const Channel& channel, std::span<const std::uint16_t> values) noexcept {
    const auto both = [&] {
        const auto high = high_place(channel.order);
        return static_cast<std::uint32_t>(values[high]) << 16 | values[1 - high];
    };
    switch (channel.type) {
        case NumberType::boolean: return is_bits(channel.table) ? (values[0] != 0 ? 1 : 0) : values[0] >> channel.bit & 1;
        case NumberType::uint16: return values[0];
        case NumberType::int16: return static_cast<std::int16_t>(values[0]);
        case NumberType::uint32: return both();
        case NumberType::int32:
        case NumberType::float32: break;
    }
    return static_cast<std::int32_t>(both());
}

void put_word(const Channel& channel, std::int64_t word, std::span<std::uint16_t> values) noexcept {
    const auto bits = static_cast<std::uint64_t>(word);
    if (channel.type == NumberType::boolean) {
        values[0] = static_cast<std::uint16_t>(is_bits(channel.table) ? (word != 0 ? 1 : 0) : (word != 0 ? 1u << channel.bit : 0u));
    } else if (addresses_of(channel.type) == 1) {
        values[0] = static_cast<std::uint16_t>(bits & 0xFFFF);
    } else {
        const auto high = high_place(channel.order);
        values[high] = static_cast<std::uint16_t>(bits >> 16 & 0xFFFF);
        values[1 - high] = static_cast<std::uint16_t>(bits & 0xFFFF);
    }
}

Signal signal_of(NumberType type) noexcept {
    switch (type) {
        case NumberType::boolean: return {0, 1, false};
        case NumberType::uint16: return {0, 16, false};
        case NumberType::int16: return {0, 16, true};
        case NumberType::uint32: return {0, 32, false};
        case NumberType::int32:
        case NumberType::float32: break;
    }
    return {0, 32, true};
}

}  // namespace taktwerk::modbus::tcp
