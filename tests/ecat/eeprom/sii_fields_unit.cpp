// Words of an EEPROM by name. Addresses: ETG.1000.6 table 16 (header), ETG.2010 (categories).
#include "ecat/eeprom/sii_fields.hpp"

#include <gmock/gmock.h>

#include "core/bytes.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// 0040h strings: type, length, 4 words. 0046h sync managers: type, length, 8 words. 0050h RxPDOs: type, length, 8 words. 005Ah: end.
Sii small_image() {
    Sii sii;
    sii.identity = {1, 2, 3, 4};
    sii.strings = {"abc", "de"};  // 1 + 1 + 3 + 1 + 2 bytes
    sii.sync_managers = {{0x1000, 1, 0x44, 0, 1, SiiSyncManagerUse::outputs}, {0x1100, 1, 0x20, 0, 1, SiiSyncManagerUse::inputs}};
    sii.rx_pdos = {{.index = 0x1600, .sync_manager = 0, .synchronization = 0, .name = 0, .flags = 0, .entries = {{0x7000, 1, 0, 1, 1, 0}}}};
    return sii;
}

TEST(SiiField, NamesTheWordsOfTheHeader) {
    const auto image = build_sii(small_image());
    EXPECT_EQ(sii_field(image, 0x00), "PDI control");
    EXPECT_EQ(sii_field(image, 0x04), "alias");
    EXPECT_EQ(sii_field(image, 0x06), "further PDI configuration");
    EXPECT_EQ(sii_field(image, 0x07), "checksum of words 0 to 6");
    EXPECT_EQ(sii_field(image, 0x0B), "product");
    EXPECT_EQ(sii_field(image, 0x0E), "serial number");
    EXPECT_EQ(sii_field(image, 0x15), "mailbox out in BOOT: size");
    EXPECT_EQ(sii_field(image, 0x1A), "mailbox in: address");
    EXPECT_EQ(sii_field(image, 0x30), "reserved");
    EXPECT_EQ(sii_field(image, 0x3E), "EEPROM size");
}

TEST(SiiField, NamesTheWordsOfCategories) {
    const auto image = build_sii(small_image());
    EXPECT_EQ(sii_field(image, 0x41), "strings: type and length");
    EXPECT_EQ(sii_field(image, 0x42), "number of strings, string 1");
    EXPECT_EQ(sii_field(image, 0x43), "string 1 'abc'");
    EXPECT_EQ(sii_field(image, 0x45), "string 2 'de'");
    EXPECT_EQ(sii_field(image, 0x48), "sync manager 0 address");
    EXPECT_EQ(sii_field(image, 0x4D), "sync manager 1 length");
    EXPECT_EQ(sii_field(image, 0x52), "RxPDO 1600h");
    EXPECT_EQ(sii_field(image, 0x56), "RxPDO 1600h entry 1");
    EXPECT_EQ(sii_field(image, 0x5A), "end marker");
    EXPECT_EQ(sii_field(image, 0x5B), "behind the end marker");
    EXPECT_EQ(sii_field({}, 0x40), "end marker") << "any bytes, and none";
}

TEST(SiiChanges, AreTheWordsThatDiffer) {
    const auto before = build_sii(small_image());
    auto after = before;
    EXPECT_THAT(sii_changes(before, after), IsEmpty());
    store_le<std::uint16_t>(after, 2 * 0x4D, 3);
    store_le<std::uint32_t>(after, 2 * sii_word::serial, 0x00050009);
    EXPECT_THAT(sii_changes(before, after), ElementsAre(SiiWordChange{0x0E, 4, 9}, SiiWordChange{0x0F, 0, 5}, SiiWordChange{0x4D, 1, 3}));
}

// What a controller loads at power-on: ETG.1000.6 table 16, checksum over words 0 to 6.
TEST(SiiAlias, IsWordFourWithAChecksumThatFits) {
    auto image = build_sii(small_image());
    set_sii_alias(image, 99);
    const auto read = parse_sii(image);
    EXPECT_EQ(read.alias, 99);
    EXPECT_THAT(read.defects, IsEmpty());
    Sii expected = small_image();
    expected.alias = 99;
    EXPECT_EQ(read, expected) << "and nothing else";
}

}  // namespace
}  // namespace taktwerk::ecat
