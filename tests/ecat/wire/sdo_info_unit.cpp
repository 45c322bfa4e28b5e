// The SDO information messages, byte for byte as ETG.1000.6 5.6.3 lays them out (tables 43 to 51), put together by hand.
#include "ecat/wire/sdo_info.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "tests/ecat/wire/bytes_of.hpp"

namespace taktwerk::ecat {
namespace {

using test::bytes_of;

struct SdoInfo : testing::Test {
    std::array<std::byte, 64> buffer{};
    std::vector<std::byte> written(std::size_t size) { return {buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(size)}; }
};

// CoE service 8; opcode 1; list type 1 "all objects".
TEST_F(SdoInfo, RequestsHaveTheirLayout) {
    EXPECT_EQ(written(encode_list_request(buffer, ObjectList::all)), bytes_of({0x00, 0x80, 0x01, 0x00, 0x00, 0x00, 0x01, 0x00}));
    EXPECT_EQ(written(encode_object_request(buffer, 0x1018)), bytes_of({0x00, 0x80, 0x03, 0x00, 0x00, 0x00, 0x18, 0x10}));
    EXPECT_EQ(written(encode_entry_request(buffer, 0x607A, 2, value_info::minimum | value_info::maximum)),
              bytes_of({0x00, 0x80, 0x05, 0x00, 0x00, 0x00, 0x7A, 0x60, 0x02, 0x60}));
    EXPECT_EQ(written(encode_info_error(buffer, 0x06020000)), bytes_of({0x00, 0x80, 0x07, 0x00, 0x00, 0x00, 0x00, 0x00, 0x02, 0x06}));
}

// Bit 7 of the opcode byte: incomplete; three fragments follow.
TEST_F(SdoInfo, AFragmentSaysWhatIsLeft) {
    const auto bytes = bytes_of({0x00, 0x80, 0x82, 0x00, 0x03, 0x00, 0x01, 0x00, 0x00, 0x10, 0x18, 0x10});

    const auto message = parse_sdo_info(bytes);

    ASSERT_TRUE(message);
    EXPECT_EQ(message->opcode, SdoInfoOpcode::list_response);
    EXPECT_TRUE(message->incomplete);
    EXPECT_EQ(message->fragments_left, 3);
    const auto list = parse_object_list(message->data);
    ASSERT_TRUE(list);
    EXPECT_EQ(list->type(), 1);
    ASSERT_EQ(list->size(), 2u);
    EXPECT_EQ((*list)[0], 0x1000);
    EXPECT_EQ((*list)[1], 0x1018);
    EXPECT_EQ(written(encode_sdo_info(buffer, *message)), bytes);
}

// 1018h, type 0023h IDENTITY, four entries, record, "ID".
TEST_F(SdoInfo, AnObjectDescriptionIsReadAndWritten) {
    const auto bytes = bytes_of({0x18, 0x10, 0x23, 0x00, 0x04, 0x09, 'I', 'D'});

    const auto object = parse_object_description(bytes);

    ASSERT_TRUE(object);
    EXPECT_EQ(object->index, 0x1018);
    EXPECT_EQ(object->data_type, coe_type::identity);
    EXPECT_EQ(object->max_sub, 4);
    EXPECT_EQ(object->code, static_cast<std::uint8_t>(ObjectCode::record));
    EXPECT_EQ(object->name, "ID");
    EXPECT_EQ(written(encode_object_description(buffer, *object)), bytes);
}

// 607Ah:00, value info 70h: default, minimum, maximum; INTEGER32, 32 bits, access 007Fh; 0, -2, +2, "Target".
TEST_F(SdoInfo, AnEntryDescriptionIsReadAndWritten) {
    const auto bytes = bytes_of({0x7A, 0x60, 0x00, 0x70, 0x04, 0x00, 0x20, 0x00, 0x7F, 0x00, 0,   0,   0,   0,
                                 0xFE, 0xFF, 0xFF, 0xFF, 2,    0,    0,    0,    'T',  'a',  'r', 'g', 'e', 't'});

    const auto entry = parse_entry_description(bytes);

    ASSERT_TRUE(entry);
    EXPECT_EQ(entry->data_type, coe_type::integer32);
    EXPECT_EQ(entry->bits, 32);
    EXPECT_EQ(entry->access, entry_access::read | entry_access::write | entry_access::rx_mappable);
    EXPECT_EQ(entry->minimum[0], std::byte{0xFE});
    EXPECT_EQ(entry->maximum[0], std::byte{2});
    EXPECT_EQ(entry->name, "Target");
    EXPECT_FALSE(entry->unit);
    EXPECT_EQ(written(encode_entry_description(buffer, *entry)), bytes);
}

// Value info 08h: a unit of four bytes stands before the name. One bit needs one byte.
TEST_F(SdoInfo, UnitAndValuesOfBitsAreSkippedRight) {
    const auto bytes = bytes_of({0x20, 0x1C, 0x01, 0x18, 0x01, 0x00, 0x01, 0x00, 0x07, 0x00, 0x00, 0x00, 0x01, 0xFD, 1, 'n'});
    const auto entry = parse_entry_description(bytes);

    ASSERT_TRUE(entry);
    EXPECT_EQ(entry->unit, 0xFD010000u);
    ASSERT_EQ(entry->default_value.size(), 1u);
    EXPECT_EQ(entry->name, "n");
}

TEST_F(SdoInfo, TruncatedAndForeignMessagesAreNothing) {
    EXPECT_FALSE(parse_sdo_info(bytes_of({0x00, 0x80, 0x02, 0x00, 0x00}))) << "shorter than its header";
    EXPECT_FALSE(parse_sdo_info(bytes_of({0x00, 0x30, 0x02, 0x00, 0x00, 0x00}))) << "an SDO response";
    EXPECT_FALSE(parse_sdo_info(bytes_of({0x00, 0x80, 0x00, 0x00, 0x00, 0x00}))) << "opcode 0";
    EXPECT_FALSE(parse_sdo_info(bytes_of({0x00, 0x80, 0x88, 0x00, 0x00, 0x00}))) << "opcode 8";
    EXPECT_FALSE(parse_object_list(bytes_of({0x01})));
    EXPECT_FALSE(parse_object_description(bytes_of({0x18, 0x10, 0x23, 0x00, 0x04})));
    EXPECT_FALSE(parse_entry_description(bytes_of({0x7A, 0x60, 0x00, 0x10, 0x04, 0x00, 0x20, 0x00, 0x7F, 0x00, 0, 0, 0})))
        << "announces a default of four bytes and has three";
    EXPECT_FALSE(parse_info_error(bytes_of({0, 0, 2})));
}

TEST_F(SdoInfo, ABufferThatIsTooSmallTakesNothing) {
    const std::span<std::byte> out{buffer};
    EXPECT_EQ(encode_list_request(out.first(7), ObjectList::all), 0u);
    EXPECT_EQ(encode_object_description(out.first(7), {0x1018, 0x23, 4, 9, "ID"}), 0u);
}

TEST_F(SdoInfo, ADescriptionWhoseValuesDoNotFitItsLengthIsNotWritten) {
    const auto two = bytes_of({1, 2});
    EntryDescriptionView entry;
    entry.bits = 32;
    entry.contains = value_info::minimum;
    entry.minimum = two;
    EXPECT_EQ(encode_entry_description(buffer, entry), 0u);
}

TEST_F(SdoInfo, AnyBytesAreSafe) {
    std::mt19937 random{7};
    std::vector<std::byte> bytes;
    for (int i = 0; i < 20'000; ++i) {
        bytes.resize(random() % 40);
        for (auto& b : bytes) b = static_cast<std::byte>(random());
        if (bytes.size() > 2) bytes[1] = std::byte{0x80}, bytes[2] &= std::byte{0x87};
        const auto message = parse_sdo_info(bytes);
        if (!message) continue;
        if (const auto list = parse_object_list(message->data))
            for (std::size_t n = 0; n < list->size(); ++n) (void)(*list)[n];
        (void)parse_object_description(message->data);
        if (const auto entry = parse_entry_description(message->data)) {
            const std::size_t size = encode_entry_description(buffer, *entry);
            EXPECT_EQ(written(size), (std::vector<std::byte>{message->data.begin(), message->data.end()}));
        }
    }
}

TEST(CoeTypes, HaveTheNamesOfTheStandard) {
    EXPECT_EQ(coe_type_text(0x0006), "UNSIGNED16");
    EXPECT_EQ(coe_type_text(0x0015), "INTEGER64");
    EXPECT_EQ(coe_type_text(0x7777), "");
}

}  // namespace
}  // namespace taktwerk::ecat
