#include "ecat/exchange/acyclic_channel.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>

#include "core/bytes.hpp"
#include "tests/ecat/exchange/echo_slaves.hpp"
#include "tests/patience.hpp"

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;

class AcyclicChannelTest : public ::testing::Test {
protected:
    test::EchoSlaves slaves;
    LoopbackTransport transport{slaves};
    Exchange exchange{transport};
    AcyclicChannel channel{exchange, 20ms};
    Instant now{1s};

    std::size_t cycle(std::size_t max_datagrams = 4) {
        exchange.receive(now);
        channel.collect(now);
        const auto packed = channel.pack(now, max_datagrams);
        now += 1ms;
        return packed;
    }
    EntryId read(std::uint16_t ado, std::size_t size = 2) {
        const auto id = channel.submit(Command::FPRD, Address::physical(0x1001, ado), size);
        EXPECT_TRUE(id);
        return *id;
    }
};

TEST_F(AcyclicChannelTest, RequestGoesOutAndItsAnswerComesBack) {
    const auto data = std::vector<std::byte>{std::byte{1}, std::byte{2}};
    const auto id = channel.submit(Command::BRW, Address::physical(0, 0x0120), data);
    ASSERT_TRUE(id);
    EXPECT_FALSE(channel.poll(*id));

    EXPECT_EQ(cycle(), 1u);
    EXPECT_FALSE(channel.poll(*id)) << "under way";
    EXPECT_EQ(cycle(), 0u);

    const auto answer = channel.poll(*id);
    ASSERT_TRUE(answer);
    EXPECT_FALSE(answer->lost);
    EXPECT_EQ(answer->wkc, 2);
    EXPECT_EQ(answer->slaves_passed, 2);
    ASSERT_EQ(answer->data.size(), 2u);
    EXPECT_EQ(answer->data[1], std::byte{0x82});
    channel.release(*id);
    EXPECT_EQ(channel.in_use(), 0u);
}

TEST_F(AcyclicChannelTest, NoMoreThanTheGrantedDatagramsLeaveInOneCycleInOrderOfSubmission) {
    std::vector<EntryId> ids;
    for (std::uint16_t i = 0; i < 6; ++i) ids.push_back(read(static_cast<std::uint16_t>(0x0100 + i)));

    EXPECT_EQ(cycle(4), 4u);
    EXPECT_EQ(cycle(4), 2u);
    cycle();

    for (const auto id : ids) EXPECT_TRUE(channel.poll(id));
    std::vector<std::uint16_t> order;
    for (const auto& frame : slaves.seen) {
        FrameReader reader{frame};
        while (const auto datagram = reader.next()) order.push_back(datagram->address.ado());
    }
    EXPECT_EQ(order, (std::vector<std::uint16_t>{0x0100, 0x0101, 0x0102, 0x0103, 0x0104, 0x0105}));
}

TEST_F(AcyclicChannelTest, RequestThatDoesNotFitWaitsAndNothingOvertakesIt) {
    read(0x0100);
    const auto large = read(0x1000, max_datagram_data);
    const auto small = read(0x0102);
    EXPECT_EQ(cycle(), 1u);
    EXPECT_EQ(cycle(), 1u);
    EXPECT_EQ(cycle(), 1u);
    cycle();
    ASSERT_TRUE(channel.poll(large));
    EXPECT_EQ(channel.poll(large)->data.size(), max_datagram_data);
    EXPECT_TRUE(channel.poll(small));
}

TEST_F(AcyclicChannelTest, UnansweredRequestIsLostAfterTheTimeout) {
    transport.faults.drop_requests = 1;
    const auto id = read(0x0130);
    cycle();
    for (int i = 0; i < 19; ++i) {
        EXPECT_FALSE(channel.poll(id)) << i;
        cycle();
    }
    cycle();
    const auto answer = channel.poll(id);
    ASSERT_TRUE(answer);
    EXPECT_TRUE(answer->lost);
    EXPECT_TRUE(answer->data.empty());
    EXPECT_EQ(exchange.statistics().lost, 1u);
}

TEST_F(AcyclicChannelTest, RequestIsLostAtOnceWhenTheLinkDoesNotTakeIt) {
    transport.faults.link_down = true;
    const auto id = read(0x0130);
    EXPECT_EQ(cycle(), 0u);
    ASSERT_TRUE(channel.poll(id));
    EXPECT_TRUE(channel.poll(id)->lost);
}

TEST_F(AcyclicChannelTest, EntryReleasedUnderWayIsFreeOnlyAfterItsAnswer) {
    const auto waiting = read(0x0100);
    channel.release(waiting);
    EXPECT_EQ(channel.in_use(), 0u);

    const auto flying = read(0x0102);
    cycle();
    channel.release(flying);
    EXPECT_EQ(channel.in_use(), 1u);
    EXPECT_TRUE(channel.poll(flying)->lost);
    cycle();
    EXPECT_EQ(channel.in_use(), 0u);
}

TEST_F(AcyclicChannelTest, WhenAllEntriesAreTakenTheNextIsRefused) {
    std::vector<EntryId> ids;
    for (std::size_t i = 0; i < AcyclicChannel::entry_count; ++i) ids.push_back(read(0x0130));
    EXPECT_FALSE(channel.submit(Command::FPRD, {}, std::size_t{2}));
    channel.release(ids[7]);
    EXPECT_TRUE(channel.submit(Command::FPRD, {}, std::size_t{2}));
    EXPECT_TRUE(channel.poll(ids[7])->lost) << "a stale id is not the new request";
    EXPECT_FALSE(channel.submit(Command::FPRD, {}, max_datagram_data + 1));
}

// Whoever came first gets the entry, whoever asks first: a script that gives one back must not take it again before the others.
TEST_F(AcyclicChannelTest, EntriesGoToThoseWhoCameFirst) {
    std::vector<EntryId> ids;
    for (std::size_t i = 0; i < AcyclicChannel::entry_count; ++i) ids.push_back(read(0x0130));
    const std::array<std::byte, 2> data{};
    const auto ask = [&](EntryTurn& turn) { return channel.submit_in_turn(turn, Command::FPRD, Address::physical(0x1001, 0), data, {}); };
    EntryTurn first, third;
    EXPECT_FALSE(ask(first));
    {
        EntryTurn second;
        EXPECT_FALSE(ask(second));
        EXPECT_FALSE(ask(third));
        channel.release(ids[0]);
        EXPECT_FALSE(ask(third)) << "two came before";
        EXPECT_FALSE(ask(second)) << "one came before";
        EXPECT_TRUE(ask(first));
        EXPECT_FALSE(ask(second)) << "taken";
    }
    channel.release(ids[1]);
    EXPECT_TRUE(ask(third)) << "the second left the line";

    // Two free entries: the first two may take them in any order.
    EntryTurn a, b, c;
    EXPECT_FALSE(ask(a));
    EXPECT_FALSE(ask(b));
    EXPECT_FALSE(ask(c));
    channel.release(ids[2]);
    channel.release(ids[3]);
    EXPECT_FALSE(ask(c));
    EXPECT_TRUE(ask(b));
    EXPECT_FALSE(ask(c));
    EXPECT_TRUE(ask(a));
}

// Only so many may wait for a gate; those in line for that keep nobody from an entry.
TEST_F(AcyclicChannelTest, WhoWaitsForAGateIsPassedInLine) {
    std::atomic<std::uint64_t> word{0};
    SendGate gate;
    gate.word = &word;
    const std::array<std::byte, 2> data{};
    for (std::size_t i = 0; i < AcyclicChannel::max_gated; ++i)
        ASSERT_TRUE(channel.submit_gated(Command::FPRD, Address::physical(0x1001, 0x0130), data, gate));
    EntryTurn gated, plain;
    EXPECT_FALSE(channel.submit_in_turn(gated, Command::FPRD, Address::physical(0x1001, 0), data, gate));
    EXPECT_TRUE(channel.submit_in_turn(plain, Command::FPRD, Address::physical(0x1001, 0), data, {}));
}

TEST_F(AcyclicChannelTest, NothingIsSentWhenNothingWaits) {
    EXPECT_EQ(cycle(), 0u);
    EXPECT_EQ(exchange.statistics().sent, 0u);
    read(0x0130);
    EXPECT_EQ(cycle(0), 0u) << "no grant";
    EXPECT_EQ(exchange.statistics().sent, 0u);
}

// One service thread and one cycle thread: each answer belongs to its request. (The thread sanitizer watches.)
TEST_F(AcyclicChannelTest, ServiceAndCycleShareTheEntriesWithoutLocks) {
    std::atomic<bool> done{false};
    std::thread service{[&] {
        for (std::uint32_t i = 0; i < 2000; ++i) {
            std::array<std::byte, 4> data{};
            store_le<std::uint32_t>(data, 0, i & 0x7F7F7F7Fu);
            const auto id = channel.submit(Command::FPRW, Address::physical(0x1001, 0x0F80), data);
            if (!id) continue;
            if (i % 7 == 0) {  // changes its mind
                channel.release(*id);
                continue;
            }
            std::optional<AcyclicAnswer> answer;
            for (auto patience = Patience::of_threads(); patience.lasts(!(answer = channel.poll(*id)));) std::this_thread::yield();
            if (!answer) break;
            EXPECT_FALSE(answer->lost);
            if (!answer->lost) {
                EXPECT_EQ(load_le<std::uint32_t>(answer->data), (i & 0x7F7F7F7Fu) | 0x80808080u);
            }
            channel.release(*id);
        }
        done = true;
    }};
    for (auto patience = Patience::of_threads(); patience.lasts(!done);) {
        cycle();
        std::this_thread::yield();
    }
    service.join();
    for (int i = 0; i < 3; ++i) cycle();
    EXPECT_EQ(channel.in_use(), 0u);
}

// Bit 3 of a word that somebody else sets: the request waits for it, those behind it do not.
TEST_F(AcyclicChannelTest, AGatedRequestLeavesWhenItsBitIsSet) {
    std::atomic<std::uint64_t> word{0};
    SendGate gate;
    gate.word = &word;
    gate.bit = 3;
    const std::array<std::byte, 2> data{};
    const auto gated = channel.submit_gated(Command::FPRD, Address::physical(0x1001, 0x0130), data, gate);
    ASSERT_TRUE(gated);
    const auto other = read(0x0110);

    EXPECT_EQ(cycle(), 1u);
    cycle();
    EXPECT_TRUE(channel.poll(other));
    EXPECT_FALSE(channel.poll(*gated));

    word.store(0x08);
    EXPECT_EQ(cycle(), 1u);
    cycle();
    EXPECT_TRUE(channel.poll(*gated));
}

TEST_F(AcyclicChannelTest, ARequestBehindAnotherLeavesInALaterFrame) {
    const auto first = read(0x0110);
    SendGate gate;
    gate.behind = first;
    const std::array<std::byte, 2> data{};
    const auto second = channel.submit_gated(Command::FPRD, Address::physical(0x1001, 0x0130), data, gate);
    ASSERT_TRUE(second);
    read(0x0120);

    EXPECT_EQ(cycle(), 2u) << "the first and the third";
    EXPECT_EQ(cycle(), 1u) << "the second, although the first is not released";
    cycle();
    EXPECT_TRUE(channel.poll(*second));
}

TEST_F(AcyclicChannelTest, ARequestBehindOneThatIsGoneLeavesAtOnce) {
    const auto first = read(0x0110);
    cycle();
    cycle();
    channel.release(first);
    SendGate gate;
    gate.behind = first;
    const std::array<std::byte, 2> data{};
    ASSERT_TRUE(channel.submit_gated(Command::FPRD, Address::physical(0x1001, 0x0130), data, gate));
    EXPECT_EQ(cycle(), 1u);
}

TEST_F(AcyclicChannelTest, OnlyWhatHasNotLeftCanBeWithdrawn) {
    const auto waits = read(0x0110);
    EXPECT_TRUE(channel.withdraw(waits));
    EXPECT_EQ(channel.in_use(), 0u);
    EXPECT_EQ(cycle(), 0u);

    const auto left = read(0x0110);
    cycle();
    EXPECT_FALSE(channel.withdraw(left));
    cycle();
    EXPECT_TRUE(channel.poll(left)) << "its answer is not lost";
}

TEST_F(AcyclicChannelTest, GatedRequestsLeaveRoomForOthers) {
    std::atomic<std::uint64_t> word{0};
    SendGate gate;
    gate.word = &word;
    const std::array<std::byte, 2> data{};
    std::size_t taken = 0;
    while (taken < 100 && channel.submit_gated(Command::FPRD, Address::physical(0x1001, 0x0130), data, gate)) ++taken;
    EXPECT_EQ(taken, AcyclicChannel::max_gated);
    EXPECT_LT(AcyclicChannel::max_gated, AcyclicChannel::entry_count);
    read(0x0110);
}

}  // namespace
}  // namespace taktwerk::ecat
