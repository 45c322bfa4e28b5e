// Trees of simulated slaves: order of processing, DL status, loops under the master's control, receive times, circulating
// frames. Source: ETG.1000.3 (ports 0-3-1-2), ETG.1000.4 (0101h, 0110h, 0900h). Delays by hand from LineTiming: 600 ns through
// the processing unit, 560 ns past it, 50 ns of cable.

#include <gmock/gmock.h>

#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

using testing::ElementsAre;

constexpr std::uint16_t dl_control = 0x0100, dl_control_loops = 0x0101, dl_status = 0x0110;

//   master -- 0[a]1 -- 0[b]1 -- 0[d]
//                        3
//                        |
//                       0[c]
struct Tree : testing::Test {
    Tree() {
        a = &bus.add_drive({.name = "a"}, with_dc());
        b = &bus.add_drive({.name = "b"}, with_dc());
        d = &bus.add_drive({.name = "d"}, with_dc());
        c = &bus.network.add_behind(*b, 3, std::make_shared<const DeviceDescription>(with_dc()), std::make_unique<RecordingModel>(),
                                    {.name = "c"});
    }
    static DeviceDescription with_dc() {
        auto description = small_drive();
        description.dc.supported = true;
        return description;
    }
    std::vector<std::string> order() {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < bus.network.size(); ++i) names.push_back(bus.network.slave(i).options().name);
        return names;
    }
    std::uint16_t count() { return bus.send(Command::BRD, Address::physical(0, 0), Bytes(1)).wkc; }
    std::uint8_t lost_links(std::uint16_t position, unsigned port) {
        return bus.value<std::uint8_t>(position, static_cast<std::uint16_t>(0x0310 + port));
    }
    BusProbe bus;
    SimSlave *a = nullptr, *b = nullptr, *c = nullptr, *d = nullptr;
};

TEST_F(Tree, PositionsFollowTheOrderOfProcessing) {
    EXPECT_THAT(order(), ElementsAre("a", "b", "c", "d")) << "c was added last; the frame takes port 3 before port 1";
    EXPECT_EQ(bus.network.position(*d), 3u);

    bus.write(2, 0x0010, le<std::uint16_t>(0x1003));
    EXPECT_EQ(c->controller().station_address(), 0x1003);
}

// By hand: link 4+p, loop closed 8+2p, signal 9+2p; bit 0: EEPROM loaded, bit 1: PDI watchdog fed.
TEST_F(Tree, DlStatusShowsEveryPort) {
    EXPECT_EQ(bus.value<std::uint16_t>(0, dl_status), 0x5A33);  // ports 0 and 1
    EXPECT_EQ(bus.value<std::uint16_t>(1, dl_status), 0x9AB3);  // ports 0, 1 and 3; port 2 closed
    EXPECT_EQ(bus.value<std::uint16_t>(2, dl_status), 0x5613);  // port 0
    EXPECT_EQ(bus.value<std::uint8_t>(1, 0x0007), 0xCF) << "sockets 0, 1 and 3";
}

TEST_F(Tree, ReceiveTimesAreTakenAtEveryOpenPort) {
    bus.wait(1ms);
    ASSERT_EQ(bus.send(Command::BWR, Address::physical(0, 0x0900), Bytes(4)).wkc, 4);
    const auto port = [&](std::uint16_t position, unsigned p) {
        return bus.value<std::uint32_t>(position, static_cast<std::uint16_t>(0x0900 + 4 * p)) - 1'000'000u;
    };

    // a: 50. b: + 600 + 50 = 700. Out at port 3, c at + 600 + 50 = 1350, back at b's port 3 at + 600 + 50 = 2000;
    // past the unit to port 1: d at + 560 + 50 = 2610, back at 2610 + 600 + 50 = 3260; out: a's port 1 at + 560 + 50 = 3870.
    EXPECT_EQ(port(0, 0), 50u);
    EXPECT_EQ(port(1, 0), 700u);
    EXPECT_EQ(port(2, 0), 1350u);
    EXPECT_EQ(port(1, 3), 2000u);
    EXPECT_EQ(port(3, 0), 2610u);
    EXPECT_EQ(port(1, 1), 3260u);
    EXPECT_EQ(port(0, 1), 3870u);
    EXPECT_EQ(*bus.flight, 3870ns + 560ns + 50ns);
}

TEST_F(Tree, CablesHaveTheirOwnLength) {
    bus.network.set_cable_delay(*c, cable_delay(100));
    bus.read(0, 0, 1);
    EXPECT_EQ(cable_delay(100), 500ns);
    EXPECT_EQ(*bus.flight, 3870ns + 560ns + 50ns + 2 * 450ns);

    bus.network.set_delays(*c, {1000ns, 900ns});
    bus.read(0, 0, 1);
    EXPECT_EQ(*bus.flight, 3870ns + 560ns + 50ns + 2 * 450ns + 400ns);
}

TEST_F(Tree, APulledCableTakesAwayOnlyWhatIsBehindIt) {
    bus.network.set_cable(*c, false);
    EXPECT_EQ(count(), 3);
    EXPECT_EQ(bus.value<std::uint16_t>(1, dl_status), 0x5A33);
    EXPECT_EQ(lost_links(1, 3), 1);
    EXPECT_EQ(lost_links(1, 1), 0);

    bus.network.set_cable(*c, true);
    EXPECT_EQ(count(), 4);
    bus.network.set_cable(*b, false);
    EXPECT_EQ(count(), 1) << "b, c and d are gone";
}

TEST_F(Tree, ASlaveWithoutPowerHidesItsBranchesAndItsNeighboursLoseTheLink) {
    bus.network.set_power(*b, false);
    EXPECT_EQ(count(), 1);

    bus.network.set_power(*b, true);
    EXPECT_EQ(count(), 4);
    EXPECT_EQ(lost_links(0, 1), 1);
    EXPECT_EQ(lost_links(1, 1), 0) << "it started anew";
    EXPECT_EQ(lost_links(3, 0), 1) << "d had power all the time";
}

TEST_F(Tree, LostLinksAreCountedUpTo255AndClearedByAWrite) {
    for (int i = 0; i < 300; ++i) {
        bus.network.set_cable(*c, false);
        bus.network.set_cable(*c, true);
    }
    EXPECT_EQ(lost_links(1, 3), 255);

    bus.write(1, 0x0310, bytes({0}));
    EXPECT_EQ(lost_links(1, 3), 0);
}

TEST_F(Tree, AClosedLoopHidesABranchAndTheLinkStays) {
    bus.write(1, dl_control_loops, bytes({0xC0}));  // port 3: 11 closed

    EXPECT_EQ(count(), 3);
    EXPECT_EQ(bus.value<std::uint16_t>(1, dl_status), 0xDAB3) << "signal and link of port 3 are still there, bit 14 says closed";
    bus.write(1, dl_control_loops, bytes({0x00}));
    EXPECT_EQ(count(), 4);
}

TEST_F(Tree, APortHeldOpenTowardsNobodyLosesEveryFrameBehindThatPoint) {
    bus.write(3, dl_control_loops, bytes({0x08}));  // d's port 1: 10 open
    bus.write(0, 0x0F80, bytes({7}));

    EXPECT_FALSE(bus.flight.has_value());
    EXPECT_EQ(a->controller().peek(0x0F80), std::byte{7}) << "the slaves on the way acted";
}

TEST_F(Tree, AutoCloseStaysClosedAfterTheCableIsBackUntilTheMasterOpensIt) {
    bus.write(1, dl_control_loops, bytes({0x40}));  // port 3: 01 auto close
    EXPECT_EQ(count(), 4);
    bus.network.set_cable(*c, false);
    bus.network.set_cable(*c, true);
    EXPECT_EQ(count(), 3);

    bus.write(1, dl_control_loops, bytes({0x40}));
    EXPECT_EQ(count(), 4);
}

TEST_F(Tree, AutoCloseAtTheEntryOpensWithTheFrameThatArrives) {
    bus.write(2, dl_control_loops, bytes({0x01}));  // c's port 0: 01 auto close
    bus.network.set_cable(*c, false);
    bus.network.set_cable(*c, true);
    EXPECT_EQ(count(), 4);
}

TEST_F(Tree, ATemporaryLoopSettingEndsAfterOneSecond) {
    bus.write(1, dl_control, bytes({0x03, 0x03}));  // b shuts its own entry, for a while
    bus.read(0, 0, 1);
    EXPECT_FALSE(bus.flight.has_value()) << "nothing gets through to open it again";
    bus.wait(999ms);
    bus.read(0, 0, 1);
    EXPECT_FALSE(bus.flight.has_value());
    bus.wait(1ms + 700ns);  // the write arrived there 700 ns after it was sent

    EXPECT_EQ(count(), 4);
    EXPECT_EQ(bus.value<std::uint8_t>(1, dl_control_loops), 0);
}

//   master -- 0[a]1 -- 1[b]: the cable went into OUT of b, whose port 0 is free
TEST(SwappedSockets, AtTheEndOfTheLineTheSlaveStillWorksAndMarksTheFrame) {
    BusProbe bus;
    auto& a = bus.add_drive({.name = "a"});
    bus.network.add_behind(a, 1, std::make_shared<const DeviceDescription>(small_drive()), std::make_unique<RecordingModel>(), {}, 1);

    std::array<std::byte, max_frame_size> buffer{};
    FrameBuilder builder{buffer, MacAddress{}};
    builder.add(Command::BRD, 1, Address::physical(0, 0x0000), 1);
    const std::size_t size = builder.finish().size();
    const auto flight = bus.network.process({buffer.data(), size}, bus.now);

    EXPECT_EQ(flight, std::optional<Duration>{50ns + 600ns + 50ns + 600ns + 50ns + 560ns + 50ns});
    FrameReader reader{std::span<const std::byte>{buffer.data(), size}};
    const auto datagram = reader.next();
    ASSERT_TRUE(datagram);
    EXPECT_EQ(datagram->working_counter(), 2);
    EXPECT_TRUE(datagram->circulating) << "port 0 of b closed itself";
    EXPECT_EQ(bus.value<std::uint16_t>(1, dl_status), 0x5923) << "port 1 open, port 0 closed";
}

TEST(SwappedSockets, AFrameThatMeetsASecondShutPort0IsDestroyed) {
    BusProbe bus;
    auto& a = bus.add_drive();
    const auto description = std::make_shared<const DeviceDescription>(small_drive());
    bus.network.add_behind(a, 3, description, std::make_unique<RecordingModel>(), {}, 1);
    bus.network.add_behind(a, 1, description, std::make_unique<RecordingModel>(), {}, 1);

    bus.write(0, 0x0F80, bytes({7}));

    EXPECT_FALSE(bus.flight.has_value()) << "each of the two alone works, both together kill every frame";
    bus.network.set_cable(2, false);
    EXPECT_EQ(bus.send(Command::BRD, Address::physical(0, 0), Bytes(1)).wkc, 2);
}

//   master -- 0[a]1 -- 1[b]0 -- 0[c]: b passes the frame on before it processes it
TEST(SwappedSockets, InTheMiddleOfTheLineTheSlaveBehindComesFirst) {
    BusProbe bus;
    auto& a = bus.add_drive({.name = "a"});
    const auto description = std::make_shared<const DeviceDescription>(small_drive());
    auto& b = bus.network.add_behind(a, 1, description, std::make_unique<RecordingModel>(), {.name = "b"}, 1);
    auto& c = bus.add_drive({.name = "c"});

    EXPECT_EQ(bus.network.position(c), 1u);
    EXPECT_EQ(bus.network.position(b), 2u);
    bus.write(2, 0x0010, le<std::uint16_t>(0x1003));
    EXPECT_EQ(b.controller().station_address(), 0x1003);
    // a 600, cable, b past its unit 560, cable, c 600, cable, b through its unit 600, cable, a 560, cable: and five cables more.
    EXPECT_EQ(*bus.flight, 6 * 50ns + 600ns + 560ns + 600ns + 600ns + 560ns);
}

}  // namespace
}  // namespace taktwerk::ecat::sim
