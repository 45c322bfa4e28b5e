#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ecat/bringup/scan.hpp"
#include "ecat/bringup/slave_setup.hpp"

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

}  // namespace
}  // namespace taktwerk::ecat
