// The conversation of a file that is written, message by message. Source: ETG.1000.6 (FoE).
#include "ecat/foe/file_writing.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "ecat/wire/foe_error.hpp"

namespace taktwerk::ecat {
namespace {

using Kind = FoeStep::Kind;

constexpr std::size_t room = 4;

std::vector<std::byte> content(std::size_t size) {
    std::vector<std::byte> out(size);
    for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::byte>(i + 1);
    return out;
}

class WritingAFile : public ::testing::Test {
protected:
    static FoeMessage ack(std::uint32_t packet) { return {FoeOp::acknowledge, packet, {}}; }
};

TEST_F(WritingAFile, BeginsWithPasswordAndNameAndCountsPacketsFromOne) {
    const auto file = content(6);
    FileWriting writing{{"fw", 7}, file, room};
    EXPECT_EQ(writing.request().op, FoeOp::write_request);
    EXPECT_EQ(writing.request().number, 7u);
    EXPECT_EQ(writing.request().text(), "fw");
    EXPECT_FALSE(writing.begun());
    EXPECT_EQ(writing.answer(ack(0)).kind, Kind::next);
    EXPECT_TRUE(writing.begun());
    EXPECT_EQ(writing.request().op, FoeOp::data);
    EXPECT_EQ(writing.request().number, 1u);
    EXPECT_EQ(writing.request().rest.size(), 4u);
    EXPECT_EQ(writing.answer(ack(1)).kind, Kind::next);
    EXPECT_EQ(writing.acknowledged(), 4u);
    EXPECT_EQ(writing.request().number, 2u);
    EXPECT_EQ(writing.request().rest.size(), 2u);
    EXPECT_EQ(writing.answer(ack(2)).kind, Kind::done);
    EXPECT_EQ(writing.acknowledged(), 6u);
}

TEST_F(WritingAFile, AFileThatFillsItsLastPacketEndsWithAnEmptyOne) {
    const auto file = content(8);
    FileWriting writing{{"fw"}, file, room};
    for (std::uint32_t packet = 0; packet <= 2; ++packet) EXPECT_EQ(writing.answer(ack(packet)).kind, Kind::next) << packet;
    EXPECT_EQ(writing.request().number, 3u);
    EXPECT_TRUE(writing.request().rest.empty());
    EXPECT_EQ(writing.answer(ack(3)).kind, Kind::done);
}

TEST_F(WritingAFile, AnEmptyFileIsOneEmptyPacket) {
    FileWriting writing{{"fw"}, {}, room};
    EXPECT_EQ(writing.answer(ack(0)).kind, Kind::next);
    EXPECT_EQ(writing.request().op, FoeOp::data);
    EXPECT_EQ(writing.answer(ack(1)).kind, Kind::done);
}

TEST_F(WritingAFile, BusyWantsTheSameOnceMore) {
    const auto file = content(6);
    FileWriting writing{{"fw"}, file, room};
    EXPECT_EQ(writing.answer({FoeOp::busy, 0, {}}).kind, Kind::again);
    EXPECT_EQ(writing.request().op, FoeOp::write_request);
    (void)writing.answer(ack(0));
    const auto busy = writing.answer({FoeOp::busy, 30u | 100u << 16, foe_text("erasing")});
    EXPECT_EQ(busy.kind, Kind::again);
    EXPECT_EQ(busy.done, 30);
    EXPECT_EQ(busy.entire, 100);
    EXPECT_EQ(busy.words, "erasing");
    EXPECT_EQ(writing.request().number, 1u);
}

TEST_F(WritingAFile, AnEarlierAcknowledgementIsSkippedALaterOneCannotBe) {
    const auto file = content(20);
    FileWriting writing{{"fw"}, file, room};
    (void)writing.answer(ack(0));
    (void)writing.answer(ack(1));
    EXPECT_EQ(writing.answer(ack(1)).kind, Kind::skip);
    EXPECT_EQ(writing.acknowledged(), 4u);
    const auto later = writing.answer(ack(3));
    EXPECT_EQ(later.kind, Kind::broken);
    EXPECT_EQ(later.code, foe_error::packet_number);
}

// Left in the mailbox by a command that was killed.
TEST_F(WritingAFile, AnAcknowledgementBeforeAnythingWasSentBelongsToSomebodyElse) {
    FileWriting writing{{"fw"}, {}, room};
    EXPECT_EQ(writing.answer(ack(7)).kind, Kind::skip);
    EXPECT_FALSE(writing.begun());
    EXPECT_EQ(writing.answer(ack(0)).kind, Kind::next);
}

// A slave that was left in the middle of a transfer ends that one with "illegal", and takes the next request.
TEST_F(WritingAFile, IllegalToTheFirstRequestIsAskedOnceMoreAndNotTwice) {
    FileWriting writing{{"fw"}, {}, room};
    EXPECT_EQ(writing.answer({FoeOp::error, foe_error::illegal, {}}).kind, Kind::next);
    EXPECT_EQ(writing.request().op, FoeOp::write_request);
    EXPECT_EQ(writing.answer({FoeOp::error, foe_error::illegal, {}}).kind, Kind::refused);
}

TEST_F(WritingAFile, ARefusalSaysWhyInTheSlavesWords) {
    FileWriting writing{{"fw"}, {}, room};
    const auto refused = writing.answer({FoeOp::error, foe_error::no_rights, foe_text("who are you")});
    EXPECT_EQ(refused.kind, Kind::refused);
    EXPECT_EQ(refused.code, foe_error::no_rights);
    EXPECT_EQ(refused.words, "who are you");
    EXPECT_FALSE(writing.begun());
}

TEST_F(WritingAFile, WhatIsNoAnswerToItBreaksIt) {
    FileWriting writing{{"fw"}, {}, room};
    for (const FoeOp op : {FoeOp::data, FoeOp::read_request, FoeOp::write_request})
        EXPECT_EQ(writing.answer({op, 0, {}}).kind, Kind::broken);
}

}  // namespace
}  // namespace taktwerk::ecat
