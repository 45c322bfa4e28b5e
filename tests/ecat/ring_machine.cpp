// A bus with two interfaces: it comes up around a closed ring, a break anywhere takes nobody away, is named by both ends, and heals.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ecat/alarms.hpp"
#include "ecat/bringup/bus.hpp"
#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct RingBus : ::testing::Test {
    std::optional<TestBus> bus;
    void start(const char* devices, BehindBreak behind_break = BehindBreak::hand_time_on) {
        bus.emplace(devices);
        bus->make_ring(behind_break);
        ASSERT_TRUE(bus->bring_up()) << bus->why();
        bus->run_for(200ms);
        ASSERT_THAT(bus->faults(), IsEmpty());
    }
    [[nodiscard]] bool all_fresh() const {
        for (std::size_t i = 0; i < bus->config.slaves.size(); ++i)
            if (!bus->master->health(i).fresh) return false;
        return true;
    }
    /// Cycles in which some slave was not exchanged.
    std::size_t cycles_missed(Duration length) {
        std::size_t missed = 0;
        for (const Instant end = bus->now + length; bus->now < end;) {
            bus->cycle_once();
            missed += all_fresh() ? 0 : 1;
        }
        return missed;
    }
    std::string said(BusAlarm alarm) {
        for (const auto& fact : bus->facts())
            if (fact.id == id(alarm)) return bus->master->detail(fact);
        return "not said";
    }
};

TEST_F(RingBus, ComesUpAndRuns) {
    start("stsss");
    EXPECT_EQ(bus->master->statistics().ring.shape, RingShape::closed);
    EXPECT_EQ(cycles_missed(100ms), 0u);
}

// As on the same slaves in a line: the ring is measured as one.
TEST_F(RingBus, MeasuresTheDelaysOfALine) {
    start("stsss");
    TestBus line{"stsss"};
    ASSERT_TRUE(line.bring_up());
    for (std::size_t s = 0; s < 5; ++s) EXPECT_EQ(bus->master->bus().slaves[s]->dc_delay, line.master->bus().slaves[s]->dc_delay) << s;
    EXPECT_GT(line.master->bus().slaves[4]->dc_delay, 0u);
}

TEST_F(RingBus, ABreakAnywhereCostsTheFramesUnderWay) {
    start("stsssst");
    const std::size_t places = bus->config.slaves.size() + 1;
    for (std::size_t place = 0; place < places; ++place) {
        bus->set_ring_cable(place, false);
        EXPECT_LE(cycles_missed(50ms), 1u) << "break " << place;
        EXPECT_THAT(bus->faults(), ElementsAre(id(BusAlarm::ring_broken))) << "break " << place;
        bus->set_ring_cable(place, true);
        EXPECT_EQ(cycles_missed(50ms), 0u) << "healed " << place;
        EXPECT_THAT(bus->faults(), IsEmpty()) << "healed " << place;
    }
}

TEST_F(RingBus, ABreakIsNamedByBothEnds) {
    start("ststt");
    bus->set_ring_cable(3, false);
    bus->run_for(10ms);
    EXPECT_EQ(said(BusAlarm::ring_broken), "between slave 2 'c' (sv33-e) port 1 and slave 3 'd' (dio8) port 0");
    bus->set_ring_cable(3, true);
    bus->set_ring_cable(0, false);
    bus->run_for(20ms);
    EXPECT_EQ(said(BusAlarm::ring_broken), "between the first interface and slave 0 'a' (sv33-e) port 0");
    bus->set_ring_cable(0, true);
    bus->set_ring_cable(5, false);
    bus->run_for(20ms);
    EXPECT_EQ(said(BusAlarm::ring_broken), "between slave 4 'e' (dio8) port 1 and the second interface");
}

TEST_F(RingBus, ASlaveWithoutPowerTakesNobodyAlong) {
    start("ststss");
    bus->network.set_power(3, false);
    bus->run_for(300ms);
    EXPECT_THAT(bus->faults(), Contains(id(BusAlarm::slave_lost)));
    EXPECT_THAT(bus->faults(), Contains(id(BusAlarm::ring_broken)));
    EXPECT_THAT(said(BusAlarm::ring_broken), HasSubstr("between slave 2 'c' (sv33-e) and slave 4 'e' (sv33-e): who stands between"));
    for (const std::size_t other : {0u, 1u, 2u, 4u, 5u}) EXPECT_TRUE(bus->master->health(other).fresh) << other;
    bus->network.set_power(3, true);
    EXPECT_TRUE(bus->run_until([&] { return all_fresh() && bus->faults().empty(); }, 10s)) << bus->why();
}

// A slave that comes back while the ring is broken elsewhere is found by the place it had.
TEST_F(RingBus, ASlaveComesBackIntoABrokenRing) {
    for (const std::size_t place : {1u, 3u, 5u}) {
        start("ststss");
        bus->set_ring_cable(place, false);
        bus->run_for(50ms);
        for (const std::size_t gone : {0u, 5u}) {
            bus->network.set_power(gone, false);
            bus->run_for(300ms);
            bus->network.set_power(gone, true);
            EXPECT_TRUE(bus->run_until([&] { return all_fresh(); }, 10s)) << "slave " << gone << ", break " << place << ": " << bus->why();
        }
    }
}

// It serves again, and what its own register says of the time in which it did not is no difference.
TEST_F(RingBus, TheReferenceComesBackIntoTheRing) {
    start("ssss");
    for (std::size_t s = 0; s < 4; ++s) bus->network.slave(s).controller().set_clock_drift(s % 2 == 0 ? 40 : -40, bus->now);
    bus->network.set_power(0, false);
    bus->run_for(3s);
    bus->network.set_power(0, true);
    EXPECT_TRUE(bus->run_until([&] { return all_fresh() && bus->faults().empty(); }, 10s)) << bus->why();
    bus->run_for(5s);
    EXPECT_THAT(bus->faults(), IsEmpty());
}

// Whatever got lost on one side alone: nobody is silent for it.
TEST_F(RingBus, FramesThatGetLostOnOneSideAccuseNobody) {
    start("ststss");
    for (const bool broken : {false, true}) {
        if (broken) bus->set_ring_cable(3, false);
        for (int i = 0; i < 3000; ++i) {
            auto& faults = (i % 2 == 0 ? bus->transport : *bus->second).faults;
            if (i % 7 == 0) (i % 3 == 0 ? faults.drop_requests : faults.drop_answers) = 1;
            bus->cycle_once();
            for (const auto& fact : bus->facts()) ASSERT_NE(fact.source, AlarmSource::slave) << fact.id << " of slave " << fact.index;
        }
    }
}

TEST_F(RingBus, DoesNotStartWithABrokenRing) {
    for (std::size_t place = 1; place < 4; ++place) {
        TestBus broken{"ssss"};
        broken.make_ring();
        broken.set_ring_cable(place, false);
        EXPECT_FALSE(broken.bring_up());
        EXPECT_EQ(broken.master->failure().code, "bus.ring_broken");
        EXPECT_THAT(broken.why(), HasSubstr("between slave " + std::to_string(place - 1) + " and slave " + std::to_string(place)));
        broken.set_ring_cable(place, true);
        EXPECT_TRUE(broken.bring_up()) << broken.why();
    }
}

TEST_F(RingBus, DoesNotStartWithExchangedPlugs) {
    TestBus exchanged{"stss"};
    exchanged.make_ring();
    exchanged.ring = std::make_unique<RingTransport>(*exchanged.second, exchanged.transport, exchanged.config.cycle / 4);
    EXPECT_FALSE(exchanged.bring_up());
    EXPECT_EQ(exchanged.master->failure().code, "bus.ring_exchanged");
}

// Nothing is wrong with the motion then, but the next break would take slaves away.
TEST_F(RingBus, ASecondInterfaceThatSendsNothingIsSaidBeforeItIsNeeded) {
    start("stsss");
    bus->second->faults.drop_requests = 1'000'000;
    EXPECT_EQ(cycles_missed(200ms), 0u);
    EXPECT_THAT(bus->faults(), ElementsAre(id(BusAlarm::ring_broken)));
    EXPECT_THAT(said(BusAlarm::ring_broken), HasSubstr("nothing comes back of what the second interface sends"));
    bus->second->faults.drop_requests = 0;
    EXPECT_EQ(cycles_missed(20ms), 0u);
    EXPECT_THAT(bus->faults(), IsEmpty());
}

// --- clocks behind the break ------------------------------------------------------------------------------------------------------

std::int64_t clock_error(TestBus& bus, std::size_t slave, std::size_t reference) {
    auto& controller = bus.network.slave(slave).controller();
    return controller.clock().system(bus.now) - bus.network.slave(reference).controller().clock().system(bus.now);
}

/// The quartzes change their speed when the ring is broken: what a clock has learnt before does not carry it.
std::int64_t worst_clock_behind(TestBus& bus, std::size_t place) {
    for (std::size_t s = 0; s < 6; ++s) bus.network.slave(s).controller().set_clock_drift(s % 2 == 0 ? 40 : -40, bus.now);
    bus.run_for(2s);
    bus.set_ring_cable(place, false);
    for (std::size_t s = 0; s < 6; ++s) bus.network.slave(s).controller().set_clock_drift(s % 2 == 0 ? 20 : -30, bus.now);
    std::int64_t worst = 0;
    for (int i = 0; i < 3000; ++i) {
        bus.cycle_once();
        for (std::size_t s = place; s < 6; ++s) worst = std::max(worst, std::abs(clock_error(bus, s, 0)));
    }
    return worst;
}

TEST_F(RingBus, TimeIsHandedOnBehindABreak) {
    constexpr std::int64_t drive_supervises = 3000;  // ns, SV33-E P0A.32
    for (std::size_t place = 1; place < 6; ++place) {
        start("ssssss");
        EXPECT_LT(worst_clock_behind(*bus, place), drive_supervises) << "break " << place;
        EXPECT_THAT(bus->faults(), ElementsAre(id(BusAlarm::ring_broken)));
        bus->set_ring_cable(place, true);
        bus->run_for(1s);
        for (std::size_t s = 1; s < 6; ++s) EXPECT_LT(std::abs(clock_error(*bus, s, 0)), 200) << s;
    }
}

// Slaves without power are a break, too: the next slave behind it stands further away.
TEST_F(RingBus, TimeIsHandedOnPastSlavesWithoutPower) {
    constexpr std::int64_t drive_supervises = 3000;  // ns, SV33-E P0A.32
    start("ssssssssss");
    bus->run_for(2s);
    for (const std::size_t off : {2u, 3u, 4u, 5u, 6u, 7u}) bus->network.set_power(off, false);
    bus->run_for(10ms);
    std::int64_t worst = 0;
    for (int i = 0; i < 2000; ++i) {
        bus->cycle_once();
        for (const std::size_t s : {8u, 9u}) worst = std::max(worst, std::abs(clock_error(*bus, s, 0)));
    }
    EXPECT_LT(worst, drive_supervises);
}

// 10 and 20 ppm are 30 and 60 us in three seconds.
TEST_F(RingBus, WithoutThatTheClocksBehindABreakRunAway) {
    start("ssssss", BehindBreak::ramp_down);
    EXPECT_GT(worst_clock_behind(*bus, 3), 20'000);
}

TEST_F(RingBus, ClocksBehindABreakAreUnsynchronisedWhereThatIsConfigured) {
    start("sstss", BehindBreak::ramp_down);
    bus->set_ring_cable(2, false);
    bus->run_for(20ms);
    EXPECT_THAT(bus->faults(),
                ElementsAre(id(BusAlarm::ring_broken), id(BusAlarm::cut_off_from_reference), id(BusAlarm::cut_off_from_reference)))
        << "the two drives behind it, not the terminal";
    EXPECT_EQ(cycles_missed(100ms), 0u);
    bus->set_ring_cable(2, true);
    bus->run_for(20ms);
    EXPECT_THAT(bus->faults(), IsEmpty());
}

// In front of the first slave nobody is cut off from anybody.
TEST_F(RingBus, ABreakInFrontOfTheReferenceCutsNoClockOff) {
    for (const auto behind_break : {BehindBreak::ramp_down, BehindBreak::hand_time_on})
        for (const std::size_t place : {0u, 4u}) {
            start("ssss", behind_break);
            bus->set_ring_cable(place, false);
            bus->run_for(3s);
            EXPECT_THAT(bus->faults(), ElementsAre(id(BusAlarm::ring_broken))) << place;
            for (std::size_t s = 1; s < 4; ++s) EXPECT_LT(std::abs(clock_error(*bus, s, 0)), 200) << s;
            EXPECT_EQ(bus->master->statistics().dc_lock, DcLock::locked);
        }
}

}  // namespace
}  // namespace taktwerk::ecat::test
