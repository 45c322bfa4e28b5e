// Health is never assumed: each way in which a bus in OP can be unwell, what is said about it, and how it comes back.
// docs/faults.md is the table; the campaign in tests/runtime/campaign crosses these with every phase.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "ecat/alarms.hpp"
#include "ecat/bringup/bus.hpp"
#include "ecat/wire/sii.hpp"
#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A controller that is not ours: its datagrams reach the slaves, and its frames are heard by our port.
void second_master_writes(TestBus& bus, Address address, std::uint16_t value) {
    std::array<std::byte, min_frame_size> buffer{};
    FrameBuilder builder{buffer, MacAddress{0x00, 0x11, 0x22, 0x33, 0x44, 0x55}};
    store_le(builder.add(Command::APWR, 0x40, address, 2), 0, value);
    (void)builder.finish();
    (void)bus.network.process(buffer, bus.now);
    bus.transport.inject(buffer, bus.now);
}

struct Health : ::testing::Test {
    std::optional<TestBus> bus;
    void start(const char* devices, std::size_t tolerated_from = 99) {
        bus.emplace(devices);
        for (std::size_t i = tolerated_from; i < bus->config.slaves.size(); ++i) bus->config.slaves[i].on_loss = LossPolicy::stop_own_axes;
        ASSERT_TRUE(bus->bring_up()) << bus->why();
        bus->run_for(200ms);
        ASSERT_THAT(faults(), IsEmpty());
    }
    std::vector<AlarmFact> facts() { return bus->facts(); }
    std::vector<AlarmId> faults() { return bus->faults(); }
    bool said_within(AlarmId id, Duration limit) {
        return bus->run_until(
            [&] {
                const auto now = faults();
                return std::find(now.begin(), now.end(), id) != now.end();
            },
            limit);
    }
    /// As it stands in the slave, whatever the master believes.
    std::uint16_t station_address(std::size_t slave) { return bus->network.slave(slave).controller().station_address(); }
    bool well() {
        for (std::size_t i = 0; i < bus->config.slaves.size(); ++i)
            if (bus->state(i) != sim::EsmState::op || !bus->master->health(i).fresh) return false;
        return faults().empty();
    }
    void expect_recovery(Duration limit = 5s) {
        EXPECT_TRUE(bus->run_until([&] { return well(); }, limit)) << bus->why() << " " << ::testing::PrintToString(faults());
        bus->run_for(500ms);
        EXPECT_TRUE(well()) << ::testing::PrintToString(faults());
    }
    std::uint64_t acyclic_frames(Duration length) {
        const auto sent = bus->master->statistics().frames_sent;
        bus->run_for(length);
        return bus->master->statistics().frames_sent - sent - static_cast<std::uint64_t>(length / bus->config.cycle);
    }
};

// --- slaves that are gone -----------------------------------------------------------------------------------------------------

TEST_F(Health, ACableThatBreaksIsOneAlarmThatNamesItsEnds) {
    start("ststttst");
    bus->network.set_cable(3, false);
    bus->run_for(10ms);
    ASSERT_THAT(faults(), ElementsAre(id(BusAlarm::cable_broken)));
    const auto broken = facts().front();
    EXPECT_EQ(broken.index, 3);
    EXPECT_EQ(broken.a, 5) << "the slave behind the break and four more";
    EXPECT_EQ(bus->master->detail(broken), "between slave 2 'c' (sv33-e) port 1 and slave 3 'd' (dio8)");
    EXPECT_TRUE(bus->master->health(2).fresh) << "who stands before the break exchanges on";
    bus->run_for(300ms);
    EXPECT_THAT(bus->master->notes(),
                ::testing::AllOf(Contains(HasSubstr("slave 3 'd' (dio8) does not answer")), Not(Contains(HasSubstr("check its power")))))
        << "of those behind it: the alarm says where to look";

    bus->network.set_cable(3, true);
    bus->run_until([&] { return !facts().empty() && facts().front().b < 5; }, 5s);
    ASSERT_THAT(faults(), ElementsAre(id(BusAlarm::cable_broken))) << "until the last is back it is still this one";
    EXPECT_EQ(facts().front().a, 5) << "as many as it took along";
    expect_recovery();
    EXPECT_EQ(bus->master->detail(broken), "between slave 2 'c' (sv33-e) port 1 and slave 3 'd' (dio8); all slaves are back in OP")
        << "what waits for its acknowledgement";
    EXPECT_EQ(bus->servo(0).watchdogs, 0) << "the others were not disturbed";
}

TEST_F(Health, ABreakNearerToTheMasterTakesTheEarlierOneIn) {
    start("ttttt");
    bus->network.set_cable(4, false);
    bus->run_for(100ms);
    EXPECT_THAT(faults(), ElementsAre(id(BusAlarm::slave_lost)));
    bus->network.set_cable(2, false);
    bus->run_for(100ms);
    ASSERT_THAT(faults(), ElementsAre(id(BusAlarm::cable_broken)));
    EXPECT_EQ(facts().front().index, 2);
    EXPECT_EQ(facts().front().a, 3);
    bus->network.set_cable(2, true);
    bus->run_for(2s);
    EXPECT_THAT(faults(), ElementsAre(id(BusAlarm::slave_lost))) << "the second cable is still out";
    bus->network.set_cable(4, true);
    expect_recovery();
}

// 0 - port 3: 1 - 2, port 1: 3 - 4. With the first branch out, the auto-increment address of slave 1 reaches slave 3.
TEST_F(Health, InATreeNobodyIsTakenForAnotherWhoseBranchIsOut) {
    bus.emplace("t");
    auto& root = bus->network.slave(0);
    const auto hang = [&](sim::SimSlave& parent, unsigned port) -> sim::SimSlave& {
        return bus->network.add_behind(parent, port, terminal_description(), std::make_unique<InvertingTerminal>());
    };
    auto& b = hang(root, 3);
    (void)hang(b, 1);
    auto& d = hang(root, 1);
    (void)hang(d, 1);
    for (std::uint16_t position = 1; position < 5; ++position) {
        auto slave = bus->config.slaves[0];
        slave.name = std::string(1, static_cast<char>('a' + position));
        slave.position = position;
        bus->config.slaves.push_back(slave);
    }
    ASSERT_TRUE(bus->bring_up()) << bus->why();
    bus->run_for(100ms);

    bus->network.set_cable(b, false);
    bus->run_for(200ms);
    ASSERT_THAT(faults(), ElementsAre(id(BusAlarm::cable_broken)));
    EXPECT_EQ(bus->master->detail(facts().front()), "between slave 0 'a' (dio8) port 3 and slave 1 'b' (dio8)");
    bus->network.set_power(d, false);  // both of its branch lose their addresses
    bus->run_for(200ms);
    EXPECT_THAT(faults(), ElementsAre(id(BusAlarm::cable_broken), id(BusAlarm::cable_broken)));
    bus->network.set_power(d, true);
    EXPECT_TRUE(bus->run_until([&] { return faults().size() == 1 && d.state() == sim::EsmState::op; }, 5s));
    EXPECT_TRUE(bus->master->health(3).fresh);
    EXPECT_FALSE(bus->master->health(1).fresh);
    const auto notes_before = bus->master->notes().size();
    bus->network.set_cable(b, true);
    expect_recovery();
    // Who has been plugged in is on the cable, also before the slaves are counted again.
    EXPECT_GT(bus->master->notes().size(), notes_before);
    for (const auto& note : bus->master->notes()) EXPECT_EQ(note.find("is not on the cable"), std::string::npos) << note;
}

TEST_F(Health, WhereTheConfigurationSaysSoOnlyItsOwnAxesAreConcerned) {
    start("stst", 2);
    bus->network.set_cable(2, false);
    bus->run_for(10ms);
    EXPECT_THAT(faults(), ElementsAre(id(BusAlarm::branch_dropped_out)));
    bus->network.set_cable(2, true);
    expect_recovery();
    bus->network.set_power(3, false);
    bus->run_for(10ms);
    EXPECT_THAT(faults(), ElementsAre(id(BusAlarm::slave_dropped_out)));
    EXPECT_EQ(find_alarm(bus_alarms, id(BusAlarm::branch_dropped_out))->reaction, Reaction::warn);
    EXPECT_EQ(find_alarm(bus_alarms, id(BusAlarm::slave_dropped_out))->reaction, Reaction::warn);
}

TEST_F(Health, ABranchWithOneSlaveThatIsNeededStopsTheMachine) {
    start("sttt", 2);
    bus->network.set_cable(1, false);
    bus->run_for(10ms);
    EXPECT_THAT(faults(), ElementsAre(id(BusAlarm::cable_broken)));
}

TEST_F(Health, ASlavePowerCycledTwiceInTheMiddleOfItsReturnComesBack) {
    for (const Duration pause : {5ms, 30ms, 60ms, 120ms, 250ms}) {
        start("tst");
        bus->network.set_power(1, false);
        bus->run_for(50ms);
        bus->network.set_power(1, true);
        bus->run_for(pause);
        bus->network.set_power(1, false);
        bus->run_for(20ms);
        bus->network.set_power(1, true);
        expect_recovery(10s);
    }
}

TEST_F(Health, AnotherDeviceInItsPlaceIsNeverTakenForTheSlave) {
    start("st");
    // The terminal's place is taken by a servo: same position, other identity.
    bus->network.set_power(1, false);
    bus->run_for(100ms);
    bus->network.slave(1).controller().eeprom().image()[std::size_t{2} * sii_word::product] = std::byte{0x77};
    bus->network.set_power(1, true);
    bus->run_for(3s);
    EXPECT_THAT(faults(), Contains(id(BusAlarm::other_device)));
    EXPECT_THAT(bus->master->notes(), Contains(HasSubstr("expected vendor 00000ABCh product 00000808h")));
    EXPECT_EQ(bus->state(1), sim::EsmState::init) << "not configured, also not at the second attempt";
    EXPECT_EQ(bus->state(0), sim::EsmState::op);
}

TEST_F(Health, AnAbsentSlaveCostsLittleTraffic) {
    start("sttt");
    bus->network.set_power(1, false);
    bus->run_for(1s);
    // Three slaves asked every 100 ms for their AL status, one census in two seconds: under 60 frames a second.
    EXPECT_LT(acyclic_frames(10s), 600u);
}

TEST_F(Health, ASlaveThatRefusesToReturnIsTriedEverMoreSeldomAndSaidSo) {
    start("ts");
    bus->network.slave(1).refuse_state(sim::EsmState::safeop, 0x001D);
    bus->network.set_power(1, false);
    bus->run_for(50ms);
    bus->network.set_power(1, true);
    bus->run_for(6s);
    EXPECT_THAT(faults(), ElementsAre(id(BusAlarm::slave_does_not_return), id(BusAlarm::slave_left_op)))
        << "it answers: no cable, no supply";
    for (const auto& fact : facts())
        if (fact.id == id(BusAlarm::slave_does_not_return)) {
            EXPECT_THAT(bus->master->detail(fact), HasSubstr("refused SAFEOP: 001Dh"));
        }
    bus->run_for(20s);
    // Then every 8 s; a return takes some 300 register accesses, each in a frame of its own at worst.
    EXPECT_LT(acyclic_frames(8s), 1200u);
    EXPECT_EQ(bus->state(0), sim::EsmState::op);

    bus->network.slave(1).refuse_state(sim::EsmState::safeop, 0);
    expect_recovery(10s);
}

// A power cycle in the middle takes those behind it along: whatever of it the watch sees first, the first slave is named, and only it.
TEST_F(Health, APowerCycleInTheMiddleIsOneAlarmThatNamesTheFirst) {
    for (const std::uint16_t limit : {std::uint16_t{3}, std::uint16_t{300}})
        for (int phase = 0; phase < 100; phase += 7) {
            bus.emplace("ssst");
            bus->config.lost_frames_limit = limit;
            bus->config.acyclic_per_cycle = 1;  // the watch hears of one slave a cycle, as on a busy bus
            if (limit > 3)
                for (auto& slave : bus->config.slaves) slave.sm_watchdog = 500ms;
            ASSERT_TRUE(bus->bring_up()) << bus->why();
            bus->run_for(200ms + phase * 1ms);
            ASSERT_THAT(faults(), IsEmpty());
            std::vector<AlarmFact> said;
            bus->on_cycle = [&] {
                for (const auto& fact : facts()) {
                    const auto same = [&](const AlarmFact& f) { return f.id == fact.id && f.index == fact.index; };
                    if (fact.id != id(BusAlarm::dc_not_locked) && std::none_of(said.begin(), said.end(), same)) said.push_back(fact);
                }
            };
            bus->network.set_power(1, false);
            bus->run_for(500ms);
            bus->network.set_power(1, true);
            expect_recovery(10s);
            std::erase_if(said, [](const AlarmFact& f) { return f.id == id(BusAlarm::slaves_missing); });
            ASSERT_EQ(said.size(), 1u) << "limit " << limit << ", phase " << phase << ": " << said[0].id << " " << said[0].index;
            EXPECT_EQ(said[0].id, id(BusAlarm::cable_broken));
            EXPECT_EQ(said[0].index, 1);
        }
}

// --- slaves that are there, but not well ------------------------------------------------------------------------------------------

// reference/ethercat-masters.md F1: LRW does not need station addresses, so its working counter stays right.
TEST_F(Health, ALostStationAddressIsNoticedAlthoughProcessDataRunsOnAndIsGivenBack) {
    start("sts");
    second_master_writes(*bus, Address::position(1, reg::station_address), 0);
    second_master_writes(*bus, Address::position(2, reg::station_address), 0);
    bus->run_for(150ms);
    EXPECT_THAT(faults(), Contains(id(BusAlarm::station_address_lost)));
    EXPECT_TRUE(bus->master->health(1).fresh);
    expect_recovery();
    EXPECT_EQ(bus->servo(2).watchdogs, 0);
}

TEST_F(Health, TheReferenceClockWithoutItsAddressDoesNotFoolTheMaster) {
    start("ss");
    second_master_writes(*bus, Address::position(0, reg::station_address), 0);
    ASSERT_EQ(station_address(0), 0);
    EXPECT_TRUE(said_within(id(BusAlarm::station_address_lost), 150ms));
    expect_recovery();
    EXPECT_EQ(station_address(0), 0x1001);
    EXPECT_LT(std::abs(bus->master->statistics().dc_offset_ns), 100'000);
    const auto spread = bus->servo(0).last_exchange - bus->servo(1).last_exchange;
    EXPECT_LT(std::abs(spread.count()), 2000);
}

TEST_F(Health, SlavesThatSwappedAddressesAreSetRight) {
    start("ttt");
    second_master_writes(*bus, Address::position(1, reg::station_address), 0x1003);
    second_master_writes(*bus, Address::position(2, reg::station_address), 0);
    ASSERT_EQ(station_address(1), 0x1003);
    ASSERT_EQ(station_address(2), 0);
    EXPECT_TRUE(said_within(id(BusAlarm::station_address_lost), 300ms));
    expect_recovery();
    EXPECT_EQ(station_address(1), 0x1002);
    EXPECT_EQ(station_address(2), 0x1003);
}

TEST_F(Health, TwoSlavesWithOneAddressAreSetRight) {
    start("ttt");
    second_master_writes(*bus, Address::position(1, reg::station_address), 0x1003);
    ASSERT_EQ(station_address(1), 0x1003);
    EXPECT_TRUE(said_within(id(BusAlarm::station_address_lost), 300ms));
    expect_recovery();
    EXPECT_EQ(station_address(1), 0x1002);
    EXPECT_EQ(station_address(2), 0x1003);
}

TEST_F(Health, AStateChangedBehindOurBackIsTakenBack) {
    for (const std::uint16_t state : {std::uint16_t{1}, std::uint16_t{2}, std::uint16_t{4}}) {
        start("tst");
        second_master_writes(*bus, Address::position(1, reg::al_control), state);
        ASSERT_TRUE(said_within(id(BusAlarm::foreign_command), 50ms)) << state;
        EXPECT_THAT(bus->master->detail(facts().back()), HasSubstr("of whom frames were heard: its network address is 02:11:22:33:44:55"));
        expect_recovery();
        EXPECT_EQ(bus->state(0), sim::EsmState::op);
    }
}

// One frame of a tool that wants all slaves in PREOP. He is named at once and first; no slave is accused, and nothing is said of each.
TEST_F(Health, ACommandToAllSlavesIsOneAlarmAndNamesTheOtherMaster) {
    start("tsss");
    std::vector<AlarmId> said;
    bus->on_cycle = [&] {
        for (const auto id : faults())
            if (std::find(said.begin(), said.end(), id) == said.end()) said.push_back(id);
    };
    std::array<std::byte, min_frame_size> buffer{};
    FrameBuilder builder{buffer, MacAddress{0x00, 0x11, 0x22, 0x33, 0x44, 0x55}};
    store_le(builder.add(Command::BWR, 0x40, Address::physical(0, reg::al_control), 2), 0, std::uint16_t{2});
    (void)builder.finish();
    (void)bus->network.process(buffer, bus->now);
    bus->transport.inject(buffer, bus->now);
    bus->run_for(8ms);
    EXPECT_THAT(said, ElementsAre(id(BusAlarm::foreign_command))) << "within some cycles";
    EXPECT_EQ(facts()[0].a, 4);
    EXPECT_THAT(bus->master->detail(facts()[0]), HasSubstr("its network address is 02:11:22:33:44:55"));
    bus->run_for(30ms);
    EXPECT_THAT(bus->master->notes(), Contains(HasSubstr("without an error of its own: somebody else sent it there")));
    expect_recovery();
    std::erase(said, id(BusAlarm::dc_not_locked));  // the clocks find together again
    EXPECT_THAT(said, ElementsAre(id(BusAlarm::foreign_command)));
}

// A cable that is pulled for so long that all watchdogs trip: who falls by it says nothing new.
TEST_F(Health, WhatFallsWhileNoFrameComesBackIsPartOfTheSameAlarm) {
    for (const bool link : {true, false}) {
        start("tsss");
        std::vector<AlarmId> said;
        bus->on_cycle = [&] {
            for (const auto id : faults())
                if (std::find(said.begin(), said.end(), id) == said.end()) said.push_back(id);
        };
        bus->transport.faults.link_down = !link;
        if (link) bus->transport.faults.drop_requests = 500;
        bus->run_for(link ? 400ms : 300ms);
        bus->transport.faults = {};
        ASSERT_NE(bus->state(1), sim::EsmState::op);
        bus->run_for(10ms);
        const auto now = facts();
        ASSERT_FALSE(now.empty());
        EXPECT_EQ(now[0].b, 4) << "fell by it";
        EXPECT_THAT(bus->master->detail(now[0]), "4 slaves fell by it");
        expect_recovery();
        EXPECT_THAT(bus->master->detail(now[0]), "4 slaves fell by it; all slaves are back in OP");
        std::erase(said, id(BusAlarm::dc_not_locked));
        EXPECT_THAT(said, ElementsAre(link ? id(BusAlarm::frames_lost) : id(BusAlarm::link_down)));
    }
}

// Too short for the master to miss it, long enough to lose everything: it was its power, and nobody knows it as "unknown".
TEST_F(Health, AShortPowerCutIsALostSlave) {
    start("ts");
    std::string said;
    std::vector<AlarmId> ids;
    bus->on_cycle = [&] {
        for (const auto& fact : facts()) {
            ids.push_back(fact.id);
            said += bus->master->detail(fact) + "\n";
        }
    };
    bus->network.set_power(1, false);
    bus->run_for(1ms);
    bus->network.set_power(1, true);
    expect_recovery();
    EXPECT_THAT(ids, Contains(id(BusAlarm::slave_lost)));
    EXPECT_THAT(ids, Not(Contains(id(BusAlarm::foreign_command))));
    EXPECT_THAT(said, Not(HasSubstr("unknown")));
}

TEST_F(Health, SettingsChangedBehindOurBackAreWrittenAgain) {
    start("tst");
    second_master_writes(*bus, Address::position(0, reg::fmmu_at(0) + 4), 0);  // the FMMU of the outputs maps nothing
    std::vector<AlarmId> said;
    std::string reason;
    bus->on_cycle = [&] {
        for (const auto& fact : facts()) {
            if (std::find(said.begin(), said.end(), fact.id) == said.end()) said.push_back(fact.id);
            reason = bus->master->detail(fact);
        }
    };
    EXPECT_TRUE(said_within(id(BusAlarm::working_counter_wrong), 50ms));
    expect_recovery();
    EXPECT_THAT(said, ElementsAre(id(BusAlarm::working_counter_wrong))) << "that it is set up again is no trouble of its own";
    EXPECT_THAT(reason, HasSubstr("FMMU0 is not as it was written"));
}

TEST_F(Health, AnotherMasterIsHeardAndSaidWhileItSends) {
    start("t");
    for (int i = 0; i < 1200; ++i) {
        bus->cycle_once();
        if (i % 100 == 0) second_master_writes(*bus, Address::position(0, 0x0F80), 0);
    }
    EXPECT_THAT(faults(), ElementsAre(id(BusAlarm::foreign_master)));
    EXPECT_GE(bus->master->statistics().frames_foreign, 12u);
    EXPECT_EQ(bus->state(0), sim::EsmState::op);
    bus->run_for(2100ms);
    EXPECT_THAT(faults(), IsEmpty());
}

// Nobody else has to do with a slave that went and came back.
TEST_F(Health, APowerCycledSlaveIsNeverSaidToHaveLostItsAddress) {
    for (const Duration cycle : {Duration{1ms}, Duration{4ms}}) {
        bus.emplace("tss", cycle);
        ASSERT_TRUE(bus->bring_up()) << bus->why();
        bus->run_for(200ms);
        std::vector<AlarmId> said;
        bus->on_cycle = [&] {
            for (const auto id : faults()) said.push_back(id);
        };
        for (const std::size_t slave : {2u, 1u}) {
            bus->network.set_power(slave, false);
            bus->run_for(100ms);
            bus->network.set_power(slave, true);
            ASSERT_TRUE(bus->run_until([&] { return bus->state(slave) == sim::EsmState::op; }, 10s)) << bus->why();
            bus->run_for(1s);
        }
        EXPECT_FALSE(said.empty());
        EXPECT_THAT(said, Not(Contains(id(BusAlarm::station_address_lost))));
        EXPECT_THAT(said, Not(Contains(id(BusAlarm::foreign_master))));
        EXPECT_THAT(faults(), IsEmpty());
    }
}

TEST_F(Health, TheOtherMasterIsNamedByItsAddress) {
    start("t");
    for (int i = 0; i < 3000; ++i) {
        bus->cycle_once();
        if (i % 10 == 0) second_master_writes(*bus, Address::position(0, 0x0F80), 0);
    }
    ASSERT_THAT(faults(), ElementsAre(id(BusAlarm::foreign_master)));
    EXPECT_EQ(bus->master->detail(facts().front()), "its network address is 02:11:22:33:44:55 (the slaves set 02h in its first byte)");
}

// Slaves in the hands of somebody else are left as they are, and he is named.
TEST_F(Health, ABringUpBesideAnotherMasterDisturbsNothing) {
    bus.emplace("ts");
    ASSERT_TRUE(bus->bring_up()) << bus->why();  // these slaves work now: for the other master
    int sent = 0;
    bus->on_cycle = [&] {
        if (++sent % 4 == 0) second_master_writes(*bus, Address::position(0, 0x0F80), 0);
    };
    Master second{bus->transport, bus->config};
    second.start();
    for (int i = 0; i < 500 && second.phase() != Master::Phase::failed; ++i) {
        bus->now += 1ms;
        second.receive(bus->now);
        bus->on_cycle();
        second.send(bus->now);
        second.step(bus->now);
    }
    ASSERT_EQ(second.phase(), Master::Phase::failed);
    EXPECT_EQ(second.failure().code, "bus.foreign_master");
    EXPECT_THAT(second.failure().what, ::testing::HasSubstr("02:11:22:33:44:55"));
    EXPECT_EQ(second.statistics().frames_sent, 0u);
}

TEST_F(Health, AMailboxThatFellSilentIsNoticedAlthoughNobodyAskedForAnything) {
    start("ts");
    bus->network.slave(1).stick_mailbox(true);
    EXPECT_TRUE(bus->run_until([&] { return !faults().empty(); }, 10s));
    EXPECT_THAT(faults(), ElementsAre(id(BusAlarm::mailbox_silent)));
    EXPECT_EQ(bus->state(1), sim::EsmState::op);
    EXPECT_TRUE(bus->master->health(1).fresh);
    bus->network.slave(1).stick_mailbox(false);
    expect_recovery(15s);
}

// --- frames ---------------------------------------------------------------------------------------------------------------------

TEST_F(Health, AWorkingCounterThatIsTooSmallOrTooLargeKeepsTheOldInputs) {
    for (const int offset : {-1, +1, +3}) {
        start("ts");
        bus->cable.working_counter_offset = offset;
        bus->run_for(10ms);
        EXPECT_FALSE(bus->master->health(0).fresh);
        EXPECT_GE(bus->master->health(0).age, 5u);
        EXPECT_THAT(faults(), Contains(id(BusAlarm::working_counter_wrong))) << offset;
        bus->cable.working_counter_offset = 0;
        expect_recovery();
    }
}

TEST_F(Health, DuplicatedAndReorderedAnswersAreTakenOnceAndInOrder) {
    start("ts");
    bus->transport.faults.duplicate_answers = 50;
    bus->run_for(100ms);
    EXPECT_GE(bus->master->statistics().frames_rejected, 40u);
    EXPECT_THAT(faults(), IsEmpty());
    bus->cable.reorder_by = 1500us;
    bus->cable.reorder = 10;
    bus->run_for(100ms);
    EXPECT_GE(bus->master->statistics().frames_late, 3u);
    expect_recovery();
}

// Frames that the machine bears: nobody is accused, and what the watch could not read meanwhile changes nothing.
TEST_F(Health, LostFramesShortOfTheLimitAccuseNobody) {
    for (int phase = 0; phase < 100; phase += 9) {
        bus.emplace("sst");
        bus->config.lost_frames_limit = 300;
        for (auto& slave : bus->config.slaves) slave.sm_watchdog = 500ms;
        ASSERT_TRUE(bus->bring_up()) << bus->why();
        bus->run_for(200ms + phase * 1ms);
        std::vector<AlarmId> said;
        bool in_op = true;
        bus->on_cycle = [&] {
            for (const auto id : faults()) said.push_back(id);
            for (std::size_t i = 0; i < 3; ++i) in_op = in_op && bus->master->health(i).al_state == AlState::op;
        };
        bus->transport.faults.drop_requests = 250;  // those of the watch are among them
        bus->run_until([&] { return bus->transport.faults.drop_requests == 0; }, 1s);
        EXPECT_GE(recent_gap(bus->master->bus().link, bus->now), 130u);
        EXPECT_LT(recent_gap(bus->master->bus().link, bus->now), 300u);
        bus->run_for(300ms);
        EXPECT_TRUE(in_op) << phase;
        EXPECT_THAT(said, IsEmpty()) << phase;
        bus->on_cycle = nullptr;
        bus->run_for(300ms);
        EXPECT_EQ(recent_gap(bus->master->bus().link, bus->now), 0u);
    }
}

// The limit lets through what the slaves' watchdogs do not: what is said is that frames were lost.
TEST_F(Health, AWatchdogThatIsShorterThanTheLimitIsSaidAsLostFrames) {
    bus.emplace("sst");
    bus->config.lost_frames_limit = 300;
    for (auto& slave : bus->config.slaves) slave.sm_watchdog = 100ms;
    ASSERT_TRUE(bus->bring_up()) << bus->why();
    bus->run_for(200ms);
    std::vector<AlarmId> said;
    bus->on_cycle = [&] {
        for (const auto id : faults())
            if (std::find(said.begin(), said.end(), id) == said.end()) said.push_back(id);
    };
    bus->transport.faults.drop_requests = 250;
    bus->run_until([&] { return bus->transport.faults.drop_requests == 0; }, 1s);
    ASSERT_EQ(bus->state(0), sim::EsmState::safeop);
    EXPECT_LT(recent_gap(bus->master->bus().link, bus->now), 300u);
    expect_recovery();
    std::erase(said, id(BusAlarm::dc_not_locked));
    EXPECT_THAT(said, ElementsAre(id(BusAlarm::frames_lost)));
}

TEST_F(Health, LinkDownIsSaidAloneAndTheBusReturns) {
    start("tst");
    bus->transport.faults.link_down = true;
    bus->run_for(500ms);
    EXPECT_THAT(faults(), ElementsAre(id(BusAlarm::link_down)));
    EXPECT_NE(bus->state(1), sim::EsmState::op) << "its watchdog has acted";
    bus->transport.faults.link_down = false;
    expect_recovery();
}

TEST_F(Health, AStallOfTheMasterEndsInOpAgain) {
    for (const Duration stall : {20ms, 200ms, 2000ms}) {
        start("tst");
        bus->now += stall;
        bus->network.advance(bus->now);
        EXPECT_EQ(bus->state(1), sim::EsmState::safeop) << "SM watchdog of 10 ms";
        EXPECT_TRUE(said_within(id(BusAlarm::starved_slave_left_op), 50ms));
        expect_recovery();
    }
}

// --- clocks ---------------------------------------------------------------------------------------------------------------------

TEST_F(Health, AReferenceClockThatStandsIsNotFollowed) {
    start("ss");
    const auto offset = bus->master->statistics().dc_offset_ns;
    bus->cable.freeze_reference_time = true;
    bus->run_for(200ms);
    EXPECT_THAT(faults(), ElementsAre(id(BusAlarm::reference_clock_lost)));
    EXPECT_NEAR(static_cast<double>(bus->master->statistics().dc_offset_ns), static_cast<double>(offset), 1000);
    bus->cable.freeze_reference_time = false;
    expect_recovery();
}

TEST_F(Health, TheReferenceIsStillFollowedWhileAnotherClockIsAway) {
    start("sts", 2);
    bus->network.set_power(2, false);
    bus->run_for(100ms);
    const auto rejected = bus->master->statistics().dc_rejected;
    bus->run_for(1s);
    EXPECT_EQ(bus->master->statistics().dc_rejected, rejected);
}

}  // namespace
}  // namespace taktwerk::ecat::test
