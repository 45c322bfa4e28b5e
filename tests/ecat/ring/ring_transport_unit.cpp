// Two interfaces, one ring: what comes back of a frame with every cable in, and with each of them out.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/guard/allocation_guard.hpp"
#include "tests/ecat/ring/ring_probe.hpp"

namespace taktwerk::ecat::test {
namespace {

constexpr std::size_t slaves = 6;

TEST(RingTransport, InAClosedRingTheAnswerIsTheFrameThatWentRound) {
    RingProbe bus{slaves};
    const auto answer = bus.count();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->wkc, slaves);
    EXPECT_EQ(answer->adp, slaves);
    EXPECT_EQ(bus.ring.state().shape, RingShape::closed);
    EXPECT_EQ(bus.ring.statistics().round, 1u);
    EXPECT_EQ(bus.answers_too_many, 0);
}

// In the direction of the second interface a frame enters at port 1 and leaves at port 0, past the processing unit (ETG.1000.3).
TEST(RingTransport, WhatTheSecondInterfaceSendsIsProcessedByNobodyWhileTheRingIsClosed) {
    RingProbe bus{slaves};
    FrameBuilder builder{bus.frame, MacAddress{0, 1, 2, 3, 4, 5}};
    builder.add(Command::BRD, 1, Address::physical(0, reg::type), 1);
    ASSERT_TRUE(bus.second.send(builder.finish(), bus.now));
    const auto back = bus.first.receive(bus.frame, bus.now + 1ms);
    ASSERT_TRUE(back) << "it comes out at the first interface";
    FrameReader reader{std::span<const std::byte>{bus.frame}.first(back->size)};
    EXPECT_EQ(reader.next()->working_counter(), 0);
    EXPECT_EQ(bus.frame[6], std::byte{0}) << "no processing unit has marked it";
}

TEST(RingTransport, AtEveryBreakAllSlavesAnswerInOneFrame) {
    for (std::size_t place = 0; place <= slaves; ++place) {
        RingProbe bus{slaves};
        ASSERT_TRUE(bus.count());
        bus.cable(place, false);
        const auto answer = bus.count();
        ASSERT_TRUE(answer) << "break " << place;
        EXPECT_EQ(answer->wkc, slaves) << "break " << place;
        EXPECT_EQ(answer->adp, slaves) << "break " << place;
        const auto expected = place == 0 ? RingShape::first_silent : place == slaves ? RingShape::second_silent : RingShape::open;
        EXPECT_EQ(bus.ring.state().shape, expected) << "break " << place;
        EXPECT_EQ(bus.ring.state().opened, 1u);
        if (place > 0 && place < slaves) {
            EXPECT_EQ(bus.ring.state().before_break, place);
            EXPECT_EQ(bus.ring.state().behind_break, slaves - place);
        }
        EXPECT_EQ(bus.answers_too_many, 0);
    }
}

// Each half counts its slaves from 0, the second one from the break on (its slaves process a frame on the way back).
TEST(RingTransport, PositionsCountThroughABreak) {
    for (std::size_t place = 1; place < slaves; ++place) {
        RingProbe bus{slaves};
        ASSERT_TRUE(bus.count());
        bus.cable(place, false);
        ASSERT_TRUE(bus.count());
        for (std::uint16_t p = 0; p < slaves; ++p) {
            const auto station = static_cast<std::uint16_t>(0x1001 + p);
            const auto written = bus.ask(Command::APWR, Address::position(p, reg::station_address), bytes_of(station));
            ASSERT_TRUE(written);
            EXPECT_EQ(written->wkc, 1) << "position " << p << ", break " << place;
        }
        for (std::uint16_t p = 0; p < slaves; ++p)
            EXPECT_EQ(bus.network.slave(p).controller().station_address(), 0x1001 + p) << "break " << place;
    }
}

// The first frame behind a break does not know of it yet: it may reach nobody behind it, but never a wrong one.
TEST(RingTransport, AFrameThatDoesNotKnowOfTheBreakYetReachesNoWrongSlave) {
    for (std::size_t place = 1; place < slaves; ++place)
        for (std::uint16_t p = 0; p < slaves; ++p) {
            RingProbe bus{slaves};
            ASSERT_TRUE(bus.count());
            bus.cable(place, false);
            const auto written = bus.ask(Command::APWR, Address::position(p, reg::station_address), bytes_of(std::uint16_t{0x1234}));
            ASSERT_TRUE(written);
            for (std::uint16_t other = 0; other < slaves; ++other) {
                const std::uint16_t station = bus.network.slave(other).controller().station_address();
                EXPECT_EQ(station, other == p && p < place ? 0x1234 : 0) << "slave " << other << ", position " << p << ", break " << place;
            }
        }
}

// Nor does one that gets lost make the second half count from elsewhere.
TEST(RingTransport, ALostFrameDoesNotMoveThePositions) {
    RingProbe bus{slaves};
    ASSERT_TRUE(bus.count());
    bus.cable(3, false);
    ASSERT_TRUE(bus.count());
    bus.first.faults.drop_answers = 1;
    ASSERT_TRUE(bus.count());
    EXPECT_EQ(bus.ring.state().shape, RingShape::first_silent);
    const auto written = bus.ask(Command::APWR, Address::position(1, reg::station_address), bytes_of(std::uint16_t{0x1234}));
    ASSERT_TRUE(written);
    EXPECT_EQ(written->wkc, 1);
}

// Each half counts from its own end: who is missing, in front of them or between them, moves nobody to another position.
TEST(RingTransport, PositionsBehindABreakStayWhereOthersVanish) {
    RingProbe bus{slaves};
    ASSERT_TRUE(bus.count());
    bus.cable(3, false);
    ASSERT_TRUE(bus.count());
    bus.cable(0, false);  // 0 to 2 are gone
    for (int frames = 0; frames < 20; ++frames) {
        const auto written = bus.ask(Command::APWR, Address::position(4, reg::station_address), bytes_of(std::uint16_t{0x1234}));
        ASSERT_TRUE(written);
        EXPECT_EQ(written->wkc, 1);
    }
    for (std::uint16_t s = 0; s < slaves; ++s) EXPECT_EQ(bus.network.slave(s).controller().station_address(), s == 4 ? 0x1234 : 0) << s;
}

// A twin that went round has met nobody: it says nothing of who is there.
TEST(RingTransport, ALostFrameIsNotAnsweredByItsTwin) {
    RingProbe bus{slaves};
    ASSERT_TRUE(bus.count());
    bus.first.faults.drop_requests = 1;
    EXPECT_FALSE(bus.count());
    ASSERT_TRUE(bus.count());
    EXPECT_EQ(bus.count()->wkc, slaves);
}

struct RingHalves : ::testing::Test {
    RingProbe bus{slaves};
    void SetUp() override {
        ASSERT_TRUE(bus.count());
        bus.cable(3, false);
        ASSERT_TRUE(bus.count());
    }
    std::optional<ReceivedFrame> answer_to(Command command, Address address) {
        bus.send(command, address, Bytes(2));
        bus.now += 1ms;
        const auto received = bus.ring.receive(bus.frame, bus.now);
        EXPECT_FALSE(bus.ring.receive(bus.frame, bus.now));
        return received;
    }
};

TEST_F(RingHalves, AnAnswerWhoseOtherHalfGotLostSaysSo) {
    EXPECT_FALSE(answer_to(Command::BRD, Address::physical(0, reg::type))->half);
    for (auto* end : {&bus.first, &bus.second}) {
        end->faults.drop_answers = 1;
        EXPECT_TRUE(answer_to(Command::BRD, Address::physical(0, reg::type))->half);
        EXPECT_FALSE(answer_to(Command::BRD, Address::physical(0, reg::type))->half);
    }
}

TEST_F(RingHalves, AHalfThatIsGoneIsNotWaitedFor) {
    bus.cable(slaves, false);
    int lost = 0;
    for (int frames = 0; frames < 10; ++frames) lost += answer_to(Command::BRD, Address::physical(0, reg::type))->half ? 1 : 0;
    EXPECT_LE(lost, 2) << "two cycles";
    bus.second.faults.link_down = true;
    EXPECT_FALSE(answer_to(Command::BRD, Address::physical(0, reg::type))->half);
}

TEST_F(RingHalves, APositionThatWasMeantForAnotherBreakIsToBeAskedAgain) {
    bus.cable(3, true);
    bus.cable(2, false);
    EXPECT_TRUE(answer_to(Command::APRD, Address::position(4, reg::type))->half);
    EXPECT_FALSE(answer_to(Command::APRD, Address::position(4, reg::type))->half);
    bus.cable(2, true);
    bus.cable(4, false);
    EXPECT_FALSE(answer_to(Command::BRD, Address::physical(0, reg::type))->half) << "no position in it";
}

TEST(RingTransport, ABreakCostsTheFramesUnderWayAndNoOther) {
    for (std::size_t place = 0; place <= slaves; ++place) {
        RingProbe bus{slaves};
        ASSERT_TRUE(bus.count());
        bus.send(Command::BRD, Address::physical(0, reg::type), Bytes(1));
        bus.now += 1us;
        bus.cable(place, false);
        bus.now += 1ms;
        EXPECT_FALSE(bus.receive()) << "it was under way";
        for (int i = 0; i < 5; ++i) {
            const auto answer = bus.count();
            ASSERT_TRUE(answer);
            EXPECT_EQ(answer->wkc, slaves);
        }
        bus.cable(place, true);
        for (int i = 0; i < 5; ++i) {
            const auto answer = bus.count();
            ASSERT_TRUE(answer) << "healed";
            EXPECT_EQ(answer->wkc, slaves);
            EXPECT_EQ(bus.ring.state().shape, RingShape::closed);
        }
    }
}

TEST(RingTransport, OneInterfaceWithoutCarrierIsEnough) {
    for (const bool of_first : {true, false}) {
        RingProbe bus{slaves};
        ASSERT_TRUE(bus.count());
        bus.cable(of_first ? 0 : slaves, false);
        (of_first ? bus.first : bus.second).faults.link_down = true;
        EXPECT_TRUE(bus.ring.link_up());
        bus.send(Command::BRD, Address::physical(0, reg::type), Bytes(1));
        EXPECT_TRUE(bus.sent);
        bus.now += 20us;  // no waiting for a copy that never left
        const auto answer = bus.receive();
        ASSERT_TRUE(answer);
        EXPECT_EQ(answer->wkc, slaves);
        EXPECT_EQ(bus.ring.statistics().unsent, 1u);
        bus.first.faults.link_down = bus.second.faults.link_down = true;
        EXPECT_FALSE(bus.ring.link_up());
        bus.send(Command::BRD, Address::physical(0, reg::type), Bytes(1));
        EXPECT_FALSE(bus.sent);
    }
}

TEST(RingTransport, ACopyWaitsForItsTwinNoLongerThanItsPatience) {
    RingProbe bus{slaves};
    ASSERT_TRUE(bus.count());
    bus.cable(4, false);
    bus.second.faults.drop_requests = 1;
    bus.send(Command::BRD, Address::physical(0, reg::type), Bytes(1));
    bus.now += 249us;
    EXPECT_FALSE(bus.receive());
    bus.now += 1us;
    const auto answer = bus.receive();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->wkc, 4) << "who is missing shows in the working counter";
}

TEST(RingTransport, ATwinThatIsLateIsNotAnAnswer) {
    RingProbe bus{slaves};
    ASSERT_TRUE(bus.count());
    bus.cable(4, false);
    bus.second.faults.delay_answers = 1;
    bus.second.faults.delay = 2ms;
    bus.send(Command::BRD, Address::physical(0, reg::type), Bytes(1));
    bus.now += 1ms;
    ASSERT_TRUE(bus.receive());
    EXPECT_FALSE(bus.receive());
    bus.now += 5ms;
    EXPECT_FALSE(bus.receive());
    EXPECT_EQ(bus.ring.statistics().late_copies, 1u);
}

TEST(RingTransport, AMangledCopyIsNotMerged) {
    RingProbe bus{slaves};
    ASSERT_TRUE(bus.count());
    bus.cable(4, false);
    bus.second.faults.corrupt_answers = 1;
    bus.second.faults.corrupt_bit = 16 * 8;  // the command of its first datagram
    const auto answer = bus.count();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->wkc, 4);
    EXPECT_EQ(bus.ring.statistics().mangled, 1u);
}

// At the moment of mending one copy may go all the way round while its twin comes back from a half that is no more.
TEST(RingTransport, WhatWentRoundHasMetEverybodyAndItsTwinDoesNotCount) {
    RingProbe bus{slaves};
    ASSERT_TRUE(bus.count());
    bus.cable(4, false);
    bus.first.faults.drop_answers = 1;
    bus.send(Command::BRD, Address::physical(0, reg::type), Bytes(1));  // its twin has met two slaves
    std::array<std::byte, min_frame_size> round{};
    MacAddress source = bus.ring.mac();
    source[0] |= 0x02;
    FrameBuilder builder{round, source};
    builder.add(Command::BRD, bus.index, Address::physical(slaves, reg::type), 1);
    (void)builder.finish();
    store_le(std::span{round}, 16 + 10 + 1, static_cast<std::uint16_t>(slaves));  // the working counter, behind one byte of data
    bus.second.inject(round, bus.now + 10us);
    bus.now += 1ms;
    const auto answer = bus.receive();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->wkc, slaves);
    EXPECT_EQ(answer->adp, slaves);
}

// As long as the ring is closed nobody needs the twin; without it the next break would take slaves away, and nobody would know before.
TEST(RingTransport, ASecondInterfaceThatSendsNothingIsSeenWhileTheRingIsClosed) {
    RingProbe bus{slaves};
    bus.second.faults.drop_requests = 1'000'000;
    for (int i = 0; i < 49; ++i) ASSERT_EQ(bus.count()->wkc, slaves);
    EXPECT_EQ(bus.ring.state().shape, RingShape::closed) << "some frames may be lost";
    ASSERT_EQ(bus.count()->wkc, slaves);
    EXPECT_EQ(bus.ring.state().shape, RingShape::one_way);
    EXPECT_TRUE(bus.ring.state().needs_mending());
    EXPECT_EQ(bus.ring.state().before_break, slaves);
    EXPECT_EQ(bus.ring.state().behind_break, 0);
    bus.second.faults.drop_requests = 0;
    ASSERT_EQ(bus.count()->wkc, slaves);
    EXPECT_EQ(bus.ring.state().shape, RingShape::closed);
}

TEST(RingTransport, TwinsThatAreAlwaysLateAreTwinsAllTheSame) {
    RingProbe bus{slaves};
    bus.second.faults.delay_answers = 1'000'000;
    bus.second.faults.delay = 3ms;
    for (int i = 0; i < 200; ++i) {
        ASSERT_EQ(bus.count()->wkc, slaves);
        ASSERT_EQ(bus.ring.state().shape, RingShape::closed) << i;
    }
}

// The first slave's cable in the second interface, the last one's in the first.
TEST(RingTransport, ExchangedPlugsAreSeen) {
    RingProbe bus{slaves};
    RingTransport ring{bus.second, bus.first, 250us};
    for (std::uint8_t i = 1; i < 60; ++i) {
        std::array<std::byte, max_frame_size> frame{};
        FrameBuilder builder{frame, ring.mac()};
        builder.add(Command::BRD, i, Address::physical(0, reg::type), 1);
        ASSERT_TRUE(ring.send(builder.finish(), bus.now));
        bus.now += 1ms;
        const auto received = ring.receive(frame, bus.now);
        ASSERT_TRUE(received);
        FrameReader reader{std::span<const std::byte>{frame}.first(received->size)};
        EXPECT_EQ(reader.next()->working_counter(), slaves) << "each is reached";
        EXPECT_EQ(ring.state().shape, RingShape::exchanged);
        EXPECT_EQ(ring.state().behind_break, slaves);
        EXPECT_FALSE(ring.receive(frame, bus.now));
    }
}

TEST(RingTransport, FramesOfOthersPassAsTheyAre) {
    RingProbe bus{slaves};
    std::array<std::byte, min_frame_size> buffer{};
    FrameBuilder builder{buffer, MacAddress{0, 0x11, 0x22, 0x33, 0x44, 0x55}};
    builder.add(Command::BRD, 9, Address::physical(0, reg::type), 1);
    bus.second.inject(builder.finish(), bus.now);
    const auto received = bus.ring.receive(bus.frame, bus.now);
    ASSERT_TRUE(received);
    EXPECT_TRUE(std::equal(buffer.begin(), buffer.end(), bus.frame.begin()));
}

// --- the reference time -------------------------------------------------------------------------------------------------------

struct RingClock : ::testing::Test {
    static constexpr std::uint16_t reference = 0x1001;
    RingProbe bus{slaves};
    void SetUp() override {
        ASSERT_TRUE(bus.count());
        const auto written = bus.ask(Command::APWR, Address::position(0, reg::station_address), bytes_of(reference));
        ASSERT_EQ(written->wkc, 1);
    }
    std::optional<RingProbe::Answer> distribute(std::int64_t guess) {
        return bus.ask(Command::FRMW, Address::physical(reference, reg::dc_system_time), bytes_of(guess));
    }
    /// The master's guess is far off all clocks here: whoever took it shows a large difference.
    std::size_t who_took(std::int64_t guess) {
        std::size_t took = 0;
        for (std::size_t s = 0; s < slaves; ++s) {
            const auto d = bus.network.slave(s).controller().clock().mean_difference();
            took += std::abs(d) > guess / 2 ? 1 : 0;
        }
        return took;
    }
};

TEST_F(RingClock, TheHalfWithoutTheReferenceIsGivenNoTime) {
    constexpr std::int64_t guess = 3'000'000'000;
    bus.cable(2, false);
    for (int i = 0; i < 3; ++i) {
        const auto answer = distribute(guess);
        ASSERT_TRUE(answer);
        EXPECT_NE(load_le<std::int64_t>(answer->data), guess) << "the reference's";
        EXPECT_EQ(answer->wkc, 2) << "the reference and who is with it";
    }
    EXPECT_EQ(who_took(guess), 0u);
}

TEST_F(RingClock, TheHalfWithoutTheReferenceIsHandedTheTimeOnWhenToldTo) {
    constexpr std::int64_t guess = 3'000'000'000;
    bus.cable(2, false);
    bus.ring.set_clocks({.hand_on = true, .ahead = 500});
    const auto answer = distribute(guess);
    ASSERT_TRUE(answer);
    EXPECT_NE(load_le<std::int64_t>(answer->data), guess) << "the reference's";
    EXPECT_EQ(who_took(guess), slaves - 2);
}

TEST_F(RingClock, FollowsTheReferenceToTheOtherHalf) {
    constexpr std::int64_t guess = 3'000'000'000;
    bus.cable(0, false);  // all of them are the second interface's now
    const auto read = distribute(guess);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->wkc, 1) << "its time is read, and given to nobody: the frame did not know";
    const auto answer = distribute(guess);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->wkc, slaves);
    EXPECT_NE(load_le<std::int64_t>(answer->data), guess);
    bus.cable(0, true);
    ASSERT_TRUE(distribute(guess));
    EXPECT_EQ(distribute(guess)->wkc, slaves) << "and back";
    EXPECT_EQ(who_took(guess), 0u);
}

TEST(RingTransport, SendingAndReceivingUseNoHeap) {
    RingProbe bus{slaves};
    ASSERT_TRUE(bus.count());
    bus.cable(3, false);
    std::array<std::byte, max_frame_size> frame{};
    FrameBuilder builder{frame, bus.ring.mac()};
    builder.add(Command::BRD, 200, Address::physical(0, reg::type), 1);
    const auto built = builder.finish();
    const NoAllocationScope scope;
    ASSERT_TRUE(bus.ring.send(built, bus.now));
    const auto received = bus.ring.receive(bus.frame, bus.now + 1ms);
    EXPECT_EQ(scope.used().total(), 0u);
    EXPECT_TRUE(received);
}

}  // namespace
}  // namespace taktwerk::ecat::test
