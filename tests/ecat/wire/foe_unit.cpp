// FoE messages, byte by byte. Layout: ETG.1000.6 (FoE): op, reserved, 32 bits, then name, data or words.
#include "ecat/wire/foe.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "ecat/wire/foe_error.hpp"

namespace taktwerk::ecat {
namespace {

std::vector<std::byte> foe_bytes(std::initializer_list<int> values) {
    std::vector<std::byte> out;
    for (const int v : values) out.push_back(static_cast<std::byte>(v));
    return out;
}

std::vector<std::byte> written(const FoeMessage& message) {
    std::vector<std::byte> out(64);
    out.resize(encode_foe(out, message));
    return out;
}

TEST(FoeMessageBytes, AWriteRequestIsPasswordAndName) {
    const auto expected = foe_bytes({2, 0, 0x78, 0x56, 0x34, 0x12, 'f', 'w'});
    EXPECT_EQ(written({FoeOp::write_request, 0x12345678, foe_text("fw")}), expected);
    const auto read = parse_foe(expected);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->op, FoeOp::write_request);
    EXPECT_EQ(read->number, 0x12345678u);
    EXPECT_EQ(read->text(), "fw");
}

TEST(FoeMessageBytes, AReadRequestDiffersByItsOpAlone) {
    EXPECT_EQ(written({FoeOp::read_request, 0, foe_text("a")}), foe_bytes({1, 0, 0, 0, 0, 0, 'a'}));
}

TEST(FoeMessageBytes, DataAndAcknowledgeCarryThePacketNumber) {
    const auto data = foe_bytes({0xAA, 0xBB});
    EXPECT_EQ(written({FoeOp::data, 0x00010002, data}), foe_bytes({3, 0, 2, 0, 1, 0, 0xAA, 0xBB}));
    EXPECT_EQ(written({FoeOp::acknowledge, 3, {}}), foe_bytes({4, 0, 3, 0, 0, 0}));
}

TEST(FoeMessageBytes, AnErrorIsCodeAndWords) {
    const auto bytes = foe_bytes({5, 0, 0x02, 0x80, 0, 0, 'n', 'o', 0, 'x'});
    const auto error = parse_foe(bytes);
    ASSERT_TRUE(error);
    EXPECT_EQ(error->number, foe_error::access_denied);
    EXPECT_EQ(error->text(), "no") << "words end with their first zero";
}

TEST(FoeMessageBytes, BusySaysHowFarOfHowMuch) {
    const auto bytes = foe_bytes({6, 0, 40, 0, 100, 0});
    const auto busy = parse_foe(bytes);
    ASSERT_TRUE(busy);
    EXPECT_EQ(busy->done(), 40);
    EXPECT_EQ(busy->entire(), 100);
    EXPECT_EQ(busy->text(), "");
}

TEST(FoeMessageBytes, WhatIsTooShortOrHasNoSuchOpIsNone) {
    EXPECT_FALSE(parse_foe({}));
    EXPECT_FALSE(parse_foe(foe_bytes({4, 0, 0, 0, 0})));
    EXPECT_FALSE(parse_foe(foe_bytes({0, 0, 0, 0, 0, 0})));
    EXPECT_FALSE(parse_foe(foe_bytes({7, 0, 0, 0, 0, 0})));
    std::array<std::byte, 7> small{};
    const auto data = foe_bytes({1, 2});
    EXPECT_EQ(encode_foe(small, {FoeOp::data, 1, data}), 0u);
}

// 128 bytes of mailbox: 6 of mailbox header, 6 of FoE header.
TEST(FoeMessageBytes, AMailboxHasRoomForWhatItsHeadersLeave) {
    EXPECT_EQ(foe_room(128), 116u);
    EXPECT_EQ(foe_room(12), 0u);
    EXPECT_EQ(foe_room(3), 0u);
}

// Older slave stacks leave out bit 15.
TEST(FoeErrorCodes, CodesWithoutTheirHighestBitMeanTheSame) {
    EXPECT_EQ(foe_error_info(0x8001).text, "file not found");
    EXPECT_EQ(foe_error_info(0x0001).text, "file not found");
    EXPECT_EQ(foe_error_info(0x800A).text, "wrong password");
    EXPECT_EQ(foe_error_info(0x800C).text, "wrong checksum");
    EXPECT_EQ(foe_error_info(0x12345678).code, 0u);
    EXPECT_FALSE(foe_error_info(0xFFFF).text.empty());
}

}  // namespace
}  // namespace taktwerk::ecat
