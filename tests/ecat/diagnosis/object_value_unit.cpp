// Values as text and back. Expected bytes and texts worked out by hand.

#include "ecat/diagnosis/object_value.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace taktwerk::ecat {
namespace {

using Bytes = std::vector<std::byte>;

Bytes bytes(std::initializer_list<int> values) {
    Bytes out;
    for (const int v : values) out.push_back(static_cast<std::byte>(v));
    return out;
}

TEST(ObjectValue, NumbersAreShownByTheirType) {
    EXPECT_EQ(value_text(coe_type::integer8, bytes({0xF4})), "-12");
    EXPECT_EQ(value_text(coe_type::unsigned16, bytes({0x34, 0x12})), "4660 (1234h)");
    EXPECT_EQ(value_text(coe_type::unsigned8, bytes({7})), "7");
    EXPECT_EQ(value_text(coe_type::boolean, bytes({1})), "TRUE");
    EXPECT_EQ(value_text(coe_type::real32, bytes({0, 0, 0x20, 0x41})), "10");  // IEEE 754: 41200000h
    EXPECT_EQ(value_text(coe_type::visible_string, bytes({'S', 'V', 0})), "'SV'");
    EXPECT_EQ(value_text(coe_type::unknown, bytes({0x01, 0x02})), "513 (0201h)");
}

TEST(ObjectValue, AValueOfAnotherSizeThanItsTypeIsShownAsBytes) {
    EXPECT_EQ(value_text(coe_type::unsigned32, bytes({1, 2})), "01 02");
    EXPECT_EQ(value_text(coe_type::octet_string, {}), "(empty)");
}

TEST(ObjectValue, WrittenValuesBecomeLittleEndianBytes) {
    const auto is = [](std::uint16_t type, const char* text, const Bytes& expected) {
        const auto value = parse_value(type, text);
        return value && *value == expected;
    };
    EXPECT_TRUE(is(coe_type::integer16, "-5", bytes({0xFB, 0xFF})));
    EXPECT_TRUE(is(coe_type::unsigned32, "0x1234", bytes({0x34, 0x12, 0, 0})));
    EXPECT_TRUE(is(coe_type::unsigned16, "1234h", bytes({0x34, 0x12})));
    EXPECT_TRUE(is(coe_type::integer8, "FFh", bytes({0xFF}))) << "hexadecimal is a bit pattern";
    EXPECT_TRUE(is(coe_type::real32, "10", bytes({0, 0, 0x20, 0x41})));
    EXPECT_TRUE(is(coe_type::boolean, "true", bytes({1})));
    EXPECT_TRUE(is(coe_type::octet_string, "0A 1bFF", bytes({0x0A, 0x1B, 0xFF})));
    EXPECT_TRUE(is(coe_type::visible_string, "ab", bytes({'a', 'b'})));
}

TEST(ObjectValue, WhatDoesNotFitIsRefused) {
    for (const auto& [type, text] : {std::pair{coe_type::unsigned8, "256"},
                                     {coe_type::unsigned8, "-1"},
                                     {coe_type::integer8, "128"},
                                     {coe_type::integer8, "-129"},
                                     {coe_type::unsigned16, "12x"},
                                     {coe_type::unsigned16, ""},
                                     {coe_type::boolean, "2"},
                                     {coe_type::real64, "one"},
                                     {coe_type::octet_string, "0A1"}}) {
        const auto value = parse_value(type, text);
        ASSERT_FALSE(value) << text;
        EXPECT_EQ(value.error().code, "sdo.value");
    }
}

TEST(ObjectValue, TypesAreKnownByBothNames) {
    EXPECT_EQ(type_number("u16"), coe_type::unsigned16);
    EXPECT_EQ(type_number("UINT"), coe_type::unsigned16);
    EXPECT_EQ(type_number("lint"), coe_type::integer64);
    EXPECT_FALSE(type_number("word"));
    EXPECT_EQ(type_name(coe_type::bit1 + 2), "BIT3");
}

// 3 bits from bit 6 of B1h 02h: 1011'0001, 0000'0010 -> bits 6, 7 are 0, 1 and bit 8 is 0: 010b.
TEST(ObjectValue, BitsAreTakenAcrossByteBorders) { EXPECT_EQ(bits_of(bytes({0xB1, 0x02}), 6, 3), bytes({0x02})); }

}  // namespace
}  // namespace taktwerk::ecat
