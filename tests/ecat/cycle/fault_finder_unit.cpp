// What is said when: the rules of the fault finder, without a bus. Slaves here are in the order of their positions.
#include "ecat/cycle/fault_finder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ecat/alarms.hpp"

namespace taktwerk::ecat {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::uint32_t limit = 3;

/// parents[i]: of slave i; -1: the first.
struct Finder {
    explicit Finder(const std::vector<int>& parents, std::vector<LossPolicy> policies = {}) : finder(make(parents, policies)) {
        count = parents.size();
        for (std::size_t i = 0; i < count; ++i) finder.condition(i).al_state = AlState::op;
        bus.slaves_answering = static_cast<std::uint16_t>(count);
    }
    static FaultFinder make(const std::vector<int>& parents, const std::vector<LossPolicy>& policies) {
        std::vector<FaultSlave> slaves;
        for (std::size_t i = 0; i < parents.size(); ++i) {
            FaultSlave slave;
            slave.index = i;
            if (parents[i] >= 0) slave.parent = static_cast<std::size_t>(parents[i]);
            if (i < policies.size()) slave.on_loss = policies[i];
            slaves.push_back(slave);
        }
        return FaultFinder{std::move(slaves), static_cast<std::uint16_t>(parents.size()), limit};
    }
    /// Slaves that do not answer any more, as the cycle sees them: not exchanged, and not counted.
    void vanish(std::initializer_list<std::size_t> slaves) {
        for (const auto s : slaves) finder.condition(s).age = limit;
        bus.slaves_answering = static_cast<std::uint16_t>(bus.slaves_answering - slaves.size());
    }
    std::vector<AlarmId> look() {
        finder.look(bus);
        std::vector<AlarmId> ids;
        for (const auto& fact : finder.facts()) ids.push_back(fact.id);
        return ids;
    }
    FaultFinder finder;
    BusCondition bus;
    std::size_t count = 0;
};

TEST(FaultFinder, SaysNothingOfABusThatIsWell) { EXPECT_THAT((Finder{{-1, 0, 1}}.look()), IsEmpty()); }

TEST(FaultFinder, WithoutFramesOnlyThatIsSaid) {
    Finder f{{-1, 0, 1}};
    f.vanish({0, 1, 2});
    f.bus.lost_in_a_row = limit;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::frames_lost)));
    f.bus.link_up = false;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::link_down)));
    f.bus.lost_in_a_row = limit - 1;
    f.bus.link_up = true;
    f.bus.slaves_answering = 3;
    for (std::size_t i = 0; i < 3; ++i) f.finder.condition(i).age = limit - 1;
    EXPECT_THAT(f.look(), IsEmpty()) << "up to the limit lost frames are only counted";
}

// ETG.1000.6: 001Bh is the watchdog of the process data. Who sent none is to blame, and only for codes that say so.
TEST(FaultFinder, ASlaveThatFallsRightAfterOurOwnStallIsNotBlamed) {
    for (const int number : {0x001A, 0x001B, 0x002C, 0x0032, 0x0033, 0x0034, 0x001D, 0x0000}) {
        const auto code = static_cast<std::uint16_t>(number);
        Finder f{{-1, 0}};
        (void)f.look();
        f.bus.stall = std::chrono::milliseconds{20};
        auto& slave = f.finder.condition(1);
        slave.al_state = AlState::safeop;
        slave.al_error = true;
        slave.al_status_code = code;
        const bool starved = code != 0x001D && code != 0;
        EXPECT_THAT(f.look(), ElementsAre(starved ? id(BusAlarm::starved_slave_left_op) : id(BusAlarm::slave_left_op))) << code;
        f.bus.stall = {};
        EXPECT_THAT(f.look(), ElementsAre(starved ? id(BusAlarm::starved_slave_left_op) : id(BusAlarm::slave_left_op)))
            << "as long as it stands";
        if (starved) {
            EXPECT_EQ(f.finder.facts()[0].source, AlarmSource::bus) << "no slave is accused";
            EXPECT_EQ(f.finder.facts()[0].a, 20.0) << "ms";
            EXPECT_EQ(f.finder.facts()[0].b, 1) << "slaves";
        }
        slave = {};
        slave.al_state = AlState::op;
        EXPECT_THAT(f.look(), IsEmpty());
        slave.al_state = AlState::safeop;
        slave.al_error = true;
        slave.al_status_code = code;
        EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::slave_left_op))) << "the next time it falls by itself";
    }
}

// The broadcast knows it in the same cycle, the watch reads the codes one after the other: from the first cycle to the last it is one alarm.
TEST(FaultFinder, ManyThatFallBehindOneStallAreOneAlarm) {
    Finder f{{-1, 0, 1, 2, 3}};
    f.bus.stall = std::chrono::milliseconds{20};
    f.bus.states = 0x14;  // SAFEOP, error
    for (std::size_t i = 0; i < 5; ++i) f.finder.condition(i).age = limit;
    ASSERT_THAT(f.look(), ElementsAre(id(BusAlarm::starved_slave_left_op)));
    f.bus.stall = {};
    for (std::size_t i = 0; i < 5; ++i) {
        f.finder.condition(i) = {.al_state = AlState::safeop, .al_error = true, .al_status_code = 0x1B, .age = limit + 20};
        EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::starved_slave_left_op))) << i;
    }
    EXPECT_EQ(f.finder.facts()[0].b, 5);
    f.bus.states = 0x0C;
    for (std::size_t i = 0; i < 4; ++i) {
        f.finder.condition(i) = {.al_state = AlState::op};
        ASSERT_THAT(f.look(), ElementsAre(id(BusAlarm::starved_slave_left_op)));
    }
    EXPECT_EQ(f.finder.facts()[0].b, 5) << "as many as it were";
    f.finder.condition(4) = {.al_state = AlState::op};
    EXPECT_THAT(f.look(), IsEmpty());
}

// Whoever falls while no frame comes back says so later, one by one: it is still the same alarm, until the last one is back.
TEST(FaultFinder, WhoFellWhileNoFrameCameBackIsPartOfThatAlarm) {
    for (const bool link : {true, false}) {
        Finder f{{-1, 0, 1}};
        f.bus.link_up = link;
        f.bus.lost_in_a_row = 150;
        const auto said = link ? id(BusAlarm::frames_lost) : id(BusAlarm::link_down);
        ASSERT_THAT(f.look(), ElementsAre(said));
        f.bus = {.slaves_answering = 3, .gap = 150, .states = 0x14};
        for (std::size_t i = 0; i < 3; ++i) f.finder.condition(i).age = 150;
        ASSERT_THAT(f.look(), ElementsAre(said));
        EXPECT_EQ(f.finder.facts()[0].a, 150);
        EXPECT_EQ(f.finder.facts()[0].b, 3) << "fell by it";
        f.bus.gap = 0;
        for (std::size_t i = 0; i < 3; ++i)
            f.finder.condition(i) = {.al_state = AlState::safeop, .al_error = true, .al_status_code = 0x1B, .age = 190};
        ASSERT_THAT(f.look(), ElementsAre(said));
        // An error of its own is not explained by that.
        f.finder.condition(1) = {.al_state = AlState::safeop, .al_error = true, .al_status_code = 0x1D, .age = 191};
        ASSERT_THAT(f.look(), ElementsAre(said, id(BusAlarm::slave_left_op)));
        for (std::size_t i = 0; i < 3; ++i) f.finder.condition(i) = {.al_state = AlState::op};
        f.bus.states = 8;
        EXPECT_THAT(f.look(), IsEmpty());
    }
}

// ETG.1000.6: a slave that changes its state by itself says so with the error bit and a code. One that does not was told to.
TEST(FaultFinder, WithoutAnErrorOfItsOwnSomebodyElseSentIt) {
    Finder f{{-1, 0, 1}};
    f.bus.states = 0x02;  // PREOP
    for (std::size_t i = 0; i < 3; ++i) f.finder.condition(i).age = limit;
    ASSERT_THAT(f.look(), ElementsAre(id(BusAlarm::foreign_command))) << "known before the watch has asked";
    EXPECT_EQ(f.finder.facts()[0].a, 3);
    f.bus.seen.set<BusAlarm::foreign_master>();
    for (std::size_t i = 0; i < 3; ++i) f.finder.condition(i) = {.al_state = AlState::preop, .age = 30};
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::foreign_command))) << "it names whose frames were heard: one trouble, one alarm";
    f.finder.condition(1) = {.al_state = AlState::safeop, .al_error = true, .al_status_code = 0x1B, .age = 40};
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::foreign_command))) << "errors of the way back change nothing";
    for (std::size_t i = 0; i < 3; ++i) f.finder.condition(i) = {.al_state = AlState::op};
    f.bus.states = 0x08;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::foreign_master))) << "he sends on";

    Finder own{{-1, 0}};
    own.bus.states = 0x1C;  // one in SAFEOP, error
    own.finder.condition(1).age = limit;
    ASSERT_THAT(own.look(), ElementsAre(id(BusAlarm::slave_left_op)));
    EXPECT_EQ(own.finder.facts()[0].a, 0) << "not read yet";

    Finder down{{-1}};  // this master itself took it down, to set it up again: its trouble is what it was
    down.finder.condition(0).age = limit;
    EXPECT_THAT(down.look(), ElementsAre(id(BusAlarm::working_counter_wrong)));
    down.bus.states = 0x01;
    down.finder.condition(0).taken_down = true;
    EXPECT_THAT(down.look(), ElementsAre(id(BusAlarm::working_counter_wrong))) << "the broadcast knows it first";
    for (const auto state : {AlState::init, AlState::preop, AlState::safeop}) {
        down.finder.condition(0) = {.al_state = state, .age = 30, .taken_down = true};
        EXPECT_THAT(down.look(), ElementsAre(id(BusAlarm::working_counter_wrong)));
    }
    down.finder.condition(0) = {.al_state = AlState::op, .taken_down = true};
    down.bus.states = 0x08;
    EXPECT_THAT(down.look(), IsEmpty());
    down.finder.condition(0) = {.al_state = AlState::safeop, .al_error = true, .al_status_code = 0x1D, .age = 30};
    EXPECT_THAT(down.look(), ElementsAre(id(BusAlarm::slave_left_op))) << "the next time it falls by itself";
}

// Its outputs do not reach it any more, although frames come back: its watchdog trips by that, and that is no other trouble.
TEST(FaultFinder, AWatchdogThatTripsByWhatIsSaidAlreadySaysNothingNew) {
    Finder f{{-1, 0}};
    f.bus.states = 0x08;
    auto& slave = f.finder.condition(1);
    slave.age = limit;
    ASSERT_THAT(f.look(), ElementsAre(id(BusAlarm::working_counter_wrong)));
    f.bus.states = 0x1C;
    slave.age = 10;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::working_counter_wrong))) << "not read yet";
    slave = {.al_state = AlState::safeop, .al_error = true, .al_status_code = 0x1B, .age = 20};
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::working_counter_wrong)));
    slave.al_status_code = 0x1D;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::slave_left_op))) << "that is an error of its own";

    Finder first{{-1, 0}};  // it fell, and is not exchanged for that
    first.bus.states = 0x1C;
    first.finder.condition(1) = {.al_state = AlState::safeop, .al_error = true, .al_status_code = 0x1B, .age = limit};
    EXPECT_THAT(first.look(), ElementsAre(id(BusAlarm::slave_left_op)));
}

// It has no address, because it must not be taken for the slave: it does not answer there, and nobody is missing all the same.
TEST(FaultFinder, AnotherDeviceInItsPlaceIsNoLostSlave) {
    Finder f{{-1, 0}};
    f.vanish({1});
    ASSERT_THAT(f.look(), ElementsAre(id(BusAlarm::slave_lost)));
    f.bus.slaves_answering = 2;
    f.finder.condition(1).presence = Presence::silent;
    f.finder.condition(1).trouble = ReturnTrouble::other_device;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::other_device)));
    f.bus.slaves_answering = 1;  // taken away again
    EXPECT_THAT(f.look(), ::testing::Contains(id(BusAlarm::slave_lost)));
}

// --- slaves that share a sync unit: none of them is exchanged when one is out --------------------------------------------------------

/// Slaves 1, 2 and 3 share one; 0 has its own.
struct SharedUnit {
    explicit SharedUnit(LossPolicy policy = LossPolicy::stop_machine) : finder(slaves(policy), 4, limit) {
        for (std::size_t i = 0; i < 4; ++i) finder.condition(i).al_state = AlState::op;
        bus.slaves_answering = 4;
        bus.states = 0x08;
    }
    static std::vector<FaultSlave> slaves(LossPolicy policy) {
        std::vector<FaultSlave> all(4);
        for (std::size_t i = 0; i < 4; ++i) {
            all[i].index = i;
            if (i > 0) all[i].parent = i - 1, all[i].unit = 7, all[i].on_loss = policy;
        }
        return all;
    }
    std::vector<std::pair<AlarmId, std::size_t>> look() {
        finder.look(bus);
        std::vector<std::pair<AlarmId, std::size_t>> said;
        for (const auto& fact : finder.facts()) said.emplace_back(fact.id, fact.index);
        return said;
    }
    void nobody_is_exchanged(std::uint32_t cycles = limit) {
        for (std::size_t i = 1; i < 4; ++i) finder.condition(i).age = cycles;
    }
    static std::pair<AlarmId, std::size_t> of(BusAlarm alarm, std::size_t index) { return {id(alarm), index}; }
    FaultFinder finder;
    BusCondition bus;
};

TEST(FaultFinder, ASharedUnitNamesTheOneThatLeftOpAndNobodyElse) {
    SharedUnit unit;
    unit.nobody_is_exchanged();
    unit.bus.states = 0x1C;
    EXPECT_THAT(unit.look(), ElementsAre(SharedUnit::of(BusAlarm::sync_unit_not_exchanged, 1)))
        << "who it is has not been asked yet: the machine stops";
    EXPECT_EQ(unit.finder.facts()[0].source, AlarmSource::bus) << "no slave is accused";
    EXPECT_EQ(unit.finder.facts()[0].a, 3);
    unit.nobody_is_exchanged(30);
    unit.finder.condition(2) = {.al_state = AlState::safeop, .al_error = true, .al_status_code = 0x1D, .age = 30};
    EXPECT_THAT(unit.look(), ElementsAre(SharedUnit::of(BusAlarm::slave_left_op, 2)));
    unit.nobody_is_exchanged(30000);
    EXPECT_THAT(unit.look(), ElementsAre(SharedUnit::of(BusAlarm::slave_left_op, 2))) << "however long it takes";
    for (std::size_t i = 1; i < 4; ++i) unit.finder.condition(i) = {.al_state = AlState::op};
    unit.bus.states = 0x08;
    EXPECT_THAT(unit.look(), IsEmpty());
}

TEST(FaultFinder, ASharedUnitNamesTheOneThatIsGone) {
    SharedUnit unit;
    unit.nobody_is_exchanged();
    unit.bus.slaves_answering = 3;
    EXPECT_THAT(unit.look(), ElementsAre(SharedUnit::of(BusAlarm::slaves_missing, 0)));
    unit.finder.condition(3).presence = Presence::silent;
    EXPECT_THAT(unit.look(), ElementsAre(SharedUnit::of(BusAlarm::slave_lost, 3)));
    unit.nobody_is_exchanged(30000);
    EXPECT_THAT(unit.look(), ElementsAre(SharedUnit::of(BusAlarm::slave_lost, 3)));
}

TEST(FaultFinder, ASharedUnitNamesTheOneThatIsSetUpAgain) {
    SharedUnit unit;
    unit.nobody_is_exchanged();
    ASSERT_THAT(unit.look(), ElementsAre(SharedUnit::of(BusAlarm::sync_unit_not_exchanged, 1)));
    unit.finder.condition(1).taken_down = true;
    EXPECT_THAT(unit.look(), ElementsAre(SharedUnit::of(BusAlarm::working_counter_wrong, 1)));
}

TEST(FaultFinder, ASharedUnitOfWhichNobodyIsKnownToBeOutSpeaksForItself) {
    SharedUnit unit;
    unit.nobody_is_exchanged(30000);
    for (int i = 0; i < 300; ++i) ASSERT_THAT(unit.look(), ElementsAre(SharedUnit::of(BusAlarm::sync_unit_not_exchanged, 1)));
}

TEST(FaultFinder, ASharedUnitThatMayDropOutStopsOnlyItsOwnAxes) {
    SharedUnit unit{LossPolicy::stop_own_axes};
    unit.nobody_is_exchanged();
    EXPECT_THAT(unit.look(), ElementsAre(SharedUnit::of(BusAlarm::sync_unit_dropped_out, 1)));
    unit.finder.condition(2) = {.al_state = AlState::safeop, .al_error = true, .al_status_code = 0x1D, .age = 30};
    EXPECT_THAT(unit.look(), ElementsAre(SharedUnit::of(BusAlarm::slave_dropped_out, 2)));
}

// Gone for less than it takes to miss it, then back from INIT without its address: it had no power.
TEST(FaultFinder, AShortPowerCutIsNobodysCommand) {
    Finder f{{-1, 0}};
    f.bus.states = 0x09;
    f.finder.condition(1).age = limit;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::slave_left_op))) << "INIT: not known yet";
    f.finder.condition(1) = {.al_state = AlState::unknown, .age = 20, .presence = Presence::silent};
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::slave_lost)));
    f.finder.condition(1) = {.al_state = AlState::unknown, .age = 40};
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::slave_lost))) << "it has its address again, and nothing else";
    f.finder.condition(1) = {.al_state = AlState::init, .age = 50};
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::slave_lost)));
}

// Between power and silence: not answering to its address, and not exchanged either.
TEST(FaultFinder, OnlyWhoExchangesInThisCycleHasLostNothingButItsAddress) {
    Finder f{{-1, 0}};
    auto& slave = f.finder.condition(1);
    slave.presence = Presence::silent;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::station_address_lost)));
    slave.age = 1;
    f.bus.slaves_answering = 1;
    EXPECT_THAT(f.look(), ::testing::Not(::testing::Contains(id(BusAlarm::station_address_lost))));
}

// 0 - 1 - 2      behind port 3 of slave 0: 1, 2; behind port 1: 3, 4
//  \- 3 - 4
TEST(FaultFinder, EachBranchThatIsGoneIsOneAlarm) {
    Finder f{{-1, 0, 1, 0, 3}};
    f.vanish({1, 2, 3, 4});
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::cable_broken), id(BusAlarm::cable_broken)));
    EXPECT_EQ(f.finder.facts()[0].index, 1);
    EXPECT_EQ(f.finder.facts()[0].a, 2);
    EXPECT_EQ(f.finder.facts()[1].index, 3);
}

TEST(FaultFinder, ALeafAloneIsALostSlave) {
    Finder f{{-1, 0, 1, 0, 3}};
    f.vanish({4});
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::slave_lost)));
    EXPECT_EQ(f.finder.facts()[0].index, 4);
}

// A coupler has no process data: the cycle misses two slaves and can name one. The watch then asks each.
TEST(FaultFinder, UntilTheMissingAreNamedTheBusSpeaksForThem) {
    Finder f{{-1, 0, 1}};
    f.finder.condition(2).age = limit;
    f.bus.slaves_answering = 1;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::slaves_missing)));
    EXPECT_EQ(f.finder.facts()[0].a, 2);
    EXPECT_EQ(f.finder.facts()[0].b, 3);
    f.finder.condition(1).presence = f.finder.condition(2).presence = Presence::silent;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::cable_broken)));
    EXPECT_EQ(f.finder.facts()[0].index, 1);
}

TEST(FaultFinder, AGroupStandsUntilItsLastSlaveIsBackInOp) {
    Finder f{{-1, 0, 1}};
    f.vanish({1, 2});
    ASSERT_THAT(f.look(), ElementsAre(id(BusAlarm::cable_broken)));
    // Plugged in: both answer again, from INIT.
    f.bus.slaves_answering = 3;
    f.finder.condition(1).al_state = f.finder.condition(2).al_state = AlState::init;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::cable_broken)));
    f.finder.condition(1) = {.al_state = AlState::op};
    ASSERT_THAT(f.look(), ElementsAre(id(BusAlarm::cable_broken)));
    EXPECT_EQ(f.finder.facts()[0].a, 2) << "as many as it took along";
    EXPECT_EQ(f.finder.facts()[0].b, 1) << "still away";
    f.finder.condition(2) = {.al_state = AlState::op};
    EXPECT_THAT(f.look(), IsEmpty());
}

TEST(FaultFinder, TheLossPolicyOfWhoIsGoneDecidesTheKind) {
    using enum LossPolicy;
    Finder own{{-1, 0, 1}, {stop_machine, stop_own_axes, stop_own_axes}};
    own.vanish({1, 2});
    EXPECT_THAT(own.look(), ElementsAre(id(BusAlarm::branch_dropped_out)));
    Finder mixed{{-1, 0, 1}, {stop_machine, stop_own_axes, stop_machine}};
    mixed.vanish({1, 2});
    EXPECT_THAT(mixed.look(), ElementsAre(id(BusAlarm::cable_broken)));
    Finder fallen{{-1, 0}, {stop_machine, stop_own_axes}};
    fallen.finder.condition(1).al_state = AlState::safeop;
    fallen.finder.condition(1).al_status_code = 0x1B;
    EXPECT_THAT(fallen.look(), ElementsAre(id(BusAlarm::slave_dropped_out)));
    EXPECT_EQ(fallen.finder.facts()[0].b, 0x1B);
}

TEST(FaultFinder, WhoExchangesButDoesNotAnswerHasLostItsAddress) {
    Finder f{{-1, 0}};
    f.finder.condition(1).presence = Presence::silent;
    f.finder.condition(1).al_state = AlState::unknown;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::station_address_lost)));
}

TEST(FaultFinder, AnswersOpAndIsNotExchanged) {
    Finder f{{-1, 0}};
    f.finder.condition(1).age = limit;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::working_counter_wrong)));
}

TEST(FaultFinder, TroubleOnTheWayBackIsSaidAlsoOfAGroup) {
    Finder f{{-1, 0, 1}};
    f.vanish({1, 2});
    (void)f.look();
    f.bus.slaves_answering = 3;
    f.finder.condition(1).al_state = AlState::init;
    f.finder.condition(1).trouble = ReturnTrouble::other_device;
    f.finder.condition(2).trouble = ReturnTrouble::refused;
    f.finder.condition(2).attempts = 2;
    f.finder.condition(2).al_state = AlState::preop;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::cable_broken), id(BusAlarm::other_device))) << "the second is still on its way";
    f.finder.condition(2).attempts = 3;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::other_device), id(BusAlarm::slave_does_not_return), id(BusAlarm::slave_left_op)))
        << "the cable is whole";
    f.finder.condition(2).al_state = AlState::op;
    f.finder.condition(2).age = 0;
    f.finder.condition(2).trouble = ReturnTrouble::none;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::other_device)));
}

// The watch asks one slave after the other. Whoever it finds first has mostly lost nothing but the one before it.
TEST(FaultFinder, NobodyIsNamedBeforeAllWhoAreMissingAreKnown) {
    for (const bool exchange_missed : {false, true}) {
        Finder f{{-1, 0, 1, 2}};
        (void)f.look();
        f.bus.slaves_answering = 1;
        const auto waiting = [&] {
            const auto said = f.look();
            EXPECT_EQ(said, exchange_missed ? std::vector<AlarmId>{id(BusAlarm::slaves_missing)} : std::vector<AlarmId>{});
        };
        for (const std::size_t gone : {1u, 2u, 3u}) f.finder.condition(gone).age = exchange_missed && gone != 1 ? limit : 1;
        waiting();
        f.finder.condition(2).presence = Presence::silent;
        waiting();
        f.finder.condition(3).presence = Presence::silent;
        waiting();
        if (exchange_missed) {
            EXPECT_EQ(f.finder.facts()[0].a, 3);
        }
        f.finder.condition(1).presence = Presence::silent;
        ASSERT_THAT(f.look(), ElementsAre(id(BusAlarm::cable_broken)));
        EXPECT_EQ(f.finder.facts()[0].index, 1) << "the first of them";
        EXPECT_EQ(f.finder.facts()[0].a, 3);
    }
}

// A device without a configuration is on the cable, and nobody can name it: those who can be named are, after a while.
TEST(FaultFinder, WhoIsKnownIsNamedAlthoughOneNeverWillBe) {
    FaultFinder finder{{{.index = 0}, {.index = 1, .parent = 0}}, 3, limit};
    for (std::size_t i = 0; i < 2; ++i) finder.condition(i).al_state = AlState::op;
    finder.condition(1).presence = Presence::silent;
    finder.condition(1).age = limit;
    const BusCondition bus{.slaves_answering = 1};
    finder.look(bus);
    ASSERT_EQ(finder.facts().size(), 1u);
    EXPECT_EQ(finder.facts()[0].id, id(BusAlarm::slaves_missing));
    for (int i = 0; i < 250; ++i) finder.look(bus);
    ASSERT_FALSE(finder.facts().empty());
    EXPECT_EQ(finder.facts()[0].id, id(BusAlarm::slave_lost));
    EXPECT_EQ(finder.facts()[0].index, 1);
}

// The machine bears more than this slave's watchdog does: what it says then is still no fault of the slave.
TEST(FaultFinder, AWatchdogShorterThanTheLimitIsNoFaultOfTheSlave) {
    struct Case {
        std::uint32_t gap;
        std::uint16_t code;
        AlarmId said;
    };
    for (const auto& c :
         {Case{150, 0x1B, id(BusAlarm::frames_lost)}, Case{50, 0x1B, id(BusAlarm::slave_left_op)}, Case{4, 0x1A, id(BusAlarm::frames_lost)},
          Case{0, 0x1A, id(BusAlarm::slave_left_op)}, Case{150, 0x1D, id(BusAlarm::slave_left_op)}}) {
        FaultFinder finder{{{.index = 0, .watchdog_cycles = 99}}, 1, 300};
        finder.condition(0) = {.al_state = AlState::safeop, .al_error = true, .al_status_code = c.code, .age = c.gap};
        finder.look({.slaves_answering = 1, .gap = c.gap, .states = 0x14});
        ASSERT_EQ(finder.facts().size(), 1u);
        EXPECT_EQ(finder.facts()[0].id, c.said) << c.gap << " cycles, code " << c.code;
        if (c.said == id(BusAlarm::frames_lost)) {
            EXPECT_EQ(finder.facts()[0].source, AlarmSource::bus);
            EXPECT_EQ(finder.facts()[0].a, c.gap);
            EXPECT_EQ(finder.facts()[0].b, 1) << "slaves";
        }
    }
}

// A computer that is some milliseconds late in the middle of half a second without frames has not starved anybody.
TEST(FaultFinder, AStallThatIsShorterThanTheWatchdogExplainsNoWatchdog) {
    struct Case {
        Duration stall;
        std::uint32_t gap;
        std::uint16_t code;
        AlarmId said;
    };
    using std::chrono::milliseconds;
    for (const auto& c : {Case{milliseconds{7}, 520, 0x1B, id(BusAlarm::frames_lost)},
                          Case{milliseconds{510}, 2, 0x1B, id(BusAlarm::starved_slave_left_op)},
                          Case{milliseconds{7}, 0, 0x1B, id(BusAlarm::slave_left_op)},
                          Case{milliseconds{7}, 0, 0x1A, id(BusAlarm::starved_slave_left_op)}}) {
        FaultFinder finder{{{.index = 0, .watchdog_cycles = 499, .watchdog = milliseconds{499}}}, 1, 300};
        const BusCondition bus{.slaves_answering = 1, .stall = c.stall, .gap = c.gap, .states = 0x14};
        finder.condition(0) = {.al_state = AlState::unknown, .age = 520};  // not read yet
        finder.look(bus);
        ASSERT_EQ(finder.facts().size(), 1u);
        if (c.gap > 2) {
            EXPECT_EQ(finder.facts()[0].id, c.said) << "from the first cycle on";
        }
        finder.condition(0) = {.al_state = AlState::safeop, .al_error = true, .al_status_code = c.code, .age = 520};
        finder.look(bus);
        ASSERT_EQ(finder.facts().size(), 1u);
        EXPECT_EQ(finder.facts()[0].id, c.said) << c.stall.count() << " ns, " << c.gap << " cycles, code " << c.code;
    }
}

// A reference answers a cycle late now and then; without its time for 50 cycles (docs/faults.md) the clocks may have drifted.
TEST(FaultFinder, AClockThatMissesAFewTimesIsNotLost) {
    FaultFinder finder{{{.index = 0}}, 1, 300};
    finder.condition(0).al_state = AlState::op;
    finder.look({.slaves_answering = 1, .reference_times_missing = 49});
    EXPECT_TRUE(finder.facts().empty());
    finder.look({.slaves_answering = 1, .reference_times_missing = 50});
    ASSERT_EQ(finder.facts().size(), 1u);
    EXPECT_EQ(finder.facts()[0].id, id(BusAlarm::reference_clock_lost));
}

TEST(FaultFinder, AClockIsNotToBlameForFramesThatDoNotComeBack) {
    FaultFinder finder{{{.index = 0}}, 1, 300};
    finder.condition(0).al_state = AlState::op;
    finder.look({.lost_in_a_row = 60, .slaves_answering = 1, .reference_times_missing = 60, .gap = 60});
    EXPECT_TRUE(finder.facts().empty());
    finder.look({.slaves_answering = 1, .reference_times_missing = 60, .gap = 60});
    EXPECT_TRUE(finder.facts().empty());
    finder.look({.slaves_answering = 1, .reference_times_missing = 61});
    ASSERT_EQ(finder.facts().size(), 1u);
    EXPECT_EQ(finder.facts()[0].id, id(BusAlarm::reference_clock_lost));
}

// --- a ring ---------------------------------------------------------------------------------------------------------------------

TEST(FaultFinder, ABrokenRingIsSaidWhenASecondFrameHasSeenIt) {
    Finder f{{-1, 0, 1}};
    f.bus.ring = {RingShape::closed, 3, 0, 0};
    EXPECT_THAT(f.look(), IsEmpty());
    f.bus.ring = {RingShape::first_silent, 3, 1, 1};
    EXPECT_THAT(f.look(), IsEmpty()) << "one frame may have got lost";
    f.bus.ring = {RingShape::open, 2, 1, 1};
    ASSERT_THAT(f.look(), ElementsAre(id(BusAlarm::ring_broken)));
    EXPECT_EQ(f.finder.facts()[0].source, AlarmSource::bus) << "no slave is accused";
    EXPECT_EQ(f.finder.facts()[0].a, 2);
    EXPECT_EQ(f.finder.facts()[0].b, 1);
    f.bus.ring = {RingShape::closed, 3, 0, 1};
    EXPECT_THAT(f.look(), IsEmpty());
}

TEST(FaultFinder, WhoIsCutOffFromTheReferenceIsSaidWhereItIsToRampDown) {
    // Slave 1 has the reference; 0 and 3 run no SYNC0.
    std::vector<FaultSlave> slaves(5);
    for (std::size_t i = 0; i < slaves.size(); ++i) {
        slaves[i].index = i;
        slaves[i].position = static_cast<std::uint16_t>(i);
        slaves[i].synchronised = i != 0 && i != 3;
        slaves[i].reference = i == 1;
        slaves[i].station = static_cast<std::uint16_t>(100 + i);
    }
    const auto cut_off = [&](const RingState& ring, bool ramp_down, std::uint16_t reference_station = 0) {
        FaultFinder finder{slaves, 5, limit};
        for (std::size_t i = 0; i < slaves.size(); ++i) finder.condition(i).al_state = AlState::op;
        BusCondition bus;
        bus.slaves_answering = 5;
        bus.ring = ring;
        bus.ramp_down = ramp_down;
        bus.reference_station = reference_station;
        finder.look(bus);
        finder.look(bus);
        std::vector<int> who;
        for (const auto& fact : finder.facts())
            if (fact.id == id(BusAlarm::cut_off_from_reference)) who.push_back(fact.index);
        return who;
    };
    EXPECT_THAT(cut_off({RingShape::open, 2, 3, 1}, true), ElementsAre(2, 4));
    EXPECT_THAT(cut_off({RingShape::open, 3, 2, 1}, true), ElementsAre(4));
    EXPECT_THAT(cut_off({RingShape::open, 1, 4, 1}, true), IsEmpty()) << "all who run SYNC0 are with the reference";
    EXPECT_THAT(cut_off({RingShape::first_silent, 5, 5, 1}, true), IsEmpty());
    EXPECT_THAT(cut_off({RingShape::second_silent, 5, 0, 1}, true), IsEmpty());
    EXPECT_THAT(cut_off({RingShape::open, 2, 3, 1}, false), IsEmpty());
    EXPECT_THAT(cut_off({RingShape::open, 2, 1, 1}, true), ElementsAre(4)) << "2 and 3 do not answer: that is said of them";
    EXPECT_THAT(cut_off({RingShape::open, 3, 1, 1}, true), ElementsAre(4)) << "one in a branch in front of the break does not";
    EXPECT_THAT(cut_off({RingShape::one_way, 5, 0, 1}, true), IsEmpty());
    EXPECT_THAT(cut_off({RingShape::open, 2, 3, 1}, true, 104), ElementsAre(1)) << "4 serves as the reference now";
}

// A coupler in front loses its power for a moment: it comes back in INIT and without its address. Nobody wrote to it.
TEST(FaultFinder, ASlaveWithoutProcessDataThatBeginsAnewWasSentNowhereByAnybody) {
    FaultSlave coupler, terminal;
    coupler.exchanges = false;
    terminal.index = 1, terminal.parent = 0;
    FaultFinder finder{{coupler, terminal}, 2, limit};
    finder.condition(0).al_state = finder.condition(1).al_state = AlState::op;
    BusCondition bus;
    bus.slaves_answering = 2;
    bus.states = static_cast<std::uint16_t>(AlState::init) | static_cast<std::uint16_t>(AlState::op);
    const auto said = [&] {
        finder.look(bus);
        std::vector<AlarmId> ids;
        for (const auto& fact : finder.facts()) ids.push_back(fact.id);
        return ids;
    };
    finder.condition(0).presence = Presence::silent;
    finder.condition(0).al_state = AlState::unknown;
    EXPECT_THAT(said(), ElementsAre(id(BusAlarm::slave_lost)));
    finder.condition(0).presence = Presence::answers;
    for (const auto state : {AlState::init, AlState::preop, AlState::safeop}) {
        finder.condition(0).al_state = state;
        EXPECT_THAT(said(), ElementsAre(id(BusAlarm::slave_lost))) << name(state);
    }
    finder.condition(0).al_state = AlState::op;
    bus.states = static_cast<std::uint16_t>(AlState::op);
    EXPECT_THAT(said(), IsEmpty());
    finder.condition(0).presence = Presence::silent;
    EXPECT_THAT(said(), ElementsAre(id(BusAlarm::station_address_lost))) << "all are in OP: it lost nothing but its address";
}

// The second slave is back and has no address yet, when the fourth loses its power: the fourth is missing, and its settings are as they were.
TEST(FaultFinder, WhoVanishesWhileAnotherReturnsIsNotTakenForOneThatDoesNotExchange) {
    Finder f{{-1, 0, 1, 2}};
    f.vanish({1, 2, 3});
    for (const std::size_t s : {1u, 2u, 3u})
        f.finder.condition(s).presence = Presence::silent, f.finder.condition(s).al_state = AlState::unknown;
    EXPECT_THAT(f.look(), ElementsAre(id(BusAlarm::cable_broken)));
    f.bus.slaves_answering = 4;
    f.bus.states = static_cast<std::uint16_t>(AlState::init) | static_cast<std::uint16_t>(AlState::op);
    for (const std::size_t s : {2u, 3u}) {
        f.finder.condition(s).presence = Presence::answers, f.finder.condition(s).al_state = AlState::op, f.finder.condition(s).age = 0;
    }
    (void)f.look();
    f.vanish({3});
    EXPECT_THAT(f.look(), ::testing::UnorderedElementsAre(id(BusAlarm::cable_broken), id(BusAlarm::slaves_missing)));
    f.finder.condition(3).presence = Presence::silent, f.finder.condition(3).al_state = AlState::unknown;
    EXPECT_THAT(f.look(), ::testing::UnorderedElementsAre(id(BusAlarm::cable_broken), id(BusAlarm::slave_lost)));
    EXPECT_EQ(f.finder.facts().back().index, 3u);
}

}  // namespace
}  // namespace taktwerk::ecat
