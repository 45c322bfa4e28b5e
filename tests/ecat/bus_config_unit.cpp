#include "ecat/bus_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "ecat/alarms.hpp"
#include "ecat/description/module_pdos.hpp"
#include "ecat/sim/digital_terminal.hpp"
#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

BusConfig good() {
    TestBus bus{"st"};
    return bus.config;
}

auto with_code(const char* code) { return Contains(Field(&Error::code, code)); }

// The servo needs multiples of 125 us and at least 125 us: a 50 us bus serves it every fifth cycle.
TEST(BusConfig, ASlowerSyncUnitGivesADriveTheCycleItNeeds) {
    auto config = good();
    config.cycle = 50us;
    EXPECT_THAT(check(config), with_code("bus.cycle_too_short"));
    config.slaves[0].sync_unit = "drives";
    config.sync_units = {{"drives", 5}};
    EXPECT_THAT(check(config), IsEmpty());
}

TEST(BusConfig, ARingHasTwoInterfacesOfOneKind) {
    auto config = good();
    config.ring.emplace();
    EXPECT_THAT(check(config), IsEmpty()) << "both simulated";
    config.interface = "eth1";
    EXPECT_THAT(check(config), with_code("bus.ring"));
    config.ring->interface2 = "eth1";
    EXPECT_THAT(check(config), with_code("bus.ring"));
    config.ring->interface2 = "eth2";
    EXPECT_THAT(check(config), IsEmpty());
    config.interface.clear();
    EXPECT_THAT(check(config), with_code("bus.ring"));
}

TEST(BusConfig, AGoodOneHasNoProblems) { EXPECT_THAT(check(good()), IsEmpty()); }

struct Case {
    const char* code;
    void (*spoil)(BusConfig&);
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.code; }

class BadBusConfig : public ::testing::TestWithParam<Case> {};

TEST_P(BadBusConfig, IsFoundWithoutABusAndSaysWhatToDo) {
    BusConfig config = good();
    GetParam().spoil(config);
    const auto problems = check(config);
    ASSERT_THAT(problems, with_code(GetParam().code));
    for (const auto& problem : problems) {
        EXPECT_FALSE(problem.subject.empty()) << problem.text();
        EXPECT_FALSE(problem.remedy.empty()) << problem.text();
    }
}

// Servo: 1701h 6 bytes and 1B01h 6 bytes; terminal: 1 and 1; a datagram has 12 bytes of its own. With clock (8) and AL states (2):
// (12 + 12) + (12 + 2) + (12 + 8) + (12 + 2) = 72, headers 16, preamble and gap 24: 112 bytes of 80 ns = 8.96 us, and 1 us a slave.
TEST(Sync0Budget, IsWhatTheFramesLeaveOfTheShift) {
    const BusConfig config = good();
    EXPECT_EQ(estimated_flight(config), 8'960ns + 2us);
    EXPECT_EQ(time_to_compute(config, config.slaves[0]), 500us - 10'960ns);
}

BusConfig many_terminals(int count, Duration cycle) {
    BusConfig config;
    config.cycle = cycle;
    const auto device = std::make_shared<DeviceDescription>(sim::digital_input_output_terminal(128, 128));
    for (int i = 0; i < count; ++i) {
        SlaveConfig slave;
        slave.name = "t" + std::to_string(i);
        slave.device = device;
        slave.position = static_cast<std::uint16_t>(i);
        slave.dc = false;
        config.slaves.push_back(slave);
    }
    return config;
}

// 100 terminals of 16 + 16 bytes: 100 x (12 + 32), clock 20, states 14 = 4434 bytes of datagrams in 3 frames of 1498, each with 16 bytes of
// headers and 24 of preamble, FCS and gap: 4554 bytes of 80 ns = 364.32 us. Each slave adds about 1 us there and back.
TEST(BusLoad, IsTheTimeOfTheFramesOnTheWireAndThroughTheSlaves) {
    const auto load = bus_load(many_terminals(100, 1ms));
    EXPECT_EQ(load.frames, 3u);
    EXPECT_EQ(load.bytes, 4434u + 3 * 16);
    EXPECT_EQ(load.wire, 364'320ns);
    EXPECT_EQ(load.round_trip, 464'320ns);
}

TEST(BusLoad, ACycleThatTheFramesDoNotFitIntoIsRefusedWithTheNumbers) {
    const auto problems = check(many_terminals(100, 125us));
    ASSERT_THAT(problems, SizeIs(1));
    EXPECT_EQ(problems[0].code, "bus.cycle_too_short_for_frames");
    EXPECT_THAT(problems[0].what, HasSubstr("4482 bytes in 3 frame(s): at 100 Mbit/s 364 us on the wire"));
    EXPECT_THAT(problems[0].what, HasSubstr("the cycle is 125 us"));
    EXPECT_THAT(problems[0].remedy, HasSubstr("at least 619 us"));
    EXPECT_THAT(check(many_terminals(100, 500us)), IsEmpty()) << "tight, and possible";
}

// A quarter of them in each cycle.
TEST(BusLoad, SlowerSyncUnitsAreSpread) {
    auto config = many_terminals(100, 125us);
    for (std::size_t i = 0; i < 100; ++i) config.slaves[i].sync_unit = "u" + std::to_string(i % 8);
    for (int u = 0; u < 8; ++u) config.sync_units.push_back({"u" + std::to_string(u), 8});
    EXPECT_LT(bus_load(config).wire, 364'320ns / 7);
    EXPECT_THAT(check(config), IsEmpty());
}

StartupSdo quick_stop(std::int64_t value) {
    StartupSdo sdo;
    sdo.index = 0x6085;
    sdo.value = value;
    return sdo;
}

INSTANTIATE_TEST_SUITE_P(
    Each, BadBusConfig,
    ::testing::Values(
        Case{"bus.cycle", [](BusConfig& c) { c.cycle = 0ns; }}, Case{"bus.no_slaves", [](BusConfig& c) { c.slaves.clear(); }},
        Case{"bus.lost_frames_limit", [](BusConfig& c) { c.lost_frames_limit = 0; }},
        Case{"bus.acyclic_per_cycle", [](BusConfig& c) { c.acyclic_per_cycle = 0; }},
        Case{"bus.sync0_shift", [](BusConfig& c) { c.slaves[0].sync0_shift = 1ms; }},
        Case{"bus.sync0_budget", [](BusConfig& c) { c.slaves[0].sync0_shift = 9us; }},
        Case{"bus.sync1", [](BusConfig& c) { c.slaves[0].sync1 = 1ms; }}, Case{"bus.sync1", [](BusConfig& c) { c.slaves[0].sync1 = -1ns; }},
        Case{"bus.duplicate_sync_unit",
             [](BusConfig& c) {
                 c.slaves[1].sync_unit = "io";
                 c.sync_units = {{"io", 2}, {"io", 3}};
             }},
        Case{"bus.sync_unit_divisor",
             [](BusConfig& c) {
                 c.slaves[1].sync_unit = "io";
                 c.sync_units = {{"io", 0}};
             }},
        Case{"bus.sync_unit_unused",
             [](BusConfig& c) {
                 c.sync_units = {{"io", 2}};
             }},
        Case{"bus.sm_watchdog",  // 2 ms are two cycles, but half a period of its unit
             [](BusConfig& c) {
                 c.slaves[1].sync_unit = "io";
                 c.slaves[1].sm_watchdog = 2ms;
                 c.sync_units = {{"io", 4}};
             }},
        Case{"bus.no_name", [](BusConfig& c) { c.slaves[0].name.clear(); }},
        Case{"bus.duplicate_name", [](BusConfig& c) { c.slaves[1].name = c.slaves[0].name; }},
        Case{"bus.place", [](BusConfig& c) { c.slaves[0].alias = 3; }},
        Case{"bus.place", [](BusConfig& c) { c.slaves[0].position.reset(); }},
        Case{"bus.duplicate_position", [](BusConfig& c) { c.slaves[1].position = 0; }},
        Case{"bus.position", [](BusConfig& c) { c.slaves[1].position = 2; }},
        Case{"bus.no_device", [](BusConfig& c) { c.slaves[0].device.reset(); }},
        Case{"bus.dc_required", [](BusConfig& c) { c.slaves[0].dc = false; }},
        Case{"bus.dc_unsupported", [](BusConfig& c) { c.slaves[1].dc = true; }},
        Case{"bus.cycle_multiple", [](BusConfig& c) { c.cycle = 200us; }},
        Case{"bus.cycle_unknown",  // a multiple of 125 us, but none of those the drive knows
             [](BusConfig& c) {
                 auto device = std::make_shared<DeviceDescription>(*c.slaves[0].device);
                 device->dc.cycles = {500us, 2ms};
                 c.slaves[0].device = device;
             }},
        Case{"bus.cycle_too_short", [](BusConfig& c) { c.cycle = 100us; }},
        Case{"bus.sm_watchdog", [](BusConfig& c) { c.slaves[0].sm_watchdog = 1ms; }},
        Case{"bus.sm_watchdog", [](BusConfig& c) { c.slaves[0].sm_watchdog = 7s; }},  // 65535 * 100 us = 6.5535 s
        Case{"bus.pdo_unknown", [](BusConfig& c) { c.slaves[0].rx.assigned = {{0x1777, false, {}}}; }},
        Case{"bus.pdo_too_many", [](BusConfig& c) { c.slaves[0].rx.assigned = {{0x1701, true, {}}, {0x1702, true, {}}}; }},
        Case{
            "bus.pdo_fixed",
            [](BusConfig& c) {
                c.slaves[0].rx.assigned = {{0x1701, true, {{0x6040, 0, 16}}}};
            }},
        Case{"bus.pdo_mappable", [](BusConfig& c) { c.slaves[0].rx.assigned = {{0x1600, false, {{0x6064, 0, 32}}}}; }},
        Case{"bus.pdo_bits", [](BusConfig& c) { c.slaves[0].rx.assigned = {{0x1600, false, {{0x6040, 0, 32}}}}; }},
        Case{"bus.pdo_entries",
             [](BusConfig& c) { c.slaves[0].rx.assigned = {{0x1600, false, std::vector<PdoEntry>(11, {0x6040, 0, 16})}}; }},
        Case{"bus.pdo_no_coe", [](BusConfig& c) { c.slaves[1].rx.assigned = {{0x1600, false, {}}}; }},
        Case{"bus.startup_no_coe", [](BusConfig& c) { c.slaves[1].startup = {quick_stop(1)}; }},
        Case{"bus.startup_range", [](BusConfig& c) { c.slaves[0].startup = {quick_stop(-1)}; }},
        Case{"bus.startup_range", [](BusConfig& c) { c.slaves[0].startup = {quick_stop(1'000'001)}; }},
        Case{"bus.startup_read_only", [](BusConfig& c) {
                 c.slaves[0].startup = {quick_stop(1)};
                 c.slaves[0].startup[0].index = 0x6041;
                 c.slaves[0].startup[0].type = DataType::U16;
             }}));

INSTANTIATE_TEST_SUITE_P(OfPlacesUnitsAndModules, BadBusConfig,
                         ::testing::Values(Case{"bus.place", [](BusConfig& c) { c.slaves[0].device_id = 3; }},
                                           Case{"bus.device_id",
                                                [](BusConfig& c) { c.slaves[0].position.reset(), c.slaves[0].device_id = 0; }},
                                           Case{"bus.duplicate_device_id",
                                                [](BusConfig& c) {
                                                    for (auto& slave : c.slaves) slave.position.reset(), slave.device_id = 7;
                                                }},
                                           Case{"bus.sync1", [](BusConfig& c) { c.slaves[0].sync1 = 1ms; }},
                                           Case{"bus.sync1", [](BusConfig& c) { c.slaves[1].sync1 = 0ms; }},
                                           Case{"bus.pdi_watchdog", [](BusConfig& c) { c.slaves[0].pdi_watchdog = 7s; }},
                                           Case{"bus.modules", [](BusConfig& c) {
                                                    c.slaves[0].modules = {{0, "csp"}};
                                                }}));

TEST(BusConfig, APositionBehindTheListedSlavesIsFineWhereOthersMayBeThere) {
    BusConfig config = good();
    config.slaves[1].position = 5;
    EXPECT_THAT(check(config), with_code("bus.position"));
    config.extra_slaves = ExtraSlaves::ignore;
    EXPECT_THAT(check(config), IsEmpty());
}

// Exchanged every eighth 1 ms cycle, 10 ms would trip at the first lost frame: 2 * 8 ms is the least.
TEST(BusConfig, TheWatchdogOfASlowUnitIsMeasuredByItsOwnRate) {
    BusConfig config = good();
    config.slaves[1].sync_unit = "slow";
    config.sync_units = {{"slow", 8}};
    config.slaves[1].sm_watchdog = 10ms;
    EXPECT_THAT(check(config), with_code("bus.sm_watchdog"));
    EXPECT_EQ(sm_watchdog(config, config.slaves[0]), 10ms);
    config.slaves[1].sm_watchdog = {};
    EXPECT_EQ(sm_watchdog(config, config.slaves[1]), 24ms);
    EXPECT_THAT(check(config), IsEmpty());
}

/// Two slots, TSVM's increments (manual 5.2.5): objects +800h, PDOs +40h.
std::shared_ptr<DeviceDescription> modular() {
    auto d = servo_description();
    d->rx_pdos.clear(), d->tx_pdos.clear(), d->rx_assigned.clear(), d->tx_assigned.clear();
    d->rx_rules.max_assigned = d->tx_rules.max_assigned = 6;
    d->slots = {
        2, 0x800, 0x40, false, {{"csp", 0x11, {{0x1600, true, {{0x6040, 0, 16}, {0x607A, 0, 32}}}}, {{0x1A00, true, {{0x6041, 0, 16}}}}}}};
    return d;
}

TEST(Modules, OfASlotAreMovedByItsIncrements) {
    const auto pdos = pdos_of(*modular(), std::vector<ModuleSelection>{{1, "csp"}, {0, "csp"}});
    EXPECT_EQ(pdos.rx_assigned, (std::vector<std::uint16_t>{0x1600, 0x1640}));
    EXPECT_EQ(pdos.tx_assigned, (std::vector<std::uint16_t>{0x1A00, 0x1A40}));
    ASSERT_EQ(pdos.rx.size(), 2u);
    EXPECT_EQ(pdos.rx[1].entries, (std::vector<PdoEntry>{{0x6840, 0, 16}, {0x687A, 0, 32}}));
}

TEST(Modules, AreCheckedAgainstTheDevice) {
    BusConfig config = good();
    config.slaves[0].device = modular();
    config.slaves[0].modules = {{0, "csp"}, {1, "csp"}};
    EXPECT_THAT(check(config), IsEmpty());
    config.slaves[0].modules = {{0, "csp"}, {0, "csp"}, {2, "csp"}, {1, "pp"}};
    const auto problems = check(config);
    EXPECT_THAT(problems, SizeIs(3));
    EXPECT_THAT(problems, Contains(Field(&Error::what, HasSubstr("there is no slot 2"))));
    EXPECT_THAT(problems, Contains(Field(&Error::what, HasSubstr("slot 0 holds two modules"))));
    EXPECT_THAT(problems, Contains(Field(&Error::what, HasSubstr("has no module 'pp'"))));
}

// SE-808X 3.1.2: the factory maps 16 of the 32 bits of 60FDh. What the maker mapped may stay; another part of an object may not.
TEST(BusConfig, FewerBitsThanAnObjectHasAreTakenOnlyWhereTheFactoryMapsThem) {
    BusConfig config = good();
    auto device = std::make_shared<DeviceDescription>(*config.slaves[0].device);
    ObjectEntry inputs;
    inputs.index = 0x60FD;
    inputs.name = "digital inputs";
    inputs.type = DataType::U32;
    inputs.access = Access::ro;
    inputs.mappable = Mappable::tx;
    device->objects.push_back(inputs);
    device->tx_pdos.push_back({0x1A02, false, {{0x60FD, 0, 16}}});
    config.slaves[0].device = device;

    config.slaves[0].tx.assigned = {{0x1A02, false, {{0x60FD, 0, 16}}}};
    EXPECT_THAT(check(config), IsEmpty());
    config.slaves[0].tx.assigned = {{0x1A02, false, {{0x60FD, 0, 8}}}};
    EXPECT_THAT(check(config), with_code("bus.pdo_bits"));
    config.slaves[0].tx.assigned = {{0x1A02, false, {{0x60FD, 0, 64}}}};
    EXPECT_THAT(check(config), with_code("bus.pdo_bits"));
}

TEST(BusConfig, AllProblemsAreReportedAtOnceAndNameTheSlave) {
    BusConfig config = good();
    config.slaves[0].dc = false;
    config.slaves[1].dc = true;
    const auto problems = check(config);
    ASSERT_THAT(problems, SizeIs(2));
    EXPECT_THAT(problems[0].text(), HasSubstr("slave 'a'"));
    EXPECT_THAT(problems[1].text(), HasSubstr("slave 'b'"));
}

TEST(BusAlarms, HaveUniqueIdsInTheirRangeAndAllTexts) {
    std::set<AlarmId> ids;
    std::set<std::string_view> names;
    for (const auto& info : Master::alarms()) {
        EXPECT_EQ(info.id & 0xF000, 0x1000);
        EXPECT_TRUE(ids.insert(info.id).second);
        EXPECT_TRUE(names.insert(info.name).second);
        for (const auto text : {info.english, info.chinese, info.cause, info.remedy}) EXPECT_FALSE(text.empty()) << info.name;
    }
}

TEST(BusAlarms, LosingProcessDataStopsTheMachine) {
    for (const AlarmId id : {id(BusAlarm::frames_lost), id(BusAlarm::working_counter_wrong), id(BusAlarm::slave_lost),
                             id(BusAlarm::slave_left_op), id(BusAlarm::link_down)})
        EXPECT_EQ(find_alarm(bus_alarms, id)->reaction, Reaction::stop_machine);
}

}  // namespace
}  // namespace taktwerk::ecat::test
