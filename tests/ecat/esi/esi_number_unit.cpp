// Numbers and bytes as ETG.2000 writes them (HexDecValue, hexBinary), and as files in the field do.

#include "ecat/esi/esi_number.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ecat/esi/base_type.hpp"

namespace taktwerk::ecat::esi {
namespace {

using testing::ElementsAre;
using testing::Optional;

TEST(EsiNumber, IsDecimalOrHexadecimalBehindAMark) {
    EXPECT_THAT(parse_number("16"), Optional(16));
    EXPECT_THAT(parse_number("-1000000"), Optional(-1'000'000));
    EXPECT_THAT(parse_number("#x1A2b"), Optional(0x1A2B));
    EXPECT_THAT(parse_number("0x1a"), Optional(26));
    EXPECT_THAT(parse_number("#X10"), Optional(16));
    EXPECT_THAT(parse_number(" \n\t42 "), Optional(42));
    EXPECT_THAT(parse_number("010"), Optional(10)) << "a leading zero is not octal";
}

TEST(EsiNumber, TwoMarksAsSomeVendorsWriteThemAreOne) { EXPECT_THAT(parse_number("#x0x6041"), Optional(0x6041)); }

TEST(EsiNumber, IsNothingElse) {
    for (const char* text : {"", " ", "#x", "0x", "x10", "1A", "#x12G", "1.5", "12 34", "#x10000000000000000", "--1", "-#x10", "#x-1"})
        EXPECT_FALSE(parse_number(text)) << text;
}

TEST(EsiNumber, SixtyFourBitsAreKept) {
    EXPECT_THAT(parse_number("#xFFFFFFFFFFFFFFFF"), Optional(-1));
    EXPECT_THAT(parse_number("18446744073709551615"), Optional(-1));
    EXPECT_FALSE(parse_number("18446744073709551616"));
}

TEST(EsiBytes, ArePairsOfDigits) {
    const auto bytes = parse_bytes(" 0A 0b\nff");
    ASSERT_TRUE(bytes);
    EXPECT_THAT(*bytes, ElementsAre(std::byte{0x0A}, std::byte{0x0B}, std::byte{0xFF}));
    EXPECT_THAT(parse_bytes(""), Optional(testing::IsEmpty()));
    EXPECT_FALSE(parse_bytes("0A0"));
    EXPECT_FALSE(parse_bytes("0g"));
}

TEST(EsiFlag, IsAnXsBoolean) {
    EXPECT_THAT(parse_flag("1"), Optional(true));
    EXPECT_THAT(parse_flag(" true"), Optional(true));
    EXPECT_THAT(parse_flag("0"), Optional(false));
    EXPECT_THAT(parse_flag("false"), Optional(false));
    EXPECT_FALSE(parse_flag("2"));
    EXPECT_FALSE(parse_flag(""));
}

// ETG.1020, data types: names of IEC 61131-3 and bits.
TEST(EsiBaseType, OfTheStandardAndOfCia301) {
    EXPECT_THAT(basic_type("BOOL"), Optional(DataType::BOOL));
    EXPECT_THAT(basic_type("BIT3"), Optional(DataType::U8));
    EXPECT_THAT(basic_type("BIT12"), Optional(DataType::U16));
    EXPECT_THAT(basic_type("USINT"), Optional(DataType::U8));
    EXPECT_THAT(basic_type("SINT"), Optional(DataType::I8));
    EXPECT_THAT(basic_type("DINT"), Optional(DataType::I32));
    EXPECT_THAT(basic_type("ULINT"), Optional(DataType::U64));
    EXPECT_THAT(basic_type("LREAL"), Optional(DataType::REAL64));
    EXPECT_THAT(basic_type("STRING(20)"), Optional(DataType::STRING));
    EXPECT_THAT(basic_type("INTEGER16"), Optional(DataType::I16));
    EXPECT_FALSE(basic_type("UINT24"));
    EXPECT_FALSE(basic_type("ARRAY [0..3] OF BYTE"));
    EXPECT_FALSE(basic_type(""));
}

}  // namespace
}  // namespace taktwerk::ecat::esi
