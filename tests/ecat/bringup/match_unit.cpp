#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ecat/bringup/scan.hpp"
#include "ecat/bringup/slave_setup.hpp"
#include "ecat/bringup/watchdogs.hpp"

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

std::shared_ptr<const DeviceDescription> device(std::uint32_t product) {
    auto d = std::make_shared<DeviceDescription>();
    d->name = "dev";
    d->identity = {1, product, 7, 0};
    return d;
}

FoundSlave found(std::uint16_t position, std::uint32_t product, std::uint16_t alias = 0) {
    FoundSlave f;
    f.position = position;
    f.station = station_at(position);
    f.identity = {1, product, 9, 0};
    f.alias = alias;
    return f;
}

SlaveConfig wanted(const char* name, std::uint32_t product) {
    SlaveConfig s;
    s.name = name;
    s.device = device(product);
    return s;
}

// Configured y (alias 5), x (position 0); on the cable x, y. Slaves come out in the order of the configuration.
TEST(Match, ByAliasAndByPositionInConfigurationOrder) {
    BusConfig config;
    config.slaves = {wanted("y", 20), wanted("x", 10)};
    config.slaves[0].alias = 5;
    config.slaves[1].position = 0;
    std::vector<std::unique_ptr<BusSlave>> slaves;
    ASSERT_TRUE(match(config, {found(0, 10), found(1, 20, 5)}, slaves));
    EXPECT_EQ(slaves[0]->found.station, 0x1002);
    EXPECT_EQ(slaves[0]->subject, "slave 1 'y' (dev)");
    EXPECT_EQ(slaves[1]->found.station, 0x1001);
}

TEST(Match, OneSlaveCannotStandForTwo) {
    BusConfig config;
    config.slaves = {wanted("x", 10), wanted("y", 10)};
    config.slaves[0].position = 0;
    config.slaves[1].alias = 5;
    std::vector<std::unique_ptr<BusSlave>> slaves;
    EXPECT_EQ(match(config, {found(0, 10, 5), found(1, 10)}, slaves).error().code, "bus.ambiguous");
}

TEST(Identity, RevisionCountsOnlyWhereItIsAskedFor) {
    auto d = *device(10);
    EXPECT_TRUE(check_identity("s", d, {1, 10, 99, 5}));
    d.revision_rule = RevisionRule::exact;
    const auto refused = check_identity("s", d, {1, 10, 99, 5});
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().what, HasSubstr("expected vendor 00000001h product 0000000Ah revision 00000007h"));
}

TEST(Identity, AtLeastTakesTheDescribedRevisionAndLaterOnes) {
    auto d = *device(10);
    d.revision_rule = RevisionRule::at_least;
    EXPECT_TRUE(check_identity("s", d, {1, 10, 7, 0}));
    EXPECT_TRUE(check_identity("s", d, {1, 10, 8, 0}));
    EXPECT_FALSE(check_identity("s", d, {1, 10, 6, 0}));
}

TEST(Identity, ASlavesOwnRuleIsTakenInsteadOfTheDescriptions) {
    auto slave = wanted("x", 10);
    EXPECT_TRUE(check_identity("s", slave, {1, 10, 6, 0}));
    slave.revision_rule = RevisionRule::exact;
    EXPECT_FALSE(check_identity("s", slave, {1, 10, 6, 0}));
    EXPECT_TRUE(check_identity("s", slave, {1, 10, 7, 0}));
}

TEST(Match, ByDeviceId) {
    BusConfig config;
    config.slaves = {wanted("x", 10)};
    config.slaves[0].device_id = 9;
    config.extra_slaves = ExtraSlaves::ignore;
    auto on_cable = std::vector{found(0, 10), found(1, 10)};
    std::vector<std::unique_ptr<BusSlave>> slaves;

    const auto none = match(config, on_cable, slaves);
    EXPECT_EQ(none.error().code, "bus.missing_slave");
    EXPECT_THAT(none.error().what, HasSubstr("device id 9"));

    on_cable[1].device_id = 9;
    ASSERT_TRUE(match(config, on_cable, slaves));
    EXPECT_EQ(slaves[0]->found.position, 1);

    on_cable[0].device_id = 9;
    const auto twice = match(config, on_cable, slaves);
    EXPECT_EQ(twice.error().code, "bus.duplicate_device_id");
    EXPECT_THAT(twice.error().what, HasSubstr("positions 0 and 1"));
}

TEST(Match, AnAliasThatIsWrittenButNotLoadedIsNamed) {
    BusConfig config;
    config.slaves = {wanted("x", 10)};
    config.slaves[0].alias = 5;
    auto on_cable = std::vector{found(0, 10, 4)};
    on_cable[0].sii.alias = 5;
    std::vector<std::unique_ptr<BusSlave>> slaves;
    const auto missing = match(config, on_cable, slaves);
    EXPECT_THAT(missing.error().what, HasSubstr("the EEPROM of slave 0 holds this alias, it was not loaded yet"));
    EXPECT_THAT(missing.error().what, HasSubstr("found: 4 at position 0"));
}

// a b c are configured, the cable has c a b: nobody is missing.
TEST(Match, SlavesInAnotherOrderAreToldWhereTheyAre) {
    BusConfig config;
    config.slaves = {wanted("a", 10), wanted("b", 20), wanted("c", 30)};
    for (std::uint16_t i = 0; i < 3; ++i) config.slaves[i].position = i;
    std::vector<std::unique_ptr<BusSlave>> slaves;
    const auto wrong = match(config, {found(0, 30), found(1, 10), found(2, 20)}, slaves);
    EXPECT_EQ(wrong.error().code, "bus.wrong_identity");
    EXPECT_THAT(wrong.error().remedy, HasSubstr("in another order: the cable fits 'a' at 1, 'b' at 2, 'c' at 0"));
}

BusConfig line_of(std::initializer_list<std::uint32_t> products) {
    BusConfig config;
    for (const auto product : products) {
        config.slaves.push_back(wanted("x", product));
        config.slaves.back().name = std::string(1, static_cast<char>('a' + config.slaves.size() - 1));
        config.slaves.back().position = static_cast<std::uint16_t>(config.slaves.size() - 1);
    }
    return config;
}

std::vector<FoundSlave> cable_of(std::initializer_list<std::uint32_t> products) {
    std::vector<FoundSlave> all;
    for (const auto product : products) all.push_back(found(static_cast<std::uint16_t>(all.size()), product));
    return all;
}

Error refusal_of(const BusConfig& config, const std::vector<FoundSlave>& there) {
    std::vector<std::unique_ptr<BusSlave>> slaves;
    const auto matched = match(config, there, slaves);
    return matched ? Error{} : matched.error();
}

// Left out in the middle: those behind it stand one place nearer, and none of them is a wrong device.
TEST(Match, ASlaveLeftOutInTheMiddleIsNamedAndNobodyBehindIt) {
    const auto error = refusal_of(line_of({10, 20, 30, 40}), cable_of({10, 30, 40}));
    EXPECT_EQ(error.code, "bus.missing_slave");
    EXPECT_EQ(error.subject, "slave 'b' (dev)");
    EXPECT_THAT(error.what, HasSubstr("3 of 4 configured slaves"));
    EXPECT_THAT(error.remedy, HasSubstr("between slave 0 and slave 1"));
    EXPECT_EQ(refusal_of(line_of({10, 20, 30}), cable_of({20, 30})).subject, "slave 'a' (dev)") << "the first";
    EXPECT_EQ(refusal_of(line_of({10, 20, 30}), cable_of({10, 20})).subject, "slave 'c' (dev)") << "the last";
}

// a and b are alike, and one of them is gone: which, the bus cannot tell.
TEST(Match, OfSlavesThatAreAlikeNoneIsPickedOut) {
    const auto error = refusal_of(line_of({5, 10, 10, 30}), cable_of({5, 10, 30}));
    EXPECT_EQ(error.code, "bus.missing_slave");
    EXPECT_EQ(error.subject, "bus");
    EXPECT_THAT(error.what, HasSubstr("1 of slave 'b' (dev), slave 'c' (dev) not on the cable"));
}

TEST(Match, SeveralLeftOutInARowAreNamed) {
    const auto error = refusal_of(line_of({10, 20, 30, 40}), cable_of({10, 40}));
    EXPECT_EQ(error.subject, "bus");
    EXPECT_THAT(error.what, HasSubstr("slave 'b' (dev), slave 'c' (dev) are not on the cable"));
}

TEST(Match, ASlaveTooManyInTheMiddleIsNamedAndNobodyBehindIt) {
    const auto error = refusal_of(line_of({10, 20, 30}), cable_of({10, 99, 20, 30}));
    EXPECT_EQ(error.code, "bus.unexpected_slave");
    EXPECT_EQ(error.subject, "slave 1");
    EXPECT_THAT(error.what, HasSubstr("product 00000063h"));
    EXPECT_EQ(refusal_of(line_of({10, 20}), cable_of({99, 10, 20})).subject, "slave 0") << "in front of all";
}

// One missing and another one wrong is no shift: the plain comparison says what it sees first.
TEST(Match, WhatIsNoShiftIsComparedPlaceByPlace) {
    const auto error = refusal_of(line_of({10, 20, 30, 40}), cable_of({10, 99, 40}));
    EXPECT_EQ(error.code, "bus.wrong_identity");
    EXPECT_EQ(error.subject, "slave 1 'b' (dev)");
}

TEST(Match, AForeignDeviceIsNoQuestionOfOrder) {
    BusConfig config;
    config.slaves = {wanted("a", 10), wanted("b", 20)};
    for (std::uint16_t i = 0; i < 2; ++i) config.slaves[i].position = i;
    std::vector<std::unique_ptr<BusSlave>> slaves;
    const auto wrong = match(config, {found(0, 99), found(1, 20)}, slaves);
    EXPECT_EQ(wrong.error().code, "bus.wrong_identity");
    EXPECT_THAT(wrong.error().remedy, ::testing::Not(HasSubstr("order: ")));
}

// Three cycles, at least 10 ms, unless configured.
TEST(SmWatchdog, FollowsTheCycle) {
    BusConfig bus;
    SlaveConfig slave;
    bus.cycle = 1ms;
    EXPECT_EQ(sm_watchdog(bus, slave), 10ms);
    bus.cycle = 4ms;
    EXPECT_EQ(sm_watchdog(bus, slave), 12ms);
    slave.sm_watchdog = 50ms;
    EXPECT_EQ(sm_watchdog(bus, slave), 50ms);
}

// 100 us a tick, rounded up: never shorter than asked for.
TEST(SmWatchdog, IsCountedInTicks) {
    EXPECT_EQ(watchdog_ticks(10ms), 100);
    EXPECT_EQ(watchdog_ticks(10ms + 1ns), 101);
    EXPECT_EQ(watchdog_ticks(1min), 0xFFFF);
}

// A description that leaves open whom it means takes whoever stands in its place, and names nobody by it.
TEST(Match, WhoIsNotStatedIsTakenAndNotRecognised) {
    auto open = *device(10);
    EXPECT_TRUE(recognises(open, {1, 10, 9, 0}));
    EXPECT_FALSE(recognises(open, {1, 11, 9, 0}));
    open.stated.identity = false;
    EXPECT_TRUE(check_identity("", open, {1, 11, 9, 0}).ok());
    EXPECT_FALSE(recognises(open, {1, 10, 9, 0}));
    EXPECT_FALSE(recognises(open, {1, 11, 9, 0}));
}

}  // namespace
}  // namespace taktwerk::ecat
