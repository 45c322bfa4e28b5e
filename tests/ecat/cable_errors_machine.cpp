// A bad cable is told while everybody still works: the right cable, by both its ends, nobody else, and not what was pulled by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ecat/alarms.hpp"
#include "ecat/bringup/cable_watch.hpp"
#include "ecat/wire/frame.hpp"
#include "ecat/wire/registers.hpp"
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

/// Pulls a cable behind the frame with the process data, in front of the one that reads the counters of the slaves at its ends.
struct Scissors {
    Scissors(TestBus& its_bus, std::size_t its_place) : bus(its_bus), place(its_place) { bus.master->set_tap(&Scissors::tap, this); }
    static void tap(void* context, std::span<const std::byte> frame, Instant, bool outgoing) noexcept {
        auto& self = *static_cast<Scissors*>(context);
        if (!outgoing || self.cut) return;
        FrameReader reader{frame};
        while (const auto datagram = reader.next()) {
            if (datagram->command == Command::BRD && self.read_some) {
                self.bus.network.set_cable(self.place, false);
                self.cut = true;
                return;
            }
            if (datagram->command == Command::FPRD && datagram->address.ado() == reg::rx_errors) self.read_some = true;
        }
    }
    TestBus& bus;
    std::size_t place;
    bool read_some = false, cut = false;
};

// The look finds a lost link, and the cycle does not know of it yet.
TEST_F(Cables, ACableThatIsPulledWhileItsCountersAreReadIsNotBad) {
    start("ststst");  // four of them are asked at once: the last two in the cycle behind
    bus->run_for(2s);
    Scissors scissors{*bus, 5};
    ASSERT_TRUE(bus->run_until([&] { return scissors.cut; }, 2s));
    ASSERT_TRUE(bus->run_until([&] { return !others().empty(); }, 1s));
    bus->run_for(2s);
    bus->network.set_cable(5, true);
    ASSERT_TRUE(bus->run_until([&] { return others().empty(); }, 10s)) << bus->why();
    for (int i = 0; i < 100; ++i) {
        bus->run_for(100ms);
        ASSERT_THAT(bus->faults(), IsEmpty()) << "after " << i;
    }
    bus->master->set_tap(nullptr, nullptr);
}

// docs/troubles.md promises two seconds.
TEST_F(Cables, ABadCableIsNamedWithinTwoSeconds) {
    for (const int phase : {0, 170, 340, 510, 680, 850}) {
        start("stststststst");
        bus->run_for(phase * 1ms);
        for (int i = 0; i < 3; ++i) {
            bus->network.disturb(bus->network.slave(7), 1);
            bus->run_for(20ms);
        }
        ASSERT_TRUE(bus->run_until([&] { return !bus->faults().empty(); }, 1940ms)) << "phase " << phase;
        expect_told(BusAlarm::cable_errors, 7, 3);
    }
}

/// A ring that breaks and heals is told as that: nobody's cable is bad, however short it was and whatever moment it came at.
struct RingCables : ::testing::Test {
    std::optional<TestBus> bus;
    void start(const char* devices) {
        bus.emplace(devices);
        bus->make_ring();
        ASSERT_TRUE(bus->bring_up()) << bus->why();
        bus->run_for(200ms);
        ASSERT_THAT(bus->faults(), IsEmpty());
    }
    bool a_cable_is_told() {
        const auto told = bus->faults();
        return std::any_of(told.begin(), told.end(),
                           [](AlarmId one) { return one == id(BusAlarm::cable_errors) || one == id(BusAlarm::cable_loses_link); });
    }
    void expect_no_cable_told(Duration length, const std::string& when) {
        for (const Instant end = bus->now + length; bus->now < end;) {
            bus->cycle_once();
            ASSERT_FALSE(a_cable_is_told()) << when;
        }
    }
    /// Between two frames.
    void later(Duration time) { bus->network.advance(bus->now + time); }
};

TEST_F(RingCables, ABreakThatHealsAtAnyMomentIsNoBadCable) {
    start("ststst");
    for (int i = 0; i < 120; ++i) {
        const auto place = static_cast<std::size_t>(i % 7);
        const Duration pause = (37 + 13 * (i % 5)) * 1ms, away = (2 + 11 * (i % 4)) * 1ms;
        expect_no_cable_told(pause, "before break " + std::to_string(i));
        later((i % 9) * 100us);
        bus->set_ring_cable(place, false);
        expect_no_cable_told(away, "during break " + std::to_string(i));
        later((i % 7) * 100us);
        bus->set_ring_cable(place, true);
    }
    expect_no_cable_told(3s, "afterwards");
    EXPECT_THAT(bus->faults(), IsEmpty());
}

// Too short for any frame to meet it: its neighbours count a lost link, and who it was says so itself.
TEST_F(RingCables, ASlaveThatBeginsAnewBetweenTwoFramesMakesNoCableBad) {
    start("stssst");
    for (int i = 0; i < 12; ++i) {
        const std::size_t slave = 1 + static_cast<std::size_t>(i % 4);
        bus->network.set_power(slave, false);
        bus->network.set_power(slave, true);
        expect_no_cable_told((1310 + 170 * (i % 3)) * 1ms, "slave " + std::to_string(slave));
    }
    ASSERT_TRUE(bus->run_until([&] { return bus->faults().empty(); }, 20s)) << bus->why();
}

// Tried and out again before a frame has met it, while the ring is said to be broken there.
TEST_F(RingCables, APlugThatIsTriedInABrokenRingIsNoBadCable) {
    start("ststst");
    bus->set_ring_cable(3, false);
    bus->run_for(700ms);
    bus->set_ring_cable(3, true);
    bus->set_ring_cable(3, false);
    expect_no_cable_told(390ms, "tried");
    bus->set_ring_cable(3, true);
    expect_no_cable_told(3s, "healed");
}

// What no frame has met and no slave lost is a loose plug: that is told, by its cable.
TEST_F(RingCables, ALinkThatIsLostBetweenTwoFramesIsTold) {
    start("ststst");
    bus->set_ring_cable(3, false);
    bus->set_ring_cable(3, true);
    ASSERT_TRUE(bus->run_until([&] { return a_cable_is_told(); }, 2s));
    ASSERT_THAT(bus->faults(), ElementsAre(id(BusAlarm::cable_loses_link)));
    EXPECT_EQ(bus->facts()[0].index, 3);
}

// A damaged frame in a ring is one that is lost on one way: the cable is told as in a line.
TEST_F(RingCables, ABadCableOfARingIsTold) {
    start("ststst");
    for (int i = 0; i < 6; ++i) {
        bus->network.disturb(bus->network.slave(4), 1);
        bus->run_for(100ms);
    }
    ASSERT_TRUE(bus->run_until([&] { return a_cable_is_told(); }, 1400ms));
    EXPECT_EQ(bus->facts()[0].id, id(BusAlarm::cable_errors));
    EXPECT_EQ(bus->facts()[0].index, 4);
}

TEST(CableHistory, CountsWhatRoseAndForgetsItAfterAMinute) {
    CableHistory history;
    SlaveCounters counters;
    Instant at{100s};
    counters.ports[1] = {.invalid_frames = 50, .rx_errors = 40, .forwarded_errors = 0, .lost_links = 7};
    history.add(counters, at);
    EXPECT_EQ(history.lately(1, at), (CableRise{0, 0})) << "what was before nobody knows";
    counters.ports[1].invalid_frames = 54;
    counters.ports[1].lost_links = 8;
    history.add(counters, at += 500ms);
    EXPECT_EQ(history.lately(1, at), (CableRise{1, 4}));
    counters.ports[1].invalid_frames = 64;
    counters.ports[1].forwarded_errors = 10;
    history.add(counters, at += 500ms);
    EXPECT_EQ(history.lately(1, at), (CableRise{1, 4})) << "those came from further up";
    counters = {};
    history.add(counters, at += 500ms);
    EXPECT_EQ(history.lately(1, at), (CableRise{1, 4})) << "the slave began anew";
    EXPECT_EQ(history.lately(1, Instant{159s}), (CableRise{1, 4}));
    EXPECT_EQ(history.lately(1, Instant{160s}), (CableRise{0, 0})) << "a minute after the five seconds in which it rose began";
    history.add(counters, Instant{162s});  // in the place of those five seconds
    EXPECT_EQ(history.lately(1, Instant{162s}), (CableRise{0, 0}));
    counters.ports[0].lost_links = 200;
    EXPECT_FALSE(history.full());
    history.add(counters, Instant{163s});
    EXPECT_TRUE(history.full());
    history.forget_base();
    EXPECT_FALSE(history.full());
}

// A link that was away while no frame came back is part of that alarm; frames that were damaged then were damaged.
TEST(CableHistory, ForgetsLostLinksAlone) {
    CableHistory history;
    SlaveCounters counters;
    history.add(counters, Instant{1s});
    counters.ports[0] = {.invalid_frames = 5, .rx_errors = 5, .forwarded_errors = 0, .lost_links = 1};
    history.forget_links();
    history.add(counters, Instant{2s});
    EXPECT_EQ(history.lately(0, Instant{2s}), (CableRise{0, 5}));
    counters.ports[0].lost_links = 3;
    history.add(counters, Instant{3s});
    EXPECT_EQ(history.lately(0, Instant{3s}), (CableRise{2, 5}));
    // More than a byte holds.
    for (int i = 0; i < 4; ++i) {
        counters.ports[0].invalid_frames = counters.ports[0].rx_errors = 0;
        history.forget_base();
        history.add(counters, Instant{4s});
        counters.ports[0].invalid_frames = counters.ports[0].rx_errors = 250;
        history.add(counters, Instant{4s});
    }
    EXPECT_EQ(history.lately(0, Instant{4s}), (CableRise{2, 1005}));
}

}  // namespace
}  // namespace taktwerk::ecat::test
