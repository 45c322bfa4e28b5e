// The cycle in OP: values, freshness, clocks, lost and late frames, slaves that fall and return.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/guard/allocation_guard.hpp"
#include "core/process_image.hpp"
#include "ecat/alarms.hpp"
#include "ecat/bringup/bus.hpp"
#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ProcessData, ReachesTheDriveAndComesBackTwoCyclesLater) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    const auto target = bus.master->output(0, 0x607A, 0).value();
    const auto actual = bus.master->input(0, 0x6064, 0).value();
    bus.run_for(20ms);

    write_signal(bus.master->outputs(), target, -123456);
    bus.cycle_once();  // sent; the drive takes it at the next SYNC0, half a cycle later, and latches its actual value there
    bus.cycle_once();  // the frame that carries the actual value leaves
    EXPECT_EQ(read_signal(bus.master->inputs(), actual), 0);
    bus.cycle_once();  // and is back
    EXPECT_EQ(read_signal(bus.master->inputs(), actual), -123456);
}

TEST(ProcessData, CycleSideAllocatesNothing) {
    TestBus bus{"sts"};
    ASSERT_TRUE(bus.bring_up());
    bus.run_for(50ms);
    const NoAllocationScope heap;
    std::array<AlarmFact, 8> facts;
    for (int i = 0; i < 100; ++i) {
        bus.now += 1ms;
        bus.master->receive(bus.now);
        (void)bus.master->active_faults(facts);
        (void)bus.master->outputs_effective(0, bus.now);
        bus.master->send(bus.now);
    }
    EXPECT_EQ(heap.used().total(), 0u) << heap.used().text();
}

TEST(ProcessData, TerminalsExchangeBits) {
    TestBus bus{"t"};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    write_signal(bus.master->outputs(), bus.master->output(0, 0x7000, 3).value(), 1);
    bus.run_for(5ms);
    EXPECT_EQ(read_signal(bus.master->inputs(), bus.master->input(0, 0x6000, 3).value()), 0);
    EXPECT_EQ(read_signal(bus.master->inputs(), bus.master->input(0, 0x6000, 4).value()), 1);
}

TEST(ProcessData, ObjectsThatAreNotMappedAreNamed) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    EXPECT_FALSE(bus.master->maps_output(0, 0x60FF, 0));
    EXPECT_THAT(bus.master->output(0, 0x60FF, 0).error().text(), HasSubstr("60FFh:00 is not in the outputs (RxPDO)"));
}

// Sent at k ms; SYNC0 half a cycle after; the drive's own record of its exchange is the witness.
TEST(ProcessData, OutputsTakeEffectAtTheNextSync0) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    bus.run_for(20ms);
    const Instant sent = bus.now;
    EXPECT_NEAR(static_cast<double>((bus.master->outputs_effective(0, sent) - (sent + 500us)).count()), 0, 2000);
    const Instant effective = bus.master->outputs_effective(0, sent);
    bus.cycle_once();
    EXPECT_NEAR(static_cast<double>((bus.servo(0).last_exchange - effective).count()), 0, 100);
}

// The frame answered now left a cycle ago; the inputs in it were latched at the SYNC0 before that.
TEST(ProcessData, InputsCarryTheSync0InstantTheyWereLatchedAt) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    bus.run_for(20ms);
    EXPECT_NEAR(static_cast<double>((bus.master->health(0).latched - (bus.now - 1ms - 500us)).count()), 0, 2000);
}

// A slave's quartz that is 50 ppm fast gains 50 ns a ms; the drift control must keep 092Ch under a microsecond.
TEST(Clocks, StayTogetherWithDriftingQuartzes) {
    TestBus bus{""};
    for (std::uint16_t i = 0; i < 3; ++i) {
        sim::SlaveOptions options;
        options.drift_ppm = i == 0 ? 0 : i == 1 ? 50 : -50;
        options.clock_start = Duration{1'000'000'007LL * (i + 1)};
        bus.network.add(servo_description(), std::make_unique<EchoServo>(), options);
        SlaveConfig slave;
        slave.name = std::string(1, static_cast<char>('a' + i));
        slave.device = servo_description();
        slave.position = i;
        slave.dc = true;
        bus.config.slaves.push_back(slave);
    }
    ASSERT_TRUE(bus.bring_up(30s)) << bus.why();
    bus.run_for(5s);
    EXPECT_LT(bus.master->statistics().dc_difference_ns, 1000);
    const auto spread = bus.servo(1).last_exchange - bus.servo(2).last_exchange;
    EXPECT_LT(std::abs(spread.count()), 2000) << "SYNC0 of both falls together";
}

// DC time starts as machine time. A reference 20 ppm fast gains 20 us a second; the master sees it, within its smoothing.
TEST(Clocks, DriftOfTheReferenceIsMeasured) {
    TestBus bus{""};
    sim::SlaveOptions options;
    options.drift_ppm = 20;
    bus.network.add(servo_description(), std::make_unique<EchoServo>(), options);
    SlaveConfig slave;
    slave.name = "a";
    slave.device = servo_description();
    slave.position = 0;
    slave.dc = true;
    bus.config.slaves = {slave};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    EXPECT_LT(std::abs(bus.master->statistics().dc_offset_ns), 20'000);
    bus.run_for(3s);
    EXPECT_NEAR(static_cast<double>(bus.master->statistics().dc_drift_ppb), 20'000, 200);
}

TEST(Faults, ThreeLostFramesInARowAgeTheInputsAndRaiseTheAlarm) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    bus.run_for(50ms);
    ASSERT_THAT(bus.faults(), Not(Contains(id(BusAlarm::frames_lost))));

    // Every frame of four cycles is lost, acyclic ones too: the answers of three of them are missed before frames come again.
    bus.network.lose_frames(1000);
    for (int i = 0; i < 4; ++i) bus.cycle_once();
    EXPECT_THAT(bus.faults(), Contains(id(BusAlarm::frames_lost)));
    EXPECT_GE(bus.master->statistics().frames_lost, 3u);
    EXPECT_GE(bus.master->health(0).age, 3u);
    bus.network.lose_frames(0);
    for (int i = 0; i < 3; ++i) bus.cycle_once();
    EXPECT_TRUE(bus.master->health(0).fresh) << "and fresh again";
    EXPECT_EQ(bus.master->health(0).age, 0u);
    EXPECT_THAT(bus.faults(), Not(Contains(id(BusAlarm::frames_lost))));
}

TEST(Faults, LostFramesUpToTheLimitAreOnlyCounted) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    bus.run_for(50ms);
    bus.transport.faults.drop_answers = 1;
    const auto actual_before = bus.master->health(0).age;
    bus.run_for(1ms);
    bus.run_for(1ms);
    bus.run_for(10ms);
    EXPECT_EQ(actual_before, 0u);
    EXPECT_EQ(bus.master->statistics().lost_in_a_row, 0u);
    EXPECT_EQ(bus.state(0), sim::EsmState::op);
}

TEST(Faults, ALateAnswerIsDiscardedAndCounted) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    bus.run_for(50ms);
    const auto actual = bus.master->input(0, 0x6064, 0).value();
    bus.transport.faults.delay = 3ms;
    bus.transport.faults.delay_answers = 1;
    write_signal(bus.master->outputs(), bus.master->output(0, 0x607A, 0).value(), 1000);
    bus.run_for(10ms);
    EXPECT_GE(bus.master->statistics().frames_late + bus.master->statistics().frames_lost, 1u);
    EXPECT_EQ(read_signal(bus.master->inputs(), actual), 1000);
    EXPECT_TRUE(bus.master->health(0).fresh);
}

TEST(Faults, APowerCycledSlaveReturnsToOpAndTheOtherIsNotDisturbed) {
    TestBus bus{"ss"};
    ASSERT_TRUE(bus.bring_up());
    bus.run_for(200ms);
    bus.network.set_power(1, false);
    bus.run_for(20ms);
    EXPECT_FALSE(bus.master->health(1).fresh);
    EXPECT_TRUE(bus.master->health(0).fresh) << "its sync unit is its own";
    EXPECT_THAT(bus.faults(), ElementsAre(id(BusAlarm::slave_lost))) << "as many are silent as are missing: it has a name at once";
    bus.run_for(200ms);
    EXPECT_THAT(bus.faults(), ElementsAre(id(BusAlarm::slave_lost)));

    bus.network.set_power(1, true);
    ASSERT_TRUE(bus.run_until([&] { return bus.state(1) == sim::EsmState::op; }, 5s));
    bus.run_for(300ms);
    EXPECT_TRUE(bus.master->health(1).fresh);
    EXPECT_TRUE(bus.faults().empty());
    EXPECT_EQ(bus.state(0), sim::EsmState::op);
    EXPECT_EQ(bus.servo(0).watchdogs, 0);
    EXPECT_THAT(bus.master->notes(), Contains(HasSubstr("slave 1 'b' (sv33-e) is back in OP")));
    const auto spread = bus.servo(0).last_exchange - bus.servo(1).last_exchange;
    EXPECT_LT(std::abs(spread.count()), 2000) << "SYNC0 of both falls together again";
}

TEST(Faults, ThePowerCycledReferenceClockReturnsWithoutThrowingTheOthersClocks) {
    TestBus bus{"tss"};
    ASSERT_TRUE(bus.bring_up());
    bus.run_for(200ms);
    bus.network.set_power(1, false);  // the reference, and with it the slave behind
    bus.run_for(50ms);
    bus.network.set_power(1, true);
    ASSERT_TRUE(bus.run_until([&] { return bus.state(1) == sim::EsmState::op && bus.state(2) == sim::EsmState::op; }, 10s)) << bus.why();
    bus.run_for(1s);
    EXPECT_TRUE(bus.faults().empty());
    EXPECT_LT(std::abs(bus.master->statistics().dc_offset_ns), 100'000);
    const auto spread = bus.servo(1).last_exchange - bus.servo(2).last_exchange;
    EXPECT_LT(std::abs(spread.count()), 2000);
}

// Nothing is sent for 50 ms, five watchdogs of 10 ms: the drive falls to SAFEOP with 001Bh and is taken back.
TEST(Faults, ASlaveThatFellBySmWatchdogIsAcknowledgedAndReturns) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    bus.run_for(100ms);
    bus.now += 50ms;
    bus.network.advance(bus.now);
    ASSERT_EQ(bus.state(0), sim::EsmState::safeop);
    EXPECT_EQ(bus.servo(0).watchdogs, 1);

    ASSERT_TRUE(bus.run_until([&] { return bus.state(0) == sim::EsmState::op; }, 2s));
    EXPECT_THAT(bus.master->notes(), Contains(HasSubstr("left OP")));
    EXPECT_THAT(bus.master->notes(),
                Contains(HasSubstr("AL status code 001Bh sync manager watchdog; right before, this computer sent nothing for 51 ms")));
    bus.run_for(200ms);
    EXPECT_TRUE(bus.faults().empty());
}

// The same as alarms: who stood still is named, not the slave.
TEST(Faults, ASlaveThatThisComputerStarvedIsNotBlamed) {
    TestBus bus{"ss"};
    ASSERT_TRUE(bus.bring_up());
    bus.run_for(100ms);
    bus.now += 50ms;
    bus.network.advance(bus.now);
    ASSERT_EQ(bus.state(0), sim::EsmState::safeop);
    std::vector<AlarmFact> seen;
    std::string said;
    bus.on_cycle = [&] {
        std::array<AlarmFact, 16> facts;
        const auto count = static_cast<std::ptrdiff_t>(bus.master->active_faults(facts));
        for (auto fact = facts.begin(); fact != facts.begin() + count; ++fact)
            if (fact->id != id(BusAlarm::dc_not_locked)) {  // the clocks find together again
                seen.push_back(*fact);
                said += bus.master->detail(*fact) + "\n";
            }
    };
    bus.run_for(2s);
    ASSERT_FALSE(seen.empty());
    EXPECT_THAT(seen, Contains(::testing::Field(&AlarmFact::id, id(BusAlarm::starved_slave_left_op))));
    EXPECT_THAT(seen, Not(Contains(::testing::Field(&AlarmFact::id, id(BusAlarm::slave_left_op)))));
    for (const auto& fact : seen) EXPECT_EQ(fact.id, id(BusAlarm::starved_slave_left_op)) << "one cause, one alarm: " << fact.id;
    EXPECT_EQ(seen.front().a, 51.0) << "ms";
    EXPECT_EQ(seen.back().b, 2) << "slaves";
    EXPECT_THAT(said, HasSubstr("slave 0 'a' (sv33-e), slave 1 'b' (sv33-e)"));
    EXPECT_THAT(said, HasSubstr("AL status code 001Bh sync manager watchdog"));
    EXPECT_EQ(bus.state(0), sim::EsmState::op);
}

// A thread that is woken late sends late, although its cycle was due in time: the answer that says what the slaves think of it is
// judged by a computer that already knows of its own gap.
TEST(Faults, AGapIsKnownBeforeTheAnswersBehindItAreJudged) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    bus.run_for(1s);
    const auto& link = bus.master->bus().link;
    ASSERT_EQ(recent_stall(link, bus.now), 0ms);
    bus.now += 2ms;
    bus.master->receive(bus.now);
    EXPECT_EQ(recent_stall(link, bus.now), 0ms) << "one frame is missing: nobody minds";
    bus.now += 4ms;
    bus.master->receive(bus.now);
    EXPECT_EQ(recent_stall(link, bus.now), 6ms);
    bus.master->send(bus.now);

    bus.now += 3ms;
    bus.master->receive(bus.now);
    EXPECT_EQ(recent_stall(link, bus.now), 6ms) << "the longest of those that belong together";
    bus.master->send(bus.now);
    bus.run_for(600ms);
    EXPECT_EQ(recent_stall(link, bus.now), 0ms);
}

/// Frames leave `late` behind the instant at which they were due.
struct LateTransport final : Transport {
    explicit LateTransport(Transport& under) : line(under) {}
    bool send(std::span<const std::byte> frame, Instant now) noexcept override { return line.send(frame, now + late); }
    Instant departure(Instant now) const noexcept override { return now + late; }
    std::optional<ReceivedFrame> receive(std::span<std::byte> buffer, Instant now) noexcept override { return line.receive(buffer, now); }
    MacAddress mac() const noexcept override { return line.mac(); }
    bool link_up() const noexcept override { return line.link_up(); }
    Transport& line;
    Duration late{};
};

TEST(Faults, AGapThatBeganBehindTheWakeUpCountsAsWell) {
    TestBus bus{"s"};
    LateTransport late{bus.transport};
    bus.master = std::make_unique<Master>(late, bus.config);
    ASSERT_TRUE(bus.bring_up());
    bus.run_for(1s);
    const auto& link = bus.master->bus().link;
    ASSERT_EQ(recent_stall(link, bus.now), 0ms);
    bus.now += 1ms;
    bus.master->receive(bus.now);
    late.late = 7ms;  // the thread stands between receive and send
    bus.master->send(bus.now);
    EXPECT_EQ(recent_stall(link, bus.now), 8ms);
}

TEST(Sdo, InOpIsAQueuedRequestThatProcessDataDoesNotNotice) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    const std::array<std::byte, 4> value{std::byte{0x39}, std::byte{0x30}, std::byte{0}, std::byte{0}};
    const auto write = bus.master->download(0, 0x6085, 0, value);
    const auto read = bus.master->upload(0, 0x2000, 1);  // 300 bytes through 128-byte mailboxes: segments
    std::optional<Result<SdoResult>> written, text;
    for (int i = 0; i < 200 && (!written || !text); ++i) {
        bus.cycle_once();
        ASSERT_TRUE(bus.master->health(0).fresh);
        if (!written) written = bus.master->poll(write);
        if (!text) text = bus.master->poll(read);
    }
    ASSERT_TRUE(written && written->ok());
    EXPECT_EQ(bus.network.slave(0).dictionary().value(0x6085, 0), 12345);
    ASSERT_TRUE(text && text->ok()) << text->error().text();
    EXPECT_EQ((*text)->data, std::vector<std::byte>(300, std::byte{'x'}));
    EXPECT_FALSE(bus.master->poll(read)->ok()) << "a result is given once";
}

TEST(Sdo, AbortsComeBackWithText) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    const auto ticket = bus.master->upload(0, 0x5555, 0);
    std::optional<Result<SdoResult>> result;
    bus.run_until([&] { return (result = bus.master->poll(ticket)).has_value(); }, 1s);
    ASSERT_TRUE(result);
    ASSERT_FALSE(result->ok());
    EXPECT_THAT(result->error().text(), HasSubstr("slave 0 'a' (sv33-e): reading 5555h:00 was refused: abort 06020000h"));
}

TEST(Sdo, AStuckMailboxTimesOutAndTheNextRequestWorksAgain) {
    TestBus bus{"s"};
    ASSERT_TRUE(bus.bring_up());
    bus.network.slave(0).stick_mailbox(true);
    auto ticket = bus.master->upload(0, 0x6041, 0);
    std::optional<Result<SdoResult>> result;
    ASSERT_TRUE(bus.run_until([&] { return (result = bus.master->poll(ticket)).has_value(); }, 5s));
    EXPECT_EQ(result->error().code, "sdo.timeout");

    bus.network.slave(0).stick_mailbox(false);
    bus.run_for(100ms);
    ticket = bus.master->upload(0, 0x6085, 0);
    ASSERT_TRUE(bus.run_until([&] { return (result = bus.master->poll(ticket)).has_value(); }, 5s));
    ASSERT_TRUE(result->ok()) << result->error().text();
}

TEST(Sdo, LostFramesAtAnyMomentOfTheConversationAreRepaired) {
    for (int at = 0; at < 12; ++at) {
        TestBus bus{"s"};
        ASSERT_TRUE(bus.bring_up());
        const auto ticket = bus.master->upload(0, 0x2000, 1);
        bus.run_for(at * 1ms);
        bus.transport.faults.drop_answers = 2;
        std::optional<Result<SdoResult>> result;
        bus.run_until([&] { return (result = bus.master->poll(ticket)).has_value(); }, 5s);
        ASSERT_TRUE(result);
        ASSERT_TRUE(result->ok()) << at << ": " << result->error().text();
        EXPECT_EQ((*result)->data.size(), 300u);
    }
}

TEST(Sdo, BeforePreopIsRefusedAtOnce) {
    TestBus bus{"s"};
    bus.start();
    const auto result = bus.master->poll(bus.master->upload(0, 0x6041, 0));
    ASSERT_TRUE(result);
    EXPECT_EQ(result->error().code, "sdo.not_ready");
}

}  // namespace
}  // namespace taktwerk::ecat::test
