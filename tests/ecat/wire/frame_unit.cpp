// The frame codec against frames written by hand from ETG.1000.4 (layout: reference/ethercat-masters.md section 5).
#include "ecat/wire/frame.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "core/bytes.hpp"
#include "tests/ecat/wire/bytes_of.hpp"

namespace taktwerk::ecat {
namespace {

using test::bytes_of;
using test::copy_of;

constexpr MacAddress source{0x00, 0x11, 0x22, 0x33, 0x44, 0x55};

std::vector<std::byte> frame_with(std::vector<std::byte> ecat) {
    auto frame = bytes_of({0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x00, 0x11, 0x22, 0x33, 0x44, 0x55, 0x88, 0xA4});
    frame.insert(frame.end(), ecat.begin(), ecat.end());
    return frame;
}

FrameError walk(std::span<const std::byte> frame, std::size_t* count = nullptr) {
    FrameReader reader{frame};
    std::size_t datagrams = 0;
    while (reader.next()) ++datagrams;
    if (count != nullptr) *count = datagrams;
    return reader.error();
}

TEST(FrameBuilder, WritesOneDatagramByteForByteAndPadsToTheMinimum) {
    std::array<std::byte, max_frame_size> buffer;
    buffer.fill(std::byte{0xEE});  // what a frame before left there
    FrameBuilder builder{buffer, source};

    builder.add(Command::BRD, 7, Address::physical(0, 0x0130), 2);

    // Length 12 + 2 = 0Eh, type 1 in the upper nibble.
    auto expected = frame_with(bytes_of({0x0E, 0x10, 0x07, 0x07, 0x00, 0x00, 0x30, 0x01, 0x02, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}));
    expected.resize(60);
    EXPECT_EQ(copy_of(builder.finish()), expected);
}

TEST(FrameBuilder, SetsMoreFollowsOnAllButTheLastDatagram) {
    std::array<std::byte, max_frame_size> buffer{};
    FrameBuilder builder{buffer, source};

    builder.add(Command::FRMW, 1, Address::physical(0x1001, 0x0910), 8);
    const auto data = builder.add(Command::LRW, 2, Address::logical(0x00010000), 4);
    store_le<std::uint32_t>(data, 0, 0x04030201);

    // 12 + 8 + 12 + 4 = 36 = 24h; first length field 8008h.
    // clang-format off
    auto expected = frame_with(bytes_of({0x24, 0x10,
        0x0E, 0x01, 0x01, 0x10, 0x10, 0x09, 0x08, 0x80, 0x00, 0x00, 0, 0, 0, 0, 0, 0, 0, 0, 0x00, 0x00,
        0x0C, 0x02, 0x00, 0x00, 0x01, 0x00, 0x04, 0x00, 0x00, 0x00, 1, 2, 3, 4, 0x00, 0x00}));
    // clang-format on
    expected.resize(60);
    EXPECT_EQ(copy_of(builder.finish()), expected);
    EXPECT_EQ(builder.datagrams(), 2u);
}

TEST(FrameBuilder, TakesTheLargestDatagramAndNotAByteMore) {
    std::array<std::byte, max_frame_size> buffer{};
    FrameBuilder builder{buffer, source};

    EXPECT_TRUE(builder.fits(max_datagram_data));
    EXPECT_FALSE(builder.fits(max_datagram_data + 1));
    EXPECT_TRUE(builder.add(Command::LRW, 0, Address::logical(0), max_datagram_data + 1).empty());
    EXPECT_EQ(builder.add(Command::LRW, 0, Address::logical(0), max_datagram_data).size(), 1486u);

    EXPECT_FALSE(builder.fits(0));
    EXPECT_EQ(builder.finish().size(), 1514u);
    EXPECT_EQ(walk(builder.finish()), FrameError::none);
}

TEST(FrameBuilder, RefusesABufferThatCannotHoldAnEthernetFrame) {
    std::array<std::byte, min_frame_size - 1> buffer{};
    FrameBuilder builder{buffer, source};

    EXPECT_FALSE(builder.fits(0));
    EXPECT_TRUE(builder.finish().empty());
}

TEST(Address, OfAPositionIsCountedDownSoThatTheSlaveSeesZero) {
    EXPECT_EQ(Address::position(0, 0x0010).adp(), 0x0000);
    EXPECT_EQ(Address::position(1, 0x0010).adp(), 0xFFFF);
    EXPECT_EQ(Address::position(3, 0x0010).adp(), 0xFFFD);
    EXPECT_EQ(Address::position(3, 0x0010).ado(), 0x0010);
    EXPECT_EQ(Address::physical(0x1001, 0x0130).raw, 0x01301001u);
}

TEST(FrameReader, GivesEachDatagramWithItsFields) {
    // clang-format off
    const auto frame = frame_with(bytes_of({0x22, 0x10,
        0x04, 0x05, 0x01, 0x10, 0x30, 0x01, 0x02, 0x80, 0x34, 0x12, 0x08, 0x00, 0x01, 0x00,
        0x0A, 0x06, 0x00, 0x00, 0x01, 0x00, 0x08, 0x40, 0x00, 0x00, 1, 2, 3, 4, 5, 6, 7, 8, 0x03, 0x02}));
    // clang-format on
    FrameReader reader{frame};

    const auto first = reader.next();
    ASSERT_TRUE(first);
    EXPECT_EQ(first->command, Command::FPRD);
    EXPECT_EQ(first->index, 5);
    EXPECT_EQ(first->address, Address::physical(0x1001, 0x0130));
    EXPECT_TRUE(first->more_follow);
    EXPECT_FALSE(first->circulating);
    EXPECT_EQ(first->irq, 0x1234);
    EXPECT_EQ(copy_of(first->data), bytes_of({8, 0}));
    EXPECT_EQ(first->working_counter(), 1);

    const auto second = reader.next();
    ASSERT_TRUE(second);
    EXPECT_EQ(second->command, Command::LRD);
    EXPECT_EQ(second->address.raw, 0x00010000u);
    EXPECT_TRUE(second->circulating);
    EXPECT_FALSE(second->more_follow);
    EXPECT_EQ(copy_of(second->data), bytes_of({1, 2, 3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(second->working_counter(), 0x0203);

    EXPECT_FALSE(reader.next());
    EXPECT_EQ(reader.error(), FrameError::none);
}

TEST(FrameReader, IgnoresPaddingBehindTheEtherCatLength) {
    auto frame = frame_with(bytes_of({0x0C, 0x10, 0x00, 0x01, 0, 0, 0, 0, 0x00, 0x00, 0, 0, 0, 0}));
    frame.resize(60, std::byte{0xAA});
    std::size_t count = 0;
    EXPECT_EQ(walk(frame, &count), FrameError::none);
    EXPECT_EQ(count, 1u);
}

TEST(FrameReader, NamesEachDefect) {
    EXPECT_EQ(walk({}), FrameError::too_short);
    EXPECT_EQ(walk(frame_with(bytes_of({0x0C}))), FrameError::too_short);

    auto other = frame_with(bytes_of({0x0C, 0x10, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(walk(other), FrameError::none);
    other[12] = std::byte{0x08}, other[13] = std::byte{0x00};  // IPv4
    EXPECT_EQ(walk(other), FrameError::not_ethercat);

    // Type 5: mailbox gateway.
    EXPECT_EQ(walk(frame_with(bytes_of({0x0C, 0x50, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}))), FrameError::wrong_type);
    // Length 0Dh with 0Ch bytes behind it.
    EXPECT_EQ(walk(frame_with(bytes_of({0x0D, 0x10, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}))), FrameError::length_beyond_frame);
    // A datagram of 5 data bytes in a length for none.
    EXPECT_EQ(walk(frame_with(bytes_of({0x0C, 0x10, 0, 1, 0, 0, 0, 0, 5, 0, 0, 0, 0, 0}))), FrameError::truncated_datagram);
    // "More follow", and nothing follows.
    EXPECT_EQ(walk(frame_with(bytes_of({0x0C, 0x10, 0, 1, 0, 0, 0, 0, 0, 0x80, 0, 0, 0, 0}))), FrameError::truncated_datagram);
    // Last datagram, and two bytes behind it inside the length.
    EXPECT_EQ(walk(frame_with(bytes_of({0x0E, 0x10, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 9, 9}))), FrameError::trailing_bytes);
    // Command 15.
    EXPECT_EQ(walk(frame_with(bytes_of({0x0C, 0x10, 15, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}))), FrameError::unknown_command);
}

TEST(FrameReader, OfALengthOfZeroHasNoDatagrams) {
    std::size_t count = 9;
    EXPECT_EQ(walk(frame_with(bytes_of({0x00, 0x10})), &count), FrameError::none);
    EXPECT_EQ(count, 0u);
}

TEST(FrameReader, IgnoresReservedBitsAsControllersDo) {
    // EtherCAT header bit 11 and datagram length bits 11..13.
    std::size_t count = 0;
    EXPECT_EQ(walk(frame_with(bytes_of({0x0C, 0x18, 0, 1, 0, 0, 0, 0, 0, 0x38, 0, 0, 0, 0})), &count), FrameError::none);
    EXPECT_EQ(count, 1u);
}

TEST(FrameReader, StaysInsideTheFrameForAnyTruncationAndAnyFlippedByte) {
    // clang-format off
    const auto good = frame_with(bytes_of({0x22, 0x10,
        0x04, 0x05, 0x01, 0x10, 0x30, 0x01, 0x02, 0x80, 0x34, 0x12, 0x08, 0x00, 0x01, 0x00,
        0x0A, 0x06, 0x00, 0x00, 0x01, 0x00, 0x08, 0x00, 0x00, 0x00, 1, 2, 3, 4, 5, 6, 7, 8, 0x03, 0x02}));
    // clang-format on
    const auto inside = [](std::span<const std::byte> frame) {
        FrameReader reader{frame};
        while (const auto datagram = reader.next()) {
            EXPECT_GE(datagram->header.data(), frame.data());
            EXPECT_LE(datagram->wkc.data() + datagram->wkc.size(), frame.data() + frame.size());
        }
    };
    for (std::size_t size = 0; size <= good.size(); ++size)
        inside(std::vector<std::byte>(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)));
    std::mt19937 random{1};
    for (int i = 0; i < 20000; ++i) {
        auto bad = good;
        bad[random() % bad.size()] = static_cast<std::byte>(random() & 0xFF);
        bad[random() % bad.size()] = static_cast<std::byte>(random() & 0xFF);
        inside(bad);
    }
}

TEST(FrameEditor, ChangesTheFrameInPlace) {
    auto frame = frame_with(bytes_of({0x0E, 0x10, 0x07, 0x07, 0x00, 0x00, 0x30, 0x01, 0x02, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}));
    FrameEditor editor{frame};
    auto datagram = editor.next();
    ASSERT_TRUE(datagram);

    store_le<std::uint16_t>(datagram->header, 2, 1);
    datagram->data[0] = std::byte{0x08};
    store_le<std::uint16_t>(datagram->wkc, 0, 1);

    EXPECT_EQ(frame,
              frame_with(bytes_of({0x0E, 0x10, 0x07, 0x07, 0x01, 0x00, 0x30, 0x01, 0x02, 0x00, 0x00, 0x00, 0x08, 0x00, 0x01, 0x00})));
    EXPECT_FALSE(editor.next());
    EXPECT_EQ(editor.error(), FrameError::none);
}

TEST(Command, NamesFollowTheStandard) {
    EXPECT_EQ(name(Command::NOP), "NOP");
    EXPECT_EQ(name(Command::FRMW), "FRMW");
    EXPECT_EQ(name(static_cast<Command>(15)), "unknown");
}

}  // namespace
}  // namespace taktwerk::ecat
