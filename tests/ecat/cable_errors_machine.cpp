// A bad cable is told while everybody still works: the right cable, by both its ends, nobody else, and not what was pulled by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ecat/alarms.hpp"
#include "ecat/bringup/cable_watch.hpp"
#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Cables : ::testing::Test {
    std::optional<TestBus> bus;
    void start(const char* devices) {
        bus.emplace(devices);
        ASSERT_TRUE(bus->bring_up()) << bus->why();
        bus->run_for(200ms);
        ASSERT_THAT(bus->faults(), IsEmpty());
    }
    /// Single frames are damaged on the cable before this slave: none of them is a fault of its own.
    void damage(std::size_t slave, int frames) {
        for (int i = 0; i < frames; ++i) {
            bus->network.disturb(bus->network.slave(slave), 1);
            bus->run_for(300ms);
            ASSERT_THAT(others(), IsEmpty());
        }
    }
    std::vector<AlarmId> others() {
        std::vector<AlarmId> all;
        for (const auto& fact : bus->facts())
            if (fact.id != id(BusAlarm::cable_errors) && fact.id != id(BusAlarm::cable_loses_link)) all.push_back(fact.id);
        return all;
    }
    void expect_told(BusAlarm alarm, std::size_t slave, double count) {
        ASSERT_THAT(bus->faults(), ElementsAre(id(alarm))) << "one cable, one alarm";
        const auto fact = bus->facts().front();
        EXPECT_EQ(fact.source, AlarmSource::slave);
        EXPECT_EQ(fact.index, slave);
        EXPECT_EQ(fact.a, count);
        EXPECT_EQ(fact.b, 0) << "the port towards the master";
        EXPECT_THAT(bus->master->detail(fact), AllOf(HasSubstr("the cable between"), HasSubstr(bus->config.slaves[slave - 1].name),
                                                     HasSubstr(bus->config.slaves[slave].name)));
    }
};

TEST_F(Cables, DamagedFramesNameTheirCableAndNobodyElse) {
    start("ststst");
    damage(3, 2);
    bus->run_for(15s);
    EXPECT_THAT(bus->faults(), IsEmpty()) << "two may be a contactor that switched";
    damage(3, 3);
    bus->run_for(10s);
    expect_told(BusAlarm::cable_errors, 3, 5);
    bus->run_for(65s);
    EXPECT_THAT(bus->faults(), IsEmpty()) << "a minute without any";
    EXPECT_EQ(bus->master->statistics().frames_lost, 5u);
}

// The slaves behind it count forwarded errors by the hundred.
TEST_F(Cables, ABadCableIsToldForAsLongAsItIsBad) {
    start("sstt");
    for (int minute = 0; minute < 3; ++minute) {
        damage(1, 120);  // 36 s
        expect_told(BusAlarm::cable_errors, 1, bus->facts().empty() ? 0 : bus->facts().front().a);
        EXPECT_GE(bus->facts().front().a, 80) << "the counters were cleared before they stood still at 255";
    }
}

TEST_F(Cables, APlugThatLosesItsLinkIsToldOnceWithBothEnds) {
    start("stst");
    for (int i = 0; i < 2; ++i) {
        bus->network.set_cable(2, false);
        bus->network.set_cable(2, true);
        bus->run_for(500ms);
        ASSERT_THAT(others(), IsEmpty()) << "no frame was on it";
    }
    bus->run_for(6s);
    expect_told(BusAlarm::cable_loses_link, 2, 2);
}

// What has an alarm of its own is not told again for a minute after it is mended.
TEST_F(Cables, ACableThatWasPulledAndASlaveThatLostPowerAreNotBad) {
    start("stst");
    bus->run_for(20s);
    bus->network.set_cable(2, false);
    ASSERT_TRUE(bus->run_until([&] { return !others().empty(); }, 1s));
    bus->run_for(3s);
    bus->network.set_cable(2, true);
    ASSERT_TRUE(bus->run_until([&] { return bus->faults().empty(); }, 10s)) << bus->why();
    for (int i = 0; i < 300; ++i) {
        bus->run_for(100ms);
        ASSERT_THAT(bus->faults(), IsEmpty()) << "after " << i;
    }
    bus->network.set_power(1, false);
    ASSERT_TRUE(bus->run_until([&] { return !others().empty(); }, 1s));
    bus->run_for(3s);
    bus->network.set_power(1, true);
    ASSERT_TRUE(bus->run_until([&] { return bus->faults().empty(); }, 20s)) << bus->why();
    for (int i = 0; i < 300; ++i) {
        bus->run_for(100ms);
        ASSERT_THAT(bus->faults(), IsEmpty()) << "after " << i;
    }
    damage(1, 4);
    bus->run_for(6s);
    expect_told(BusAlarm::cable_errors, 1, 4);
}

TEST(CableHistory, CountsWhatRoseAndForgetsItAfterAMinute) {
    CableHistory history;
    SlaveCounters counters;
    counters.ports[1] = {.invalid_frames = 50, .rx_errors = 40, .forwarded_errors = 0, .lost_links = 7};
    history.add(counters);
    EXPECT_EQ(history.lately(1), (CableRise{0, 0})) << "what was before nobody knows";
    counters.ports[1].invalid_frames = 54;
    counters.ports[1].lost_links = 8;
    history.add(counters);
    EXPECT_EQ(history.lately(1), (CableRise{1, 4}));
    counters.ports[1].invalid_frames = 64;
    counters.ports[1].forwarded_errors = 10;
    history.add(counters);
    EXPECT_EQ(history.lately(1), (CableRise{1, 4})) << "those came from further up";
    counters = {};
    history.add(counters);
    EXPECT_EQ(history.lately(1), (CableRise{1, 4})) << "the slave began anew";
    for (std::size_t i = 0; i < CableHistory::looks - 3; ++i) history.add(counters);
    EXPECT_EQ(history.lately(1), (CableRise{1, 4}));
    history.add(counters);
    EXPECT_EQ(history.lately(1), (CableRise{0, 0}));
    counters.ports[0].lost_links = 200;
    EXPECT_FALSE(history.full());
    history.add(counters);
    EXPECT_TRUE(history.full());
    history.forget_base();
    EXPECT_FALSE(history.full());
}

}  // namespace
}  // namespace taktwerk::ecat::test
