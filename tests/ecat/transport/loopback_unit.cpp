#include "ecat/transport/loopback.hpp"

#include <gtest/gtest.h>

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;

/// Marks each frame with its number; every second one takes longer.
class Slaves final : public FrameSink {
public:
    std::size_t frames = 0;
    Duration flight = 10us;
    bool lose = false;
    Instant advanced{};
    void advance(Instant now) noexcept override { advanced = now; }
    std::optional<Duration> process(std::span<std::byte> frame, Instant) noexcept override {
        frame[0] = static_cast<std::byte>(++frames);
        if (lose) return std::nullopt;
        return flight;
    }
};

class Loopback : public ::testing::Test {
protected:
    Slaves slaves;
    LoopbackTransport transport{slaves, 4};
    std::array<std::byte, max_frame_size> buffer{};
    const std::array<std::byte, 60> frame{};
    const Instant start{1s};
};

TEST_F(Loopback, FrameArrivesAfterItsFlightTimeChangedByTheSlaves) {
    ASSERT_TRUE(transport.send(frame, start));
    EXPECT_EQ(transport.next_arrival(), start + 10us);
    EXPECT_FALSE(transport.receive(buffer, start + 10us - 1ns));
    const auto received = transport.receive(buffer, start + 1ms);
    ASSERT_TRUE(received);
    EXPECT_EQ(received->size, 60u);
    EXPECT_EQ(received->at, start + 10us);
    EXPECT_EQ(buffer[0], std::byte{1});
    EXPECT_EQ(slaves.advanced, start + 1ms);
    EXPECT_FALSE(transport.receive(buffer, start + 1ms));
}

TEST_F(Loopback, FramesComeInOrderOfArrivalNotOfSending) {
    slaves.flight = 100us;
    ASSERT_TRUE(transport.send(frame, start));
    slaves.flight = 10us;
    ASSERT_TRUE(transport.send(frame, start + 20us));
    ASSERT_TRUE(transport.send(frame, start + 20us));
    for (const auto expected : {2, 3, 1}) {
        ASSERT_TRUE(transport.receive(buffer, start + 1ms));
        EXPECT_EQ(buffer[0], static_cast<std::byte>(expected));
    }
}

TEST_F(Loopback, LostFramesNeverArrive) {
    slaves.lose = true;
    EXPECT_TRUE(transport.send(frame, start));
    slaves.lose = false;
    transport.faults.drop_requests = 1;
    EXPECT_TRUE(transport.send(frame, start));
    EXPECT_EQ(slaves.frames, 1u) << "the dropped request was not seen";
    transport.faults.drop_answers = 1;
    EXPECT_TRUE(transport.send(frame, start));
    EXPECT_EQ(slaves.frames, 2u) << "the slaves acted";
    EXPECT_FALSE(transport.receive(buffer, start + 1s));
    EXPECT_TRUE(transport.send(frame, start));
    EXPECT_TRUE(transport.receive(buffer, start + 1s)) << "each fault strikes as often as it says";
}

TEST_F(Loopback, AnswersAreDelayedDuplicatedAndCorruptedOnRequest) {
    transport.faults = {.delay_answers = 1, .delay = 2ms};
    ASSERT_TRUE(transport.send(frame, start));
    EXPECT_FALSE(transport.receive(buffer, start + 2ms));
    EXPECT_EQ(transport.receive(buffer, start + 3ms)->at, start + 2ms + 10us);

    transport.faults = {.duplicate_answers = 1};
    ASSERT_TRUE(transport.send(frame, start));
    EXPECT_TRUE(transport.receive(buffer, start + 1s));
    EXPECT_TRUE(transport.receive(buffer, start + 1s));
    EXPECT_FALSE(transport.receive(buffer, start + 1s));

    transport.faults = {.corrupt_answers = 1, .corrupt_bit = 8 * 20 + 3};
    ASSERT_TRUE(transport.send(frame, start));
    ASSERT_TRUE(transport.receive(buffer, start + 1s));
    EXPECT_EQ(buffer[20], std::byte{0x08});
}

TEST_F(Loopback, RefusesFramesWithoutLinkAndWithoutRoom) {
    transport.faults.link_down = true;
    EXPECT_FALSE(transport.link_up());
    EXPECT_FALSE(transport.send(frame, start));
    transport.faults.link_down = false;
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(transport.send(frame, start));
    EXPECT_FALSE(transport.send(frame, start));
    EXPECT_FALSE(transport.send({}, start));
}

}  // namespace
}  // namespace taktwerk::ecat
