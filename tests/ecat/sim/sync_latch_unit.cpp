// SYNC1, the latch unit and the 32-bit clock of simulated slaves. Source: ETG.1000.4 (0980h..09CFh).

#include <gmock/gmock.h>

#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

DeviceDescription latching_drive(bool wide = true) {
    auto description = small_drive();
    description.dc.supported = true;
    description.dc.clock_64bit = wide;
    return description;
}

struct Sync1Test : testing::Test {
    /// Starts SYNC0 (1 ms) and SYNC1, runs for 20 SYNC0 pulses; SYNC0 and SYNC1 pulses.
    std::pair<std::uint64_t, std::uint64_t> pulses(std::uint32_t sync1_cycle, std::uint8_t activation = 0x07) {
        BusProbe bus;
        auto& slave = bus.add_drive({}, latching_drive());
        first = bus.value<std::int64_t>(0, 0x0910) + 5'000'000;
        bus.write(0, 0x0990, le<std::int64_t>(first));
        bus.write(0, 0x09A0, le<std::uint32_t>(1'000'000));
        bus.write(0, 0x09A4, le<std::uint32_t>(sync1_cycle));
        bus.write(0, 0x0981, bytes({activation}));
        bus.wait(5ms + 19ms + 900us);
        next_sync0 = bus.value<std::int64_t>(0, 0x0990);
        next_sync1 = bus.value<std::int64_t>(0, 0x0998);
        return {slave.controller().sync0().pulses(), slave.controller().sync1().pulses()};
    }
    std::int64_t first = 0, next_sync0 = 0, next_sync1 = 0;
};

TEST_F(Sync1Test, ShorterThanACycleFollowsEverySync0) {
    EXPECT_EQ(pulses(250'000), std::pair(std::uint64_t{20}, std::uint64_t{20}));
    EXPECT_EQ(next_sync0, first + 20'000'000);
    EXPECT_EQ(next_sync1, first + 19'250'000) << "the last one";
}

TEST_F(Sync1Test, OfTwoCyclesGivesEverySecond) {
    // Pulses k = 2, 4, .. 18 of SYNC0 (0..19) carry it.
    EXPECT_EQ(pulses(2'000'000), std::pair(std::uint64_t{20}, std::uint64_t{9}));
}

TEST_F(Sync1Test, OfZeroComesTogetherWithSync0) { EXPECT_EQ(pulses(0), std::pair(std::uint64_t{20}, std::uint64_t{20})); }

TEST_F(Sync1Test, IsOffWithoutItsBit) { EXPECT_EQ(pulses(250'000, 0x03), std::pair(std::uint64_t{20}, std::uint64_t{0})); }

TEST_F(Sync1Test, AloneRunsTooWithoutAnySync0ForTheDevice) {
    BusProbe bus;
    auto description = latching_drive();
    description.dc.required = true;
    bus.add_drive({}, description);
    bus.to_preop(0);
    bus.process_managers(0);
    bus.write(0, 0x0990, le<std::int64_t>(bus.value<std::int64_t>(0, 0x0910) + 5'000'000));
    bus.write(0, 0x09A0, le<std::uint32_t>(1'000'000));
    bus.write(0, 0x0981, bytes({0x05}));

    EXPECT_EQ(bus.request(0, 4), 0x12);
    EXPECT_EQ(bus.code(0), 0x002D) << "a drive that needs SYNC0 gets none";
}

struct LatchTest : testing::Test {
    LatchTest() { slave = &bus.add_drive({}, latching_drive()); }
    void edge(bool level) { slave->controller().set_latch_input(0, level, bus.now); }
    /// System time of a direct neighbour of the master without offset: machine time since power-on.
    std::int64_t positive() { return bus.value<std::int64_t>(0, 0x09B0); }
    std::int64_t negative() { return bus.value<std::int64_t>(0, 0x09B8); }
    std::uint8_t status() { return bus.value<std::uint8_t>(0, 0x09AE); }
    BusProbe bus;
    SimSlave* slave = nullptr;
};

TEST_F(LatchTest, ContinuousKeepsTheTimeOfTheLastEdgeOfEachKind) {
    bus.wait(1ms);
    edge(true);
    bus.wait(1ms);
    edge(false);
    bus.wait(1ms);
    edge(true);

    EXPECT_EQ(positive(), 3'000'000);
    EXPECT_EQ(negative(), 2'000'000);
    EXPECT_EQ(status(), 0x04) << "the level; no events are kept";
}

TEST_F(LatchTest, SingleEventKeepsTheFirstEdgeUntilItWasRead) {
    bus.write(0, 0x09A8, bytes({0x01}));
    bus.write(0, 0x0200, le<std::uint16_t>(0x0001));
    bus.wait(1ms);
    edge(true);
    bus.wait(1ms);
    edge(false);
    edge(true);

    EXPECT_EQ(status(), 0x05);
    EXPECT_EQ(bus.read(0, 0x0F80, 1).irq, 0x0001) << "event request bit 0";
    EXPECT_EQ(positive(), 1'000'000);
    EXPECT_EQ(status(), 0x04) << "reading the time took the event";
    EXPECT_EQ(bus.read(0, 0x0F80, 1).irq, 0);
    edge(false);
    bus.wait(1ms);
    edge(true);
    EXPECT_EQ(positive(), 3'000'000);
}

// 4.29 s of a 32-bit clock: 2^32 ns = 4 294 967 296 ns.
TEST(NarrowClock, WrapsAndHasNoUpperHalves) {
    BusProbe bus;
    bus.add_drive({.clock_start = 4'294'967'296ns}, latching_drive(false));
    bus.wait(1ms);

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0008) & 0x000C, 0x0004);
    EXPECT_EQ(bus.value<std::int64_t>(0, 0x0910), 1'000'050);
    bus.write(0, 0x0900, Bytes(4));
    EXPECT_EQ(bus.value<std::int64_t>(0, 0x0918), 1'000'050);
    bus.write(0, 0x0920, le<std::int64_t>(-1'000'000));
    EXPECT_EQ(bus.value<std::int64_t>(0, 0x0910), 50);
}

TEST(NarrowClock, StartsSync0WhenItsLow32BitsCome) {
    BusProbe bus;
    auto& slave = bus.add_drive({.clock_start = 4'294'000'000ns}, latching_drive(false));
    bus.write(0, 0x0990, le<std::uint32_t>(32'704));  // 4'295'000'000 - 2^32: 1 ms ahead
    bus.write(0, 0x09A0, le<std::uint32_t>(1'000'000));
    bus.write(0, 0x0981, bytes({0x03}));
    bus.wait(999us);
    EXPECT_EQ(slave.controller().sync0().pulses(), 0u);
    bus.wait(1us);

    EXPECT_EQ(slave.controller().sync0().pulses(), 1u);
}

}  // namespace
}  // namespace taktwerk::ecat::sim
