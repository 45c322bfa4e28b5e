// Times of bytes and gaps, worked out by hand from baud rate and character format.

#include "modbus/line/virtual_line.hpp"

#include <gtest/gtest.h>

#include "tests/modbus/line/echo_station.hpp"

namespace taktwerk::modbus {
namespace {

using namespace std::chrono_literals;

// XP200 manual 9.3: a character of 8E1 has 11 bits, of 8N1 10, of 8E2 12; at 19200 baud 11 bits take 572.916 us.
TEST(LineSettings, CharactersAndGaps) {
    constexpr LineSettings factory;
    EXPECT_EQ(factory.bits_per_character(), 11);
    EXPECT_EQ(factory.duration(1), 572'916ns);
    EXPECT_EQ(factory.frame_gap(), 2'005'208ns);    // 3.5 characters
    EXPECT_EQ(factory.character_gap(), 859'375ns);  // 1.5 characters
    constexpr LineSettings plain{4800, Parity::none, 1}, two{38400, Parity::even, 2};
    EXPECT_EQ(plain.bits_per_character(), 10);
    EXPECT_EQ(two.bits_per_character(), 12);
    EXPECT_EQ(two.duration(1), 312'500ns);
}

// 8 bytes out (4.583 ms), 3.5 characters (2.005 ms), turnaround 5 ms, 9 bytes back (5.156 ms): the last byte is there 16.745 ms after the start.
TEST(VirtualLine, AnAnswerArrivesByteByByte) {
    VirtualLine line{LineSettings{}};
    EchoStation station{1};
    line.connect(station);
    const Instant start{1s};
    ASSERT_TRUE(line.send(encode(read_status(1, 5, 2)).span(), start));

    std::array<std::byte, 64> into{};
    EXPECT_EQ(line.receive(into, start + 12'160ms / 1000), 0u);  // the first byte ends after 12.161 ms
    ASSERT_EQ(station.heard_at.size(), 1u);
    EXPECT_EQ(station.heard_at[0], start + 4'583'333ns + 2'005'208ns);
    EXPECT_EQ(line.receive(into, start + 12'162us), 1u);
    EXPECT_EQ(line.receive(into, start + 16'744us), 7u);
    EXPECT_EQ(line.receive(into, start + 16'746us), 1u);
    EXPECT_EQ(line.receive(into, start + 1s), 0u);
}

TEST(VirtualLine, AStationWithAnotherFormatHearsNothing) {
    VirtualLine line{LineSettings{}};
    EchoStation slow{1, {9600, Parity::even, 1}}, plain{1, {19200, Parity::none, 1}};
    line.connect(slow);
    line.connect(plain);
    std::array<std::byte, 64> into{};
    ASSERT_TRUE(line.send(encode(clear_alarm(1)).span(), Instant{}));
    EXPECT_EQ(line.receive(into, Instant{1s}), 0u);
    EXPECT_TRUE(slow.heard_at.empty() && plain.heard_at.empty());
}

TEST(VirtualLine, ACutLineCarriesNothingEitherWay) {
    VirtualLine line{LineSettings{}};
    EchoStation station{1};
    line.connect(station);
    std::array<std::byte, 64> into{};
    line.cut(true);
    ASSERT_TRUE(line.send(encode(clear_alarm(1)).span(), Instant{}));
    EXPECT_EQ(line.receive(into, Instant{1s}), 0u);
    EXPECT_TRUE(station.heard_at.empty());
    line.cut(false);
    ASSERT_TRUE(line.send(encode(clear_alarm(1)).span(), Instant{2s}));
    EXPECT_EQ(line.receive(into, Instant{3s}), 4u);
}

}  // namespace
}  // namespace taktwerk::modbus
