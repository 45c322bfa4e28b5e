// Which answers count. The rules: reference/ethercat-masters.md 2.4, F1 and F3.
#include "ecat/exchange/exchange.hpp"

#include <gtest/gtest.h>

#include "core/bytes.hpp"
#include "ecat/transport/loopback.hpp"
#include "tests/ecat/exchange/echo_slaves.hpp"

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;

class ExchangeTest : public ::testing::Test {
protected:
    test::EchoSlaves slaves;
    LoopbackTransport transport{slaves};
    Exchange exchange{transport};
    Instant now{1s};

    SlotId send_status() {
        const auto slot = exchange.begin(FrameKind::cyclic);
        EXPECT_TRUE(slot);
        EXPECT_TRUE(exchange.add(*slot, Command::FPRD, Address::physical(0x1001, 0x0130), 2));
        EXPECT_TRUE(exchange.send(*slot, now));
        return *slot;
    }
    void later(Duration time) {
        now += time;
        exchange.receive(now);
    }
    /// Offset of the first datagram's header in a frame.
    static constexpr std::size_t first = 16;
    /// Sends one frame whose answer is changed by `tamper`, and says what became of it.
    SlotState state_after(std::function<void(std::span<std::byte>)> tamper) {
        slaves.tamper = std::move(tamper);
        const auto slot = send_status();
        later(1ms);
        return exchange.state(slot);
    }
};

TEST_F(ExchangeTest, AnswerIsGivenToItsSlotWithDataWorkingCounterAndRoundTrip) {
    const auto slot = exchange.begin(FrameKind::cyclic);
    ASSERT_TRUE(slot);
    EXPECT_EQ(exchange.state(*slot), SlotState::building);
    const auto broadcast = exchange.add(*slot, Command::BRD, Address::physical(0, 0x0130), 2);
    const auto process = exchange.add(*slot, Command::LRW, Address::logical(0x10000), 3);
    ASSERT_TRUE(broadcast && process);
    process->data[1] = std::byte{0x05};
    ASSERT_TRUE(exchange.send(*slot, now));
    EXPECT_EQ(exchange.state(*slot), SlotState::sent);
    EXPECT_TRUE(exchange.data(*slot, 0).empty());

    EXPECT_EQ(exchange.receive(now + 9us), 0u) << "still under way";
    EXPECT_EQ(exchange.receive(now + 20us), 1u);

    EXPECT_EQ(exchange.state(*slot), SlotState::answered);
    ASSERT_EQ(exchange.data(*slot, process->number).size(), 3u);
    EXPECT_EQ(exchange.data(*slot, process->number)[1], std::byte{0x85});
    EXPECT_EQ(exchange.wkc(*slot, process->number), 2);
    EXPECT_EQ(exchange.slaves_passed(*slot, broadcast->number), 2);
    EXPECT_EQ(exchange.slaves_passed(*slot, process->number), 0);
    EXPECT_EQ(exchange.round_trip(*slot), 10us);
    EXPECT_EQ(exchange.statistics().received, 1u);
    EXPECT_TRUE(exchange.data(*slot, 2).empty()) << "there is no third datagram";

    exchange.release(*slot);
    EXPECT_EQ(exchange.state(*slot), SlotState::free);
    EXPECT_EQ(exchange.statistics().lost, 0u);
}

TEST_F(ExchangeTest, FramesLeaveWithoutTheLocallyAdministeredBit) {
    LoopbackTransport veth{slaves, 8, MacAddress{0x4A, 1, 2, 3, 4, 5}};  // veth pairs have it set
    Exchange other{veth};
    const auto slot = other.begin(FrameKind::cyclic);
    (void)other.add(*slot, Command::NOP, {}, 0);
    ASSERT_TRUE(other.send(*slot, now));
    EXPECT_EQ(slaves.seen.back()[6], std::byte{0x48});
}

TEST_F(ExchangeTest, AnswerCountsAlsoWhenTheSlavesLeaveTheSourceAddressAlone) {
    slaves.sets_mac_bit = false;
    EXPECT_EQ(state_after({}), SlotState::answered);
}

TEST_F(ExchangeTest, WrongCommandIndexAddressLengthOrStructureIsRejected) {
    EXPECT_EQ(state_after([](auto f) { f[first] = std::byte{5}; }), SlotState::sent) << "FPWR instead of FPRD";
    EXPECT_EQ(state_after([](auto f) { f[first + 2] = std::byte{0x02}; }), SlotState::sent) << "another station";
    EXPECT_EQ(state_after([](auto f) { f[first + 4] = std::byte{0x34}; }), SlotState::sent) << "another register";
    EXPECT_EQ(state_after([](auto f) {
                  f[first + 6] = std::byte{1};
                  f[14] = std::byte{13};
              }),
              SlotState::sent)
        << "one byte less";
    EXPECT_EQ(state_after([](auto f) {
                  f[first + 7] = std::byte{0x80};
                  f[14] = std::byte{14 + 12};
              }),
              SlotState::sent)
        << "a datagram more";
    EXPECT_EQ(state_after([](auto f) { f[14] = std::byte{16}; }), SlotState::sent) << "bytes behind the last datagram";
    EXPECT_EQ(state_after([](auto f) { f[first + 1] = std::byte{200}; }), SlotState::sent) << "an index never sent";
    EXPECT_EQ(state_after([](auto f) {
                  f[12] = std::byte{8};
                  f[13] = std::byte{0};
              }),
              SlotState::sent)
        << "not EtherCAT";
    EXPECT_EQ(exchange.statistics().rejected, 8u);
    EXPECT_EQ(exchange.statistics().received, 0u);
}

// Byte 6 is the first of the source address; controllers set bit 1 of it, another master's differs elsewhere.
TEST_F(ExchangeTest, FramesOfAnotherMasterAreCountedAndNotTaken) {
    EXPECT_EQ(state_after([](auto f) { f[11] ^= std::byte{0x40}; }), SlotState::sent);
    EXPECT_EQ(exchange.statistics().foreign, 1u);
    EXPECT_EQ(exchange.statistics().rejected, 0u);
    EXPECT_EQ(state_after([](auto f) { f[6] |= std::byte{0x02}; }), SlotState::answered) << "as a real controller marks it";
    EXPECT_EQ(exchange.statistics().foreign, 1u);
}

TEST_F(ExchangeTest, ASecondDatagramWithAnotherIndexIsRejected) {
    slaves.tamper = [](std::span<std::byte> f) { f[first + 12 + 1] ^= std::byte{1}; };
    const auto slot = exchange.begin(FrameKind::cyclic);
    (void)exchange.add(*slot, Command::LRD, Address::logical(0), 0);
    (void)exchange.add(*slot, Command::LRD, Address::logical(0), 0);
    ASSERT_TRUE(exchange.send(*slot, now));
    later(1ms);
    EXPECT_EQ(exchange.state(*slot), SlotState::sent);
    EXPECT_EQ(exchange.statistics().rejected, 1u);
}

TEST_F(ExchangeTest, IncrementedAddressOfPositionCommandsIsAccepted) {
    for (const auto command : {Command::APRD, Command::APWR, Command::BRD, Command::BWR, Command::ARMW}) {
        const auto slot = exchange.begin(FrameKind::acyclic);
        (void)exchange.add(*slot, command, Address::position(1, 0x0010), 2);
        ASSERT_TRUE(exchange.send(*slot, now));
        later(1ms);
        EXPECT_EQ(exchange.state(*slot), SlotState::answered) << name(command);
        EXPECT_EQ(exchange.slaves_passed(*slot, 0), 2) << name(command);
        exchange.release(*slot);
    }
}

TEST_F(ExchangeTest, LateAnswerOfAGivenUpFrameIsCountedAndDropped) {
    transport.faults.delay_answers = 1;
    transport.faults.delay = 5ms;
    const auto old = send_status();
    later(1ms);
    EXPECT_EQ(exchange.state(old), SlotState::sent);
    exchange.release(old);
    EXPECT_EQ(exchange.statistics().lost, 1u);

    const auto fresh = send_status();
    later(1ms);
    EXPECT_EQ(exchange.state(fresh), SlotState::answered);
    later(10ms);

    EXPECT_EQ(exchange.statistics().late, 1u);
    EXPECT_EQ(exchange.statistics().received, 1u);
    EXPECT_EQ(exchange.state(old), SlotState::free);
}

// The same request each cycle, one answer very late: it must never be taken for a newer frame's, not even after the 8-bit
// index has come round.
TEST_F(ExchangeTest, LateAnswerIsNotTakenForANewerFrameAfterTheIndexWrapped) {
    transport.faults.delay_answers = 1;
    transport.faults.delay = 256ms - 5us;  // arrives just before the answer to the 256th frame after it
    const auto old = send_status();
    later(1ms);
    exchange.release(old);

    for (int cycle = 0; cycle < 300; ++cycle) {
        const auto slot = send_status();
        later(1ms);
        ASSERT_EQ(exchange.state(slot), SlotState::answered) << cycle;
        ASSERT_EQ(exchange.round_trip(slot), 10us) << cycle;
        exchange.release(slot);
    }
    EXPECT_EQ(exchange.statistics().late, 1u);
    EXPECT_EQ(exchange.statistics().duplicate + exchange.statistics().rejected, 0u);
}

TEST_F(ExchangeTest, DuplicateAnswerIsCountedAndDropped) {
    transport.faults.duplicate_answers = 1;
    const auto slot = send_status();
    later(1ms);
    EXPECT_EQ(exchange.state(slot), SlotState::answered);
    EXPECT_EQ(exchange.statistics().received, 1u);
    EXPECT_EQ(exchange.statistics().duplicate, 1u);
}

TEST_F(ExchangeTest, FrameWithoutAnswerExpires) {
    transport.faults.drop_answers = 1;
    const auto slot = send_status();
    later(1ms);
    exchange.expire(now, 2ms);
    EXPECT_EQ(exchange.state(slot), SlotState::sent);
    later(1ms);
    exchange.expire(now, 2ms);
    EXPECT_EQ(exchange.state(slot), SlotState::lost);
    EXPECT_EQ(exchange.wkc(slot, 0), 0);
    EXPECT_TRUE(exchange.data(slot, 0).empty());
    exchange.release(slot);
    EXPECT_EQ(exchange.statistics().lost, 1u);
}

TEST_F(ExchangeTest, EchoOfTheOwnFrameDoesNotHideTheAnswer) {
    struct EchoFirst final : Transport {  // a hub or an old kernel: the own frame comes back before the answer
        LoopbackTransport& real;
        std::vector<std::byte> own;
        explicit EchoFirst(LoopbackTransport& transport) : real(transport) {}
        bool send(std::span<const std::byte> frame, Instant at) noexcept override {
            own.assign(frame.begin(), frame.end());
            return real.send(frame, at);
        }
        std::optional<ReceivedFrame> receive(std::span<std::byte> buffer, Instant at) noexcept override {
            if (own.empty()) return real.receive(buffer, at);
            std::copy(own.begin(), own.end(), buffer.begin());
            const ReceivedFrame echo{own.size(), at};
            own.clear();
            return echo;
        }
        MacAddress mac() const noexcept override { return real.mac(); }
        bool link_up() const noexcept override { return true; }
    } hub{transport};
    Exchange other{hub};
    const auto slot = other.begin(FrameKind::cyclic);
    (void)other.add(*slot, Command::FPRD, Address::physical(0x1001, 0x0130), 2);
    ASSERT_TRUE(other.send(*slot, now));
    other.receive(now + 1ms);
    EXPECT_EQ(other.statistics().echoes, 1u);
    EXPECT_EQ(other.state(*slot), SlotState::answered);
    EXPECT_EQ(other.wkc(*slot, 0), 2);
}

// A looped cable without slaves returns frames untouched: that is an answer of nobody, not a lost frame.
TEST_F(ExchangeTest, FrameThatNobodyTouchedIsAnsweredWithWorkingCounterZeroWhenItExpires) {
    slaves.count = 0;
    slaves.sets_mac_bit = false;
    slaves.tamper = [](std::span<std::byte> f) { f[first + 10] = f[first + 11] = std::byte{0}; };
    const auto slot = send_status();
    later(1ms);
    EXPECT_EQ(exchange.state(slot), SlotState::sent);
    exchange.expire(now, 1ms);
    EXPECT_EQ(exchange.state(slot), SlotState::answered);
    EXPECT_EQ(exchange.wkc(slot, 0), 0);
    EXPECT_EQ(exchange.statistics().lost, 0u);
}

TEST_F(ExchangeTest, LinkThatDoesNotTakeAFrameIsCounted) {
    transport.faults.link_down = true;
    const auto slot = exchange.begin(FrameKind::cyclic);
    (void)exchange.add(*slot, Command::NOP, {}, 0);
    EXPECT_FALSE(exchange.send(*slot, now));
    EXPECT_EQ(exchange.state(*slot), SlotState::lost);
    EXPECT_EQ(exchange.statistics().send_errors, 1u);
    EXPECT_EQ(exchange.statistics().sent, 0u);
}

TEST_F(ExchangeTest, SixteenFramesCanBeUnderWayAndTheSeventeenthIsRefused) {
    std::vector<SlotId> slots;
    for (std::size_t i = 0; i < Exchange::slot_count; ++i) slots.push_back(send_status());
    EXPECT_FALSE(exchange.begin(FrameKind::cyclic));
    later(1ms);
    for (const auto slot : slots) EXPECT_EQ(exchange.state(slot), SlotState::answered);
    exchange.release(slots[3]);
    EXPECT_TRUE(exchange.begin(FrameKind::cyclic));
}

TEST_F(ExchangeTest, IdOfAReleasedSlotIsHarmless) {
    const auto old = send_status();
    later(1ms);
    exchange.release(old);
    const auto fresh = send_status();
    ASSERT_EQ(fresh.slot, old.slot);
    exchange.release(old);
    EXPECT_EQ(exchange.state(fresh), SlotState::sent);
    EXPECT_EQ(exchange.state(old), SlotState::free);
    EXPECT_FALSE(exchange.add(old, Command::NOP, {}, 0));
    EXPECT_EQ(exchange.state(SlotId{200, 1}), SlotState::free);
}

TEST_F(ExchangeTest, FullFrameTakesNoMoreDatagrams) {
    const auto slot = exchange.begin(FrameKind::cyclic);
    for (std::size_t i = 0; i < Exchange::max_datagrams; ++i) ASSERT_TRUE(exchange.add(*slot, Command::NOP, {}, 0)) << i;
    EXPECT_FALSE(exchange.fits(*slot, 0));
    EXPECT_FALSE(exchange.add(*slot, Command::NOP, {}, 0));
    ASSERT_TRUE(exchange.send(*slot, now));
    later(1ms);
    EXPECT_EQ(exchange.state(*slot), SlotState::answered);
}

TEST_F(ExchangeTest, TapSeesEachFrameOutAndIn) {
    struct Seen {
        int out = 0, in = 0;
    } seen;
    exchange.set_tap(
        [](void* context, std::span<const std::byte> frame, Instant, bool outgoing) noexcept {
            auto& counts = *static_cast<Seen*>(context);
            if (frame.size() >= min_frame_size) ++(outgoing ? counts.out : counts.in);
        },
        &seen);
    send_status();
    later(1ms);
    EXPECT_EQ(seen.out, 1);
    EXPECT_EQ(seen.in, 1);
}

}  // namespace
}  // namespace taktwerk::ecat
