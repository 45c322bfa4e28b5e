// EEPROM images as text; the records here are made by the rules of the specification, their checksums by hand.

#include "apps/bus/intel_hex.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace taktwerk::apps {
namespace {

using ::testing::HasSubstr;

std::vector<std::byte> bytes_of(std::string_view text) {
    std::vector<std::byte> out;
    for (const char c : text) out.push_back(static_cast<std::byte>(c));
    return out;
}

Result<std::vector<std::byte>> parse(std::string_view text, std::size_t most = 64) {
    return parse_intel_hex(bytes_of(text), most, "image.hex");
}

std::string refusal(std::string_view text) {
    const auto parsed = parse(text);
    return parsed ? "taken" : parsed.error().subject + ": " + parsed.error().what;
}

TEST(IntelHex, ReadsRecordsInAnyOrderAndFillsGaps) {
    const auto image = parse(":020004000105F4\r\n:0200000411228DC7\n");
    EXPECT_FALSE(image);  // the second line's length is wrong: nothing of a damaged file counts
    const auto good = parse(":02000400ABCD82\r\n:020000001122CB\r\n\r\n:00000001FF");
    ASSERT_TRUE(good) << good.error().what;
    EXPECT_EQ(*good, bytes_of("\x11\x22\xFF\xFF\xAB\xCD"));
}

TEST(IntelHex, BasesMoveWhatFollows) {
    const auto linear = parse(":020000040001F9\n:010000005AA5\n:00000001FF\n", 0x20000);
    ASSERT_TRUE(linear) << linear.error().what;
    ASSERT_EQ(linear->size(), 0x10001u);
    EXPECT_EQ(linear->back(), std::byte{0x5A});
    const auto segment = parse(":020000020001FB\n:010000005AA5\n:00000001FF\n");
    ASSERT_TRUE(segment) << segment.error().what;
    EXPECT_EQ(segment->size(), 17u);
}

TEST(IntelHex, SaysWhichLineIsWrongAndHow) {
    EXPECT_EQ(refusal(":020000001122CC\n:00000001FF\n"), "image.hex:1: its checksum is CCh, its bytes give CBh");
    EXPECT_THAT(refusal(":020000001122CB\n"), HasSubstr("image.hex:1: the end record"));
    EXPECT_THAT(refusal(":020000001122CB\n:0200"), HasSubstr("image.hex:2: this line is no Intel HEX record"));
    EXPECT_THAT(refusal(":02000000112GCB\n:00000001FF"), HasSubstr("image.hex:1: this line is no"));
    EXPECT_THAT(refusal(":020000001122CB\n:010001005AA4\n:00000001FF"), HasSubstr("image.hex:2: the byte at 0001h has been given before"));
    EXPECT_THAT(refusal(":01007F005A26\n:00000001FF"), HasSubstr("image.hex:1: it writes to 7Fh, and an EEPROM ends at 40h"));
    EXPECT_THAT(refusal(":020000040001F9\n:010000005AA5\n:00000001FF"), HasSubstr("image.hex:2: it writes to 10000h"));
    EXPECT_THAT(refusal(":00000001FF\n:00000001FF\n"), HasSubstr("image.hex:2: there is more behind the end record"));
    EXPECT_THAT(refusal(":00000009F7\n:00000001FF\n"), HasSubstr("image.hex:1: there is no record type 09h"));
}

TEST(IntelHex, IsToldFromABinaryImage) {
    EXPECT_TRUE(is_intel_hex(bytes_of("\r\n:00000001FF\r\n")));
    EXPECT_FALSE(is_intel_hex(bytes_of(":\x08\x0C\x01")));
    EXPECT_FALSE(is_intel_hex(bytes_of("08 00")));
    EXPECT_FALSE(is_intel_hex({}));
}

// Any single character changed is noticed, or changes nothing: each record has a checksum.
TEST(IntelHex, NoChangedCharacterPasses) {
    const std::string whole = ":020000001122CB\n:02000400ABCD82\n:00000001FF\n";
    const auto image = *parse(whole);
    std::mt19937 draw{7};
    unsigned refused = 0;
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (unsigned n = 0; n < 20; ++n) {
            auto damaged = whole;
            damaged[at] = static_cast<char>(' ' + draw() % 95);
            const auto parsed = parse(damaged);
            if (parsed) {
                EXPECT_EQ(*parsed, image) << damaged;
            }
            refused += parsed ? 0 : 1;
        }
    EXPECT_GT(refused, 700u);
}

}  // namespace
}  // namespace taktwerk::apps
