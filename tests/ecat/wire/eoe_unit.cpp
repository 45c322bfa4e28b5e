// EoE messages, byte by byte. Layout: ETG.1000.6 (EoE); Set IP with every field in its place, as TwinCAT writes it.
#include "ecat/wire/eoe.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace taktwerk::ecat {
namespace {

using EoeBytes = std::vector<std::byte>;

EoeBytes eoe_bytes(std::initializer_list<int> values) {
    EoeBytes out;
    for (const int v : values) out.push_back(static_cast<std::byte>(v));
    return out;
}

// Type 0, port 0; bit 8: last. Second word: number 1, 4 blocks (bits 6 to 11), frame 5 (bits 12 to 15): 0101 000100 000001.
TEST(EoeMessageBytes, AFragmentHasNumberBlocksAndFrame) {
    const auto data = eoe_bytes({0xAA, 0xBB, 0xCC});
    EoeFragment fragment;
    fragment.frame = 5;
    fragment.number = 1;
    fragment.blocks = 4;
    fragment.last = true;
    fragment.data = data;
    EoeBytes out(16);
    out.resize(encode_eoe_fragment(out, fragment));
    EXPECT_EQ(out, eoe_bytes({0x00, 0x01, 0x01, 0x51, 0xAA, 0xBB, 0xCC}));
    const auto read = parse_eoe_fragment(out);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->frame, 5);
    EXPECT_EQ(read->number, 1);
    EXPECT_EQ(read->blocks, 4);
    EXPECT_TRUE(read->last);
    EXPECT_EQ(EoeBytes(read->data.begin(), read->data.end()), data);
}

// Bit 9: four bytes behind the last fragment are a time; bit 10: one is asked for.
TEST(EoeMessageBytes, ATimeStampStandsBehindTheLastFragment) {
    const auto message = eoe_bytes({0x00, 0x07, 0x00, 0x00, 0xAA, 0x78, 0x56, 0x34, 0x12});
    const auto read = parse_eoe_fragment(message);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->time, 0x12345678u);
    EXPECT_EQ(read->data.size(), 1u);
    EXPECT_TRUE(read->time_asked);
    EoeBytes out(16);
    out.resize(encode_eoe_fragment(out, *read));
    EXPECT_EQ(out, message);
    EXPECT_FALSE(parse_eoe_fragment(eoe_bytes({0x00, 0x03, 0, 0, 1, 2, 3}))) << "too short for the time it announces";
    EXPECT_FALSE(parse_eoe_fragment(eoe_bytes({0x00, 0x02, 0, 0, 1, 2, 3, 4}))) << "a time, and not the last";
}

TEST(EoeMessageBytes, OtherTypesAreNoFragments) {
    EXPECT_EQ(eoe_type(eoe_bytes({0x03, 0x01, 0, 0})), EoeType::set_ip_response);
    EXPECT_FALSE(parse_eoe_fragment(eoe_bytes({0x03, 0x01, 0, 0})));
    EXPECT_FALSE(eoe_type(eoe_bytes({0x0F, 0, 0, 0})));
    EXPECT_FALSE(eoe_type(eoe_bytes({0, 0, 0})));
}

// Flags: IP (bit 1) and subnet (bit 2). 192.168.7.2 as a little-endian number: 02 07 A8 C0.
TEST(EoeMessageBytes, SetIpHasAPlaceForEveryField) {
    EoeAddress address;
    address.ip = 0xC0A80702;
    address.subnet = 0xFFFFFF00;
    EoeBytes out(100);
    out.resize(encode_eoe_set_ip(out, 0, address));
    EoeBytes expected(4 + 4 + 6 + 16 + 32);
    expected[0] = std::byte{0x02}, expected[1] = std::byte{0x01}, expected[4] = std::byte{0x06};
    const auto ip = eoe_bytes({0x02, 0x07, 0xA8, 0xC0, 0x00, 0xFF, 0xFF, 0xFF});
    std::copy(ip.begin(), ip.end(), expected.begin() + 14);
    EXPECT_EQ(out, expected);
}

TEST(EoeMessageBytes, SetIpReadsBackWhatWasGiven) {
    EoeAddress address;
    address.mac = EoeMac{std::byte{2}, std::byte{3}, std::byte{4}, std::byte{5}, std::byte{6}, std::byte{7}};
    address.gateway = 0x0A000001;
    address.dns = 0x08080808;
    address.name = "gauge";
    EoeBytes out(eoe_set_ip_size);
    ASSERT_EQ(encode_eoe_set_ip(out, 0, address), eoe_set_ip_size);
    const auto read = parse_eoe_set_ip(out);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->mac, address.mac);
    EXPECT_FALSE(read->ip);
    EXPECT_EQ(read->gateway, address.gateway);
    EXPECT_EQ(read->dns, address.dns);
    EXPECT_EQ(read->name, "gauge");
    const auto cut = parse_eoe_set_ip(std::span{out}.first(15));
    ASSERT_TRUE(cut);
    EXPECT_TRUE(cut->mac);
    EXPECT_FALSE(cut->gateway) << "it is not there";
}

TEST(EoeMessageBytes, TheAnswerIsTheTypeBehindTheRequestAndAResult) {
    EoeBytes out(4);
    ASSERT_EQ(encode_eoe_result(out, 0, EoeType::set_ip_request, EoeResult::no_ip_support), 4u);
    EXPECT_EQ(out, eoe_bytes({0x03, 0x01, 0x01, 0x02}));
    EXPECT_EQ(parse_eoe_result(out, EoeType::set_ip_request), EoeResult::no_ip_support);
    EXPECT_FALSE(parse_eoe_result(out, EoeType::set_filter_request));
}

// 128 bytes of mailbox less 6 and 4: 118, in whole blocks 96.
TEST(EoeMessageBytes, AMailboxHasRoomForWholeBlocks) {
    EXPECT_EQ(eoe_room(128), 96u);
    EXPECT_EQ(eoe_room(1024), 992u);
    EXPECT_EQ(eoe_room(41), 0u);
}

}  // namespace
}  // namespace taktwerk::ecat
