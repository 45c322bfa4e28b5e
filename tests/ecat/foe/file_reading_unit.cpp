// The conversation of a file that is read, message by message. Source: ETG.1000.6 (FoE).
#include "ecat/foe/file_reading.hpp"

#include <gtest/gtest.h>

#include "ecat/wire/foe_error.hpp"

namespace taktwerk::ecat {
namespace {

using Kind = FoeStep::Kind;

constexpr std::size_t packet_room = 4, limit = 10;
const std::vector<std::byte> full(packet_room, std::byte{7});

class ReadingAFile : public ::testing::Test {
protected:
    static FoeMessage data(std::uint32_t packet, std::size_t size = packet_room) {
        return {FoeOp::data, packet, std::span{full}.first(size)};
    }
    FileReading reading{{"log", 9}, packet_room, limit};
};

TEST_F(ReadingAFile, EachPacketIsAcknowledgedAndOneThatIsNotFullIsTheLast) {
    EXPECT_EQ(reading.request().op, FoeOp::read_request);
    EXPECT_EQ(reading.request().number, 9u);
    EXPECT_EQ(reading.request().text(), "log");
    EXPECT_EQ(reading.answer(data(1)).kind, Kind::next);
    EXPECT_EQ(reading.request().op, FoeOp::acknowledge);
    EXPECT_EQ(reading.request().number, 1u);
    EXPECT_EQ(reading.answer(data(2, 1)).kind, Kind::last);
    EXPECT_EQ(reading.request().number, 2u) << "acknowledged, too; nothing comes back";
    EXPECT_EQ(reading.file().size(), 5u);
}

TEST_F(ReadingAFile, AnEmptyPacketEndsAFileThatFilledTheOneBefore) {
    (void)reading.answer(data(1));
    EXPECT_EQ(reading.answer(data(2, 0)).kind, Kind::last);
    EXPECT_EQ(reading.file().size(), 4u);
}

TEST_F(ReadingAFile, APacketThatComesTwiceIsTakenOnce) {
    (void)reading.answer(data(1));
    EXPECT_EQ(reading.answer(data(1)).kind, Kind::skip);
    EXPECT_EQ(reading.file().size(), 4u);
}

TEST_F(ReadingAFile, APacketThatIsMissingBreaksIt) {
    const auto step = reading.answer(data(2));
    EXPECT_EQ(step.kind, Kind::broken);
    EXPECT_EQ(step.code, foe_error::packet_number);
}

// The usual slave stack waits for ACK 0 after BUSY to a read request; a second request would be illegal.
TEST_F(ReadingAFile, BusyToTheRequestIsAnsweredWithAcknowledgeZero) {
    EXPECT_EQ(reading.answer({FoeOp::busy, 50, {}}).kind, Kind::again);
    EXPECT_EQ(reading.request().op, FoeOp::acknowledge);
    EXPECT_EQ(reading.request().number, 0u);
    EXPECT_EQ(reading.answer(data(1)).kind, Kind::next);
    EXPECT_EQ(reading.answer({FoeOp::busy, 50, {}}).kind, Kind::again);
    EXPECT_EQ(reading.request().number, 1u);
}

TEST_F(ReadingAFile, ASlaveThatNeverEndsIsNoFile) {
    (void)reading.answer(data(1));
    (void)reading.answer(data(2));
    const auto step = reading.answer(data(3));
    EXPECT_EQ(step.kind, Kind::broken);
    EXPECT_EQ(step.code, foe_error::disk_full);
    EXPECT_LE(reading.file().size(), limit);
}

TEST_F(ReadingAFile, RefusalsAndWhatIsNoAnswer) {
    EXPECT_EQ(reading.answer({FoeOp::error, foe_error::illegal, {}}).kind, Kind::next) << "an earlier transfer ended with that";
    EXPECT_EQ(reading.answer({FoeOp::error, foe_error::not_found, {}}).kind, Kind::refused);
    EXPECT_EQ(reading.answer({FoeOp::acknowledge, 0, {}}).kind, Kind::broken);
}

}  // namespace
}  // namespace taktwerk::ecat
