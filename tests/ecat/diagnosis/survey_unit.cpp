// What a survey reads from simulated slaves, and that it leaves the bus as it was.

#include "ecat/diagnosis/survey.hpp"

#include <gmock/gmock.h>

#include "ecat/bringup/scan.hpp"
#include "ecat/diagnosis/clock_report.hpp"
#include "ecat/diagnosis/port_errors.hpp"
#include "tests/ecat/diagnosis/probed_bus.hpp"
#include "tests/ecat/hot_connect_bus.hpp"

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;
using test::ProbedBus;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST(Survey, ReadsIdentityStateAndPortsOfEverySlave) {
    ProbedBus bus{"sts"};

    const Survey found = bus.look();

    ASSERT_THAT(found.slaves, SizeIs(3));
    const auto& servo = found.slaves[0];
    EXPECT_FALSE(servo.found.error) << servo.found.error->text();
    EXPECT_EQ(servo.found.identity.vendor, 0x7FBu);  // SV33-E manual
    EXPECT_EQ(servo.found.identity.product, 0x000C0108u);
    EXPECT_EQ(servo.found.station, station_at(0));
    EXPECT_EQ(servo.state, AlState::init);
    EXPECT_TRUE(servo.dc());
    EXPECT_TRUE(servo.has_mailbox());
    EXPECT_TRUE(servo.ports[0].open);
    EXPECT_TRUE(servo.ports[1].open);
    EXPECT_FALSE(servo.ports[2].open);
    EXPECT_FALSE(found.slaves[1].has_mailbox());
    EXPECT_FALSE(found.slaves[2].ports[1].open) << "the last of the line";
    ASSERT_TRUE(found.topology);
    EXPECT_EQ(found.topology->slaves[2].parent, 1u);
    EXPECT_THAT(found.remarks, IsEmpty());
}

// A master with a source address of its own, as every sound one has: its frames are whole, and they are nobody's answer.
TEST(Listening, HearsASoundFrameOfAnotherMaster) {
    ProbedBus bus{"t"};
    std::uint64_t rounds = 0;
    bool sends = false;
    BusProbe listening{bus.transport, {}, [&](Duration period) {
                           bus.now += period;
                           if (sends && ++rounds % 20 == 0) {
                               std::array<std::byte, min_frame_size> buffer{};
                               FrameBuilder builder{buffer, MacAddress{0x02, 0x11, 0x22, 0x33, 0x44, 0x55}};
                               (void)builder.add(Command::BRD, 1, Address::physical(0, reg::al_status), 2);
                               (void)builder.finish();
                               bus.transport.inject(buffer, bus.now);
                           }
                           return std::optional{bus.now};
                       }};
    EXPECT_EQ(listening.listen(25ms).value(), 0u) << "nobody sends";
    sends = true;
    EXPECT_EQ(listening.listen(25ms).value(), 25u) << "one each millisecond";
}

// SOEM hands the EEPROM to the slave's processor on the way to PREOP (0500h = 1) and leaves it there.
TEST(Survey, AnEepromThatItsProcessorHoldsIsNoDefect) {
    ProbedBus bus{"s"};
    ASSERT_TRUE(bus.bring_up()) << bus.why();  // in OP: the survey takes nothing away from anybody
    std::array<std::byte, min_frame_size> buffer{};
    FrameBuilder builder{buffer, MacAddress{0x02, 0x11, 0x22, 0x33, 0x44, 0x55}};
    store_le(builder.add(Command::APWR, 1, Address::position(0, reg::eeprom_configuration), 1), 0, std::uint8_t{1});
    (void)builder.finish();
    (void)bus.network.process(buffer, bus.now);

    const Survey found = bus.look();
    ASSERT_EQ(found.slaves.size(), 1u);
    ASSERT_TRUE(found.slaves[0].found.error) << "nobody can read it while it is held";
    const auto said = found.slaves[0].found.error->text();
    EXPECT_THAT(said, ::testing::HasSubstr("its EEPROM is in the hands of its own processor (0500h = 01h, 0501h = 00h)"));
    EXPECT_THAT(said, ::testing::Not(::testing::HasSubstr("defective")));
    EXPECT_THAT(said, ::testing::Not(::testing::HasSubstr("reports an error")));
}

TEST(Survey, EightSlavesTakeLessThanASecondOfMachineTime) {
    ProbedBus bus{"ssssssss"};
    const Survey found = bus.look();
    EXPECT_THAT(found.slaves, SizeIs(8));
    EXPECT_LT(bus.now - Instant{}, 1s);
}

TEST(Survey, ABusInOpGoesOnUndisturbed) {
    // The survey's datagrams travel with the process data of a running cycle.
    ProbedBus bus{"st"};
    auto running = bus.probe(bus.config);
    const auto up = running.bring_up();
    ASSERT_TRUE(up) << up.error().text();
    const int exchanges = bus.servo(0).exchanges;
    const Instant before = bus.now;

    const auto found = running.run(survey(running.port()));

    ASSERT_TRUE(found) << found.error().text();
    EXPECT_EQ(found->highest_state, AlState::op);
    EXPECT_FALSE(found->slaves[0].found.error);
    EXPECT_EQ(bus.state(0), sim::EsmState::op);
    EXPECT_EQ(bus.state(1), sim::EsmState::op);
    EXPECT_GE(bus.servo(0).exchanges - exchanges, (bus.now - before) / 1ms - 1) << "one exchange a cycle, as before";
    EXPECT_EQ(running.master().statistics().working_counter_errors, 0u);
}

TEST(Survey, WithoutSlavesOrCableItSaysSo) {
    ProbedBus bus{"s"};
    bus.network.set_cable(0, false);
    auto looking = bus.probe();
    const auto silent = looking.run(survey(looking.port()));
    ASSERT_FALSE(silent);
    EXPECT_EQ(silent.error().code, "bus.no_frame");
}

TEST(Survey, AnAddressOfAnotherMasterIsKeptWhileSlavesAreOperating) {
    ProbedBus bus{"t"};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    auto other = bus.probe();
    const auto moved = other.run([](DatagramPort& port) -> Script<Result<void>> {
        co_await port.apwr(0, reg::station_address, std::uint16_t{0x2222});
        co_return Result<void>{};
    }(other.port()));
    ASSERT_TRUE(moved);

    const Survey found = bus.look();

    ASSERT_THAT(found.slaves, SizeIs(1));
    ASSERT_TRUE(found.slaves[0].found.error);
    EXPECT_EQ(found.slaves[0].found.error->code, "bus.foreign_address");
    EXPECT_EQ(found.slaves[0].found.station, 0x2222);
}

TEST(CompareWith, NamesWhoIsMissingAndWhoIsAnother) {
    ProbedBus bus{"st"};
    Survey found = bus.look();
    BusConfig wanted = bus.config;
    wanted.slaves[1].device = test::servo_description();  // but a terminal is there
    SlaveConfig third = wanted.slaves[0];
    third.name = "c";
    third.position = 2;
    wanted.slaves.push_back(third);

    compare_with(wanted, found);

    EXPECT_EQ(found.slaves[0].name, "a");
    EXPECT_FALSE(found.slaves[0].mismatch);
    ASSERT_TRUE(found.slaves[1].mismatch);
    EXPECT_THAT(found.slaves[1].mismatch->text(), HasSubstr("000007FBh"));
    EXPECT_THAT(found.slaves[1].mismatch->text(), HasSubstr("00000ABCh"));
    ASSERT_THAT(found.remarks, SizeIs(1));
    EXPECT_EQ(found.remarks[0].code, "bus.missing_slave");
    EXPECT_THAT(found.remarks[0].text(), HasSubstr("position 2"));
}

/// Residents 'a' (servo) and 'b' (terminal); group "tool" of terminal 'd', known by its alias, and servo 'e' behind it.
BusConfig with_a_tool() {
    ProbedBus residents{"st"};
    BusConfig config = residents.config;
    config.slaves.push_back(test::HotConnectBus::slave("d", test::terminal_description(), "tool"));
    config.slaves.back().alias = test::tool_alias;
    config.slaves.push_back(test::HotConnectBus::slave("e", test::servo_description(), "tool"));
    return config;
}

std::vector<std::string> names(const Survey& found) {
    std::vector<std::string> all;
    for (const auto& slave : found.slaves) all.push_back(slave.name);
    return all;
}

TEST(CompareWith, AGroupThatIsNotPluggedInIsNobodyMissing) {
    ProbedBus bus{"st"};
    Survey found = bus.look();
    compare_with(with_a_tool(), found);
    EXPECT_THAT(found.remarks, IsEmpty());
    EXPECT_THAT(found.absent_groups, ElementsAre("tool"));
    EXPECT_THAT(names(found), ElementsAre("a", "b"));
}

// Plugged in between the residents: positions in the configuration do not count it.
TEST(CompareWith, AGroupIsNamedWhereverItIsPluggedIn) {
    ProbedBus bus{"stst"};
    Survey found = bus.look();
    found.slaves[1].found.alias = test::tool_alias;
    compare_with(with_a_tool(), found);
    EXPECT_THAT(found.remarks, IsEmpty());
    EXPECT_THAT(found.absent_groups, IsEmpty());
    EXPECT_THAT(names(found), ElementsAre("a", "d", "e", "b"));
    for (const auto& slave : found.slaves) EXPECT_FALSE(slave.mismatch) << slave.name;
}

TEST(CompareWith, AGroupThatIsNotWholeSaysBehindWhomItEnds) {
    ProbedBus bus{"stt"};
    Survey found = bus.look();
    found.slaves[2].found.alias = test::tool_alias;
    compare_with(with_a_tool(), found);
    ASSERT_THAT(found.remarks, SizeIs(1));
    EXPECT_EQ(found.remarks[0].code, "bus.hot_connect");
    EXPECT_THAT(found.remarks[0].text(), testing::AllOf(HasSubstr("'e'"), HasSubstr("1 of the 2"), HasSubstr("behind 'd' stands nobody")));
    EXPECT_THAT(names(found), ElementsAre("a", "b", "d"));
}

TEST(CompareWith, TwoHeadsOfOneGroupAreTold) {
    ProbedBus bus{"sttsts"};
    Survey found = bus.look();
    found.slaves[2].found.alias = found.slaves[4].found.alias = test::tool_alias;
    compare_with(with_a_tool(), found);
    ASSERT_THAT(found.remarks, SizeIs(1));
    EXPECT_THAT(found.remarks[0].text(), testing::AllOf(HasSubstr("'d'"), HasSubstr("positions 2 and 4")));
}

TEST(PortFindings, NameTheCableBetweenTwoSlaves) {
    // 12 RX errors and 3 lost links at port 1 of slave 2; behind it hangs slave 3. Forwarded errors alone come from before.
    ProbedBus bus{"tttt"};
    Survey found = bus.look();
    EXPECT_THAT(port_findings(found), IsEmpty());
    found.slaves[2].name = "y";
    found.slaves[2].ports[1].counters = {.invalid_frames = 0, .rx_errors = 12, .forwarded_errors = 0, .lost_links = 3};
    found.slaves[3].ports[0].counters = {.invalid_frames = 4, .rx_errors = 0, .forwarded_errors = 4, .lost_links = 0};

    const auto findings = port_findings(found);

    ASSERT_THAT(findings, SizeIs(2));
    EXPECT_EQ(findings[0].position, 2u);
    EXPECT_EQ(findings[0].text,
              "port 1 of slave 2 'y': 3 lost links, 12 RX errors: the cable between slave 2 'y' and slave 3, or its plugs");
    EXPECT_THAT(findings[1].text, HasSubstr("from further up the cable"));
}

TEST(PortFindings, CountersAreReadAndCleared) {
    // The outputs stay away for longer than the SM watchdog of 10 ms: each slave counts it.
    ProbedBus bus{"tt"};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    bus.now += 100ms;
    Survey found = bus.look();
    ASSERT_EQ(found.slaves[0].sm_watchdogs, 1);

    auto probing = bus.probe();
    ASSERT_TRUE(probing.run(clear_counters(probing.port(), 2)));
    ASSERT_TRUE(probing.run(refresh_counters(probing.port(), found)));

    EXPECT_EQ(found.slaves[0].sm_watchdogs, 0);
    EXPECT_EQ(found.slaves[1].sm_watchdogs, 0);
    EXPECT_THAT(port_findings(found), IsEmpty());
}

TEST(ClockReport, ShowsTheReferenceAndSync0InOp) {
    ProbedBus bus{"sts"};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    const Survey found = bus.look();
    auto probing = bus.probe();

    const auto clocks = probing.run(read_clocks(probing.port(), found));

    ASSERT_TRUE(clocks);
    ASSERT_THAT(*clocks, SizeIs(2)) << "the terminal has no clock";
    EXPECT_TRUE((*clocks)[0].reference);
    EXPECT_EQ((*clocks)[0].delay, 0u);
    EXPECT_FALSE((*clocks)[1].reference);
    EXPECT_GT((*clocks)[1].delay, 0u);
    EXPECT_TRUE((*clocks)[1].sync0);
    EXPECT_EQ((*clocks)[1].sync0_cycle, 1ms);
    EXPECT_THAT(clock_findings(found, *clocks, 3us), IsEmpty());
}

TEST(ClockReport, ClocksThatNobodySetUpAreCalledFree) {
    ProbedBus bus{"s"};
    const Survey found = bus.look();
    auto probing = bus.probe();
    const auto clocks = probing.run(read_clocks(probing.port(), found));
    ASSERT_TRUE(clocks);
    EXPECT_THAT(clock_findings(found, *clocks, 3us), ElementsAre(HasSubstr("run free")));
}

}  // namespace
}  // namespace taktwerk::ecat
