// Numbers as registers. Bytes of int16 and of two registers by hand; float32 by IEEE 754.
#include "modbus/server/register_words.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace taktwerk::modbus::server {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double endless = std::numeric_limits<double>::infinity();

ServedRegister of(NumberType type, WordOrder order = WordOrder::high_first) {
    ServedRegister r;
    r.type = type;
    r.order = order;
    return r;
}

TEST(RegisterWords, ANumberIsItsNearestWholeOne) {
    EXPECT_EQ(words_of(of(NumberType::uint16), 1234.4)[0], 1234);
    EXPECT_EQ(words_of(of(NumberType::uint16), 1234.5)[0], 1235);
    EXPECT_EQ(words_of(of(NumberType::int16), -1)[0], 0xFFFF);
    EXPECT_EQ(words_of(of(NumberType::int32), -2), (RegisterWords{0xFFFF, 0xFFFE}));
    EXPECT_EQ(words_of(of(NumberType::uint32), 0x12345678), (RegisterWords{0x1234, 0x5678}));
    EXPECT_EQ(words_of(of(NumberType::uint32, WordOrder::low_first), 0x12345678), (RegisterWords{0x5678, 0x1234}));
}

// 1.0f is 3F80 0000h, -12.5f is C148 0000h.
TEST(RegisterWords, ARealNumberIsItsBitPattern) {
    EXPECT_EQ(words_of(of(NumberType::float32), 1), (RegisterWords{0x3F80, 0}));
    EXPECT_EQ(words_of(of(NumberType::float32, WordOrder::low_first), -12.5), (RegisterWords{0, 0xC148}));
    EXPECT_EQ(words_of(of(NumberType::float32), 1e300), (RegisterWords{0x7F80, 0})) << "infinity";
    EXPECT_EQ(words_of(of(NumberType::float32), -endless), (RegisterWords{0xFF80, 0}));
    EXPECT_TRUE(std::isnan(number_of(of(NumberType::float32), words_of(of(NumberType::float32), nan_value))));
}

TEST(RegisterWords, WhatDoesNotFitShowsAsTheEndOfTheRange) {
    EXPECT_EQ(words_of(of(NumberType::uint16), -3)[0], 0);
    EXPECT_EQ(words_of(of(NumberType::uint16), 70000)[0], 0xFFFF);
    EXPECT_EQ(words_of(of(NumberType::int16), 40000)[0], 0x7FFF);
    EXPECT_EQ(words_of(of(NumberType::int16), -endless)[0], 0x8000);
    EXPECT_EQ(words_of(of(NumberType::int32), 3e9), (RegisterWords{0x7FFF, 0xFFFF}));
    EXPECT_EQ(words_of(of(NumberType::uint32), endless), (RegisterWords{0xFFFF, 0xFFFF}));
}

TEST(RegisterWords, WhatIsNotANumberIsTheValueThatNoGoodOneHas) {
    EXPECT_EQ(words_of(of(NumberType::uint16), nan_value)[0], 0xFFFF);
    EXPECT_EQ(words_of(of(NumberType::int16), nan_value)[0], 0x8000);
    EXPECT_EQ(words_of(of(NumberType::int32), nan_value), (RegisterWords{0x8000, 0}));
    EXPECT_EQ(words_of(of(NumberType::uint32), nan_value), (RegisterWords{0xFFFF, 0xFFFF}));
}

TEST(RegisterWords, ABitStandsInItsPlace) {
    auto bit = of(NumberType::boolean);
    bit.bit = 3;
    EXPECT_EQ(words_of(bit, 7)[0], 8);
    EXPECT_EQ(words_of(bit, 0)[0], 0);
    EXPECT_EQ(words_of(bit, nan_value)[0], 0);
    EXPECT_EQ(number_of(bit, {0xFFF7, 0}), 0);
    EXPECT_EQ(number_of(bit, {0x0008, 0}), 1);
    bit.table = Table::coil;
    EXPECT_EQ(words_of(bit, 1)[0], 1) << "a coil is a bit of its own";
}

TEST(RegisterWords, WhatWasWrittenIsReadBack) {
    for (const auto order : {WordOrder::high_first, WordOrder::low_first}) {
        for (const double number : {0.0, 1.0, 32767.0, 65535.0})
            EXPECT_EQ(number_of(of(NumberType::uint32, order), words_of(of(NumberType::uint32, order), number)), number);
        for (const double number : {-2147483648.0, -1.0, 2147483647.0})
            EXPECT_EQ(number_of(of(NumberType::int32, order), words_of(of(NumberType::int32, order), number)), number);
        for (const double number : {-12.5, 0.0, 0.15625})
            EXPECT_EQ(number_of(of(NumberType::float32, order), words_of(of(NumberType::float32, order), number)), number);
    }
    EXPECT_EQ(number_of(of(NumberType::int16), {0x8000, 0}), -32768);
    EXPECT_EQ(number_of(of(NumberType::uint16), {0x8000, 0}), 32768);
}

}  // namespace
}  // namespace taktwerk::modbus::server
