// Registers and the numbers in them. Expected values by hand; IEEE 754: 3.5 is 40600000h, -2 is C0000000h.

#include "modbus/tcp/channel_words.hpp"

#include <gtest/gtest.h>

#include <array>

#include "core/point_line.hpp"

namespace taktwerk::modbus::tcp {
namespace {

Channel channel_of(NumberType type, WordOrder order = WordOrder::high_first, Table table = Table::holding) {
    Channel channel;
    channel.type = type, channel.order = order, channel.table = table;
    return channel;
}

struct Known {
    NumberType type;
    WordOrder order;
    std::array<std::uint16_t, 2> registers;
    std::int64_t word;
};

TEST(ChannelWords, KnownNumbersBothWays) {
    using enum NumberType;
    using enum WordOrder;
    for (const auto& known : {
             Known{uint16, high_first, {0xFFFE, 0}, 65534},
             Known{int16, high_first, {0xFFFE, 0}, -2},
             Known{int16, high_first, {0x7FFF, 0}, 32767},
             Known{uint32, high_first, {0x8000, 0x0001}, 2147483649},
             Known{uint32, low_first, {0x0001, 0x8000}, 2147483649},
             Known{int32, high_first, {0xFFFF, 0xFFFD}, -3},
             Known{int32, low_first, {0xFFFD, 0xFFFF}, -3},
             Known{int32, low_first, {0x86A0, 0x0001}, 100000},
         }) {
        const auto channel = channel_of(known.type, known.order);
        EXPECT_EQ(word_of(channel, known.registers), known.word);
        std::array<std::uint16_t, 2> written{};
        put_word(channel, known.word, written);
        EXPECT_EQ(written, known.registers) << known.word;
    }
}

TEST(ChannelWords, RealNumbersGoThroughTheLineOfAPoint) {
    PointLine line;
    line.number = PointLine::Number::real32;
    for (const auto& [order, registers] :
         {std::pair{WordOrder::high_first, std::array<std::uint16_t, 2>{0x4060, 0x0000}}, {WordOrder::low_first, {0x0000, 0x4060}}}) {
        const auto channel = channel_of(NumberType::float32, order);
        EXPECT_EQ(line.value_of(word_of(channel, registers)), 3.5);
        std::array<std::uint16_t, 2> written{};
        put_word(channel, line.raw_of(3.5), written);
        EXPECT_EQ(written, registers);
        const std::array<std::uint16_t, 2> minus_two{0xC000, 0};
        if (order == WordOrder::high_first) {
            EXPECT_EQ(line.value_of(word_of(channel, minus_two)), -2);
        }
    }
}

TEST(ChannelWords, BitsOfTablesAndOfRegisters) {
    const auto coil = channel_of(NumberType::boolean, {}, Table::coil);
    const std::array<std::uint16_t, 1> on{1}, off{0}, status{0x0008};
    EXPECT_EQ(word_of(coil, on), 1);
    EXPECT_EQ(word_of(coil, off), 0);
    auto bit = channel_of(NumberType::boolean, {}, Table::input);
    for (std::uint8_t n = 0; n < 16; ++n) {
        bit.bit = n;
        EXPECT_EQ(word_of(bit, status), n == 3 ? 1 : 0);
    }
}

TEST(ChannelWords, AreAsWideAsPointsAreTold) {
    EXPECT_EQ(signal_of(NumberType::boolean).bits, 1);
    EXPECT_EQ(signal_of(NumberType::uint16).bits, 16);
    EXPECT_FALSE(signal_of(NumberType::uint16).is_signed);
    EXPECT_TRUE(signal_of(NumberType::int16).is_signed);
    EXPECT_EQ(signal_of(NumberType::float32).bits, 32);
}

}  // namespace
}  // namespace taktwerk::modbus::tcp
