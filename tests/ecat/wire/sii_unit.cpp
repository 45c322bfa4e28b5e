// SII images: by hand, built and read back, and of real devices.
#include "ecat/wire/sii.hpp"

#include <gmock/gmock.h>

#include <random>

#include "core/bytes.hpp"
#include "tests/ecat/wire/bytes_of.hpp"
#include "tests/ecat/wire/captures.hpp"

namespace taktwerk::ecat {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;

Sii drive() {
    Sii sii;
    sii.pdi_control = 0x0C08;
    sii.pdi_configuration = 0x6608;
    sii.sync_pulse_length = 0x01F4;
    sii.alias = 0x0102;
    sii.identity = {0x000007FB, 0x000C0108, 0x00010001, 0x12345678};
    sii.mailbox_out = {0x1000, 0x0080};
    sii.mailbox_in = {0x1400, 0x0080};
    sii.mailbox_protocols = sii_protocol::coe;
    sii.size_code = 0x000F;
    SiiGeneral general;
    general.order = sii.add_string("SV33-E");
    general.name = sii.add_string("SV33-E servo drive");
    general.coe_details = sii_coe::sdo | sii_coe::pdo_assign | sii_coe::pdo_configuration;
    general.ebus_current = -200;
    general.physical_ports = 0x0011;
    sii.general = general;
    sii.fmmus = {SiiFmmuUse::outputs, SiiFmmuUse::inputs, SiiFmmuUse::mailbox_status};
    sii.sync_managers = {{0x1000, 0x80, 0x26, 0, 1, SiiSyncManagerUse::mailbox_out}, {0x1800, 12, 0x64, 0, 1, SiiSyncManagerUse::outputs}};
    SiiPdo rx{.index = 0x1702, .sync_manager = 2, .synchronization = 0, .name = sii.add_string("Outputs"), .flags = 0x10, .entries = {}};
    rx.entries = {{0x6040, 0, sii.add_string("Controlword"), 6, 16, 0}, {0x607A, 0, 0, 4, 32, 0}, {0, 0, 0, 0, 8, 0}};
    sii.rx_pdos = {rx};
    SiiPdo tx{.index = 0x1B02, .sync_manager = 3, .synchronization = 0, .name = 0, .flags = 0, .entries = {{0x6041, 0, 0, 6, 16, 0}}};
    sii.tx_pdos = {tx, SiiPdo{}};
    sii.fmmu_extensions = {{1, 2, 0}};
    sii.dc_modes = {{1'000'000, -250, 500'000, -1, 0x0700, 1, 2, 0}};
    sii.pdi_configuration_more = {0x1234, 0x5678};
    sii.delays = {10, 20, 30};
    sii.boot_mailbox_out = {0x1000, 0x0400};
    sii.boot_mailbox_in = {0x1400, 0x0400};
    sii.general->soe_channels = 1, sii.general->ds402_channels = 2, sii.general->sysman_class = 3;
    sii.general->flags = sii_flag::id_in_al_status | sii_flag::id_in_memory;
    sii.general->id_address = 0x0F18;
    sii.others = {{2048, test::bytes_of({1, 2, 3, 4})}, {sii_category::sync_unit, test::bytes_of({0, 0})}};
    return sii;
}

// SV33-E manual 6.2.6.2: words 0..6 = 0C08 6608 01F4 0 0 0 0, checksum word 00D2.
TEST(SiiChecksum, MatchesTheManualsHeader) {
    auto image = test::bytes_of({0x08, 0x0C, 0x08, 0x66, 0xF4, 0x01, 0, 0, 0, 0, 0, 0, 0, 0});
    EXPECT_EQ(sii_checksum(image), 0xD2);
    image[8] = std::byte{1};
    EXPECT_NE(sii_checksum(image), 0xD2);
}

TEST(Sii, HeaderFieldsStandAtTheirWords) {
    const auto image = build_sii(drive());
    const auto word = [&](std::size_t address) { return load_le<std::uint16_t>(image, 2 * address); };
    EXPECT_EQ(image.size(), 2048u) << "16 kbit";
    EXPECT_EQ(word(0x04), 0x0102);
    EXPECT_EQ(word(0x08), 0x07FB);
    EXPECT_EQ(word(0x0A), 0x0108);
    EXPECT_EQ(word(0x0B), 0x000C);
    EXPECT_EQ(word(0x18), 0x1000);
    EXPECT_EQ(word(0x19), 0x0080);
    EXPECT_EQ(word(0x1A), 0x1400);
    EXPECT_EQ(word(0x1C), 0x0004);
    EXPECT_EQ(word(0x3E), 0x000F);
    EXPECT_EQ(word(0x40), 10) << "strings come first";
}

TEST(Sii, BuiltImageReadsBackTheSame) {
    const auto sii = drive();
    const auto read = parse_sii(build_sii(sii));

    EXPECT_THAT(read.defects, IsEmpty());
    EXPECT_EQ(read.identity, sii.identity);
    EXPECT_EQ(read.alias, sii.alias);
    EXPECT_EQ(read.mailbox_out, sii.mailbox_out);
    EXPECT_EQ(read.mailbox_in, sii.mailbox_in);
    EXPECT_EQ(read.mailbox_protocols, sii.mailbox_protocols);
    EXPECT_EQ(read.strings, sii.strings);
    ASSERT_TRUE(read.general);
    EXPECT_EQ(*read.general, *sii.general);
    EXPECT_EQ(read.fmmus, sii.fmmus);
    EXPECT_EQ(read.sync_managers, sii.sync_managers);
    EXPECT_EQ(read.rx_pdos, sii.rx_pdos);
    EXPECT_EQ(read.tx_pdos, sii.tx_pdos);
    EXPECT_EQ(read.fmmu_extensions, sii.fmmu_extensions);
    EXPECT_EQ(read.dc_modes, sii.dc_modes);
    EXPECT_EQ(read, sii) << "everything";
    EXPECT_EQ(read.rx_pdos[0].bits(), 56u);
    EXPECT_EQ(read.string(read.general->name), "SV33-E servo drive");
}

TEST(Sii, StringNumberBeyondTheTableIsEmpty) {
    const auto sii = drive();
    EXPECT_EQ(sii.string(0), "");
    EXPECT_EQ(sii.string(1), "SV33-E");
    EXPECT_EQ(sii.string(static_cast<std::uint8_t>(sii.strings.size() + 1)), "");
    EXPECT_EQ(sii.string(255), "");
}

TEST(Sii, EmptyEepromIsSaidToBeEmpty) {
    EXPECT_THAT(parse_sii({}).defects, Contains(SiiDefect::empty));
    EXPECT_THAT(parse_sii(std::vector<std::byte>(512, std::byte{0})).defects, Contains(SiiDefect::empty));
    EXPECT_THAT(parse_sii(std::vector<std::byte>(512, std::byte{0xFF})).defects, Contains(SiiDefect::empty));
}

TEST(Sii, WrongChecksumIsReportedAndTheRestIsRead) {
    auto image = build_sii(drive());
    image[2 * sii_word::alias] = std::byte{0x77};
    const auto sii = parse_sii(image);
    EXPECT_THAT(sii.defects, Contains(SiiDefect::bad_checksum));
    EXPECT_EQ(sii.identity.vendor, 0x7FBu);
    EXPECT_EQ(sii.rx_pdos.size(), 1u);
}

TEST(Sii, ImageCutInACategoryGivesWhatIsThere) {
    const auto image = build_sii(drive());
    const auto cut = parse_sii(std::span{image}.first(2 * sii_word::categories + 4 + 10));  // in the strings
    EXPECT_THAT(cut.defects, Contains(SiiDefect::truncated_category));
    EXPECT_THAT(cut.defects, Contains(SiiDefect::bad_strings));
    EXPECT_EQ(cut.string(1), "SV33-E");
    EXPECT_FALSE(cut.general);

    const auto header = parse_sii(std::span{image}.first(2 * sii_word::categories));
    EXPECT_THAT(header.defects, Contains(SiiDefect::no_end));
    EXPECT_EQ(header.identity.product, 0xC0108u);

    EXPECT_THAT(parse_sii(std::span{image}.first(40)).defects, Contains(SiiDefect::truncated_header));
}

TEST(Sii, PdoThatClaimsMoreEntriesThanThereAreKeepsThoseThere) {
    Sii sii;
    sii.identity.vendor = 1;
    sii.tx_pdos = {
        {.index = 0x1A00, .sync_manager = 3, .synchronization = 0, .name = 0, .flags = 0, .entries = {{0x6041, 0, 0, 6, 16, 0}}}};
    auto image = build_sii(sii);
    image[2 * sii_word::categories + 4 + 2] = std::byte{200};  // number of entries
    const auto read = parse_sii(image);
    EXPECT_THAT(read.defects, Contains(SiiDefect::bad_pdo));
    ASSERT_EQ(read.tx_pdos.size(), 1u);
    EXPECT_EQ(read.tx_pdos[0].entries.size(), 1u);
}

TEST(Sii, AnyTruncationAndAnyDamageIsSurvived) {
    const auto good = build_sii(drive());
    for (std::size_t size = 0; size < 700; ++size)
        (void)parse_sii(std::vector<std::byte>(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)));
    std::mt19937 random{3};
    for (int i = 0; i < 3000; ++i) {
        auto bad = std::vector<std::byte>(good.begin(), good.begin() + 512);
        for (int n = 0; n < 4; ++n) bad[random() % bad.size()] = static_cast<std::byte>(random() & 0xFF);
        const auto sii = parse_sii(bad);
        EXPECT_LE(sii.rx_pdos.size(), bad.size() / 8);
    }
}

// ETG.2010, table 2 and categories: type, length in words, content; and again.
TEST(Sii, CategoriesAreFoundWhereTheyLie) {
    Sii sii;
    sii.identity.vendor = 1;
    sii.strings = {"AB"};  // 1 byte count, 1 byte length, 2 bytes: 2 words
    sii.sync_managers = {{0x1000, 1, 0x44, 0, 1, SiiSyncManagerUse::outputs}};
    EXPECT_THAT(sii_categories(build_sii(sii)), testing::ElementsAre(SiiCategoryPlace{sii_category::strings, 0x42, 2},
                                                                     SiiCategoryPlace{sii_category::sync_manager, 0x46, 4}));
    EXPECT_THAT(sii_categories({}), IsEmpty());
}

// ETG.2010, category 30: byte 11 flags, 12 E-bus current, 16 ports, 18 physical memory address.
TEST(Sii, GeneralStandsByteByByte) {
    const auto sii = drive();
    const auto image = build_sii(sii);
    std::size_t at = 0;
    for (const auto& category : sii_categories(image))
        if (category.type == sii_category::general) at = 2 * category.word;
    ASSERT_NE(at, 0u);
    EXPECT_EQ(image[at + 8], std::byte{1});
    EXPECT_EQ(image[at + 9], std::byte{2});
    EXPECT_EQ(image[at + 10], std::byte{3});
    EXPECT_EQ(image[at + 11], std::byte{0x18}) << "bits 3 and 4";
    EXPECT_EQ(load_le<std::int16_t>(image, at + 12), -200);
    EXPECT_EQ(load_le<std::uint16_t>(image, at + 16), 0x0011);
    EXPECT_EQ(load_le<std::uint16_t>(image, at + 18), 0x0F18);
}

TEST(RealSii, Akd) {
    TAKTWERK_SKIP_WITHOUT_CAPTURES();
    const auto sii = parse_sii(test::read_file(test::captures_folder() / "eeprom" / "akd.hex"));
    // Read off the hexadecimal dump by eye.
    EXPECT_THAT(sii.defects, IsEmpty());
    EXPECT_EQ(sii.identity, (Identity{0x6A, 0x00414B44, 0x00000002, 0x99830093}));
    EXPECT_EQ(sii.mailbox_out, (SiiMailbox{0x1800, 0x0400}));
    EXPECT_EQ(sii.mailbox_in, (SiiMailbox{0x1C00, 0x0400}));
    EXPECT_EQ(sii.mailbox_protocols, sii_protocol::eoe | sii_protocol::coe | sii_protocol::foe);
    EXPECT_EQ(sii.strings.size(), 0x21u);
    ASSERT_TRUE(sii.general);
    EXPECT_EQ(sii.string(sii.general->name), "AKD EtherCAT Drive (CoE)");
    EXPECT_EQ(sii.fmmus, (std::vector{SiiFmmuUse::outputs, SiiFmmuUse::inputs, SiiFmmuUse::mailbox_status}));
    ASSERT_EQ(sii.sync_managers.size(), 4u);
    EXPECT_EQ(sii.sync_managers[0], (SiiSyncManager{0x1800, 0x0400, 0x26, 0, 1, SiiSyncManagerUse::mailbox_out}));
    EXPECT_EQ(sii.sync_managers[3], (SiiSyncManager{0x1140, 0, 0x20, 0, 1, SiiSyncManagerUse::inputs}));
    ASSERT_FALSE(sii.tx_pdos.empty());
    EXPECT_EQ(sii.tx_pdos[0].index, 0x1A00);
    EXPECT_EQ(sii.tx_pdos[0].entries, (std::vector<SiiPdoEntry>{{0x6041, 0, 9, 6, 16, 0}}));
    ASSERT_FALSE(sii.rx_pdos.empty());
    EXPECT_EQ(sii.rx_pdos[0].index, 0x1600);
}

// Category 60 by eye: AssignActivate 0300h named by string 6, 0000h (no clock) by string 7; SYNC0 factor 1 in both.
TEST(RealSii, AkdHasTwoWaysToRunItsClock) {
    TAKTWERK_SKIP_WITHOUT_CAPTURES();
    const auto sii = parse_sii(test::read_file(test::captures_folder() / "eeprom" / "akd.hex"));
    ASSERT_EQ(sii.dc_modes.size(), 2u);
    EXPECT_EQ(sii.dc_modes[0].assign_activate, 0x0300);
    EXPECT_EQ(sii.dc_modes[0].sync0_factor, 1);
    EXPECT_EQ(sii.dc_modes[0].name, 6);
    EXPECT_EQ(sii.dc_modes[1].assign_activate, 0x0000);
    EXPECT_EQ(sii.dc_modes[1].name, 7);
    EXPECT_THAT(sii.others,
                testing::ElementsAre(testing::Field(&SiiOtherCategory::type, 2048), testing::Field(&SiiOtherCategory::type, 2049),
                                     testing::Field(&SiiOtherCategory::type, 43)));  // two of the vendor's own, and sync units
}

// What is there is read; what is missing is a defect, never a crash and never silence.
TEST(RealSii, TruncatedAtAnyWordGivesAPrefixAndADefect) {
    TAKTWERK_SKIP_WITHOUT_CAPTURES();
    for (const auto& entry : std::filesystem::directory_iterator{test::captures_folder() / "eeprom"}) {
        SCOPED_TRACE(entry.path().filename());
        const auto image = test::read_file(entry.path());
        const auto whole = parse_sii(image);
        for (std::size_t words = 0; 2 * words < image.size(); ++words) {
            const auto cut = parse_sii(std::span{image}.first(2 * words));
            ASSERT_LE(cut.strings.size(), whole.strings.size()) << words;
            ASSERT_LE(cut.tx_pdos.size(), whole.tx_pdos.size()) << words;
            ASSERT_TRUE(!cut.defects.empty() || (cut.tx_pdos == whole.tx_pdos && cut.general == whole.general)) << words;
            ASSERT_TRUE(words < sii_word::categories || cut.identity == whole.identity) << words;
        }
    }
}

TEST(RealSii, CouplerAndTerminal) {
    TAKTWERK_SKIP_WITHOUT_CAPTURES();
    const auto coupler = parse_sii(test::read_file(test::captures_folder() / "eeprom" / "ek1100.hex"));
    EXPECT_FALSE(coupler.has(SiiDefect::bad_checksum));
    EXPECT_EQ(coupler.identity.vendor, 2u);
    EXPECT_EQ(coupler.identity.product, 0x044C2C52u);  // product code of an EK1100
    EXPECT_TRUE(coupler.rx_pdos.empty());

    const auto terminal = parse_sii(test::read_file(test::captures_folder() / "eeprom" / "el2828.hex"));
    EXPECT_FALSE(terminal.has(SiiDefect::bad_checksum));
    EXPECT_EQ(terminal.identity.vendor, 2u);
    EXPECT_EQ(terminal.identity.product, 0x0B0C3052u);  // product code of an EL2828
    EXPECT_EQ(terminal.rx_pdos.size(), 8u) << "eight digital outputs, one PDO each";
    for (const auto& pdo : terminal.rx_pdos) EXPECT_EQ(pdo.bits(), 1u);
}

TEST(RealSii, EveryImageReadsAndRebuildsToTheSameFields) {
    TAKTWERK_SKIP_WITHOUT_CAPTURES();
    std::size_t images = 0;
    for (const auto& entry : std::filesystem::directory_iterator{test::captures_folder() / "eeprom"}) {
        SCOPED_TRACE(entry.path().filename());
        const auto sii = parse_sii(test::read_file(entry.path()));
        const auto again = parse_sii(build_sii(sii));
        ++images;
        EXPECT_NE(sii.identity.vendor, 0u);
        EXPECT_EQ(again.identity, sii.identity);
        EXPECT_EQ(again.strings, sii.strings);
        EXPECT_EQ(again.general, sii.general);
        EXPECT_EQ(again.fmmus, sii.fmmus);
        EXPECT_EQ(again.sync_managers, sii.sync_managers);
        EXPECT_EQ(again.tx_pdos, sii.tx_pdos);
        EXPECT_EQ(again.rx_pdos, sii.rx_pdos);
        auto known = sii;
        known.defects.clear();  // a building mends what was wrong with the bytes
        EXPECT_EQ(again, known) << "and everything else: clocks, mailboxes, vendors' own categories";
    }
    EXPECT_GE(images, 4u);
}

}  // namespace
}  // namespace taktwerk::ecat
