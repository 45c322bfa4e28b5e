// Distributed clocks of simulated slaves: latched times, offset and delay, drift control, SYNC0 in machine time.
// Source: ETG.1000.4 (0900h..09A7h); line delays as given in LineTiming (600 ns there, 560 ns back, 50 ns of cable).

#include <gmock/gmock.h>

#include <cstdlib>

#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

DeviceDescription dc_drive() {
    auto description = small_drive();
    description.dc.supported = true;
    return description;
}

TEST(DcLatch, TakesTheReceiveTimesOfOneFrame) {
    BusProbe bus;
    bus.add_drive({.clock_start = 5s}, dc_drive());  // 5 s does not fit into 32 bits: 705032704
    bus.add_drive({}, dc_drive());
    bus.wait(1ms);

    EXPECT_EQ(bus.send(Command::BWR, Address::physical(0, 0x0900), Bytes(4)).wkc, 2);

    // Slave 0: cable 50 ns; back at port 1 after 600 + 50 + 600 (turned around in slave 1) + 50.
    EXPECT_EQ(bus.value<std::uint32_t>(0, 0x0900), 705032704u + 1'000'050u);
    EXPECT_EQ(bus.value<std::uint32_t>(0, 0x0904), 705032704u + 1'001'350u);
    EXPECT_EQ(bus.value<std::int64_t>(0, 0x0918), 5'001'000'050);
    // Slave 1: 50 + 600 + 50; nothing behind it.
    EXPECT_EQ(bus.value<std::uint32_t>(1, 0x0900), 1'000'700u);
    EXPECT_EQ(bus.value<std::uint32_t>(1, 0x0904), 0u);
}

TEST(DcLatch, TheFlightTimeIsTheWayThereAndBack) {
    BusProbe bus;
    bus.add_drive();
    bus.add_drive();
    bus.read(0, 0x0000, 1);

    EXPECT_EQ(*bus.flight, 50ns + 600ns + 50ns + 600ns + 50ns + 560ns + 50ns);
}

TEST(DcClockRegisters, SystemTimeIsLocalTimePlusOffset) {
    BusProbe bus;
    bus.add_drive({.clock_start = 10ms}, dc_drive());
    bus.write(0, 0x0920, le<std::int64_t>(-3'000'000));
    bus.wait(2ms);

    EXPECT_EQ(bus.value<std::int64_t>(0, 0x0910), 10'000'000 - 3'000'000 + 2'000'000 + 50);
}

TEST(DcClockRegisters, AFastQuartzGainsItsDrift) {
    BusProbe bus;
    bus.add_drive({.drift_ppm = 100}, dc_drive());
    bus.wait(10s);

    EXPECT_EQ(bus.value<std::int64_t>(0, 0x0910), 10'000'000'050 + 1'000'000);  // 100 us per second
}

// What real couplers without DC do in a recorded bus start-up: 0900h is there, 0910h and above do not count.
TEST(DcClockRegisters, OfASlaveWithoutDcOnlyTheReceiveTimesCount) {
    BusProbe bus;
    bus.add_drive({}, dc_drive());
    bus.add_drive();

    EXPECT_EQ(bus.send(Command::BWR, Address::physical(0, 0x0900), Bytes(4)).wkc, 2);
    EXPECT_EQ(bus.send(Command::BRD, Address::physical(0, 0x0910), Bytes(8)).wkc, 1);
    EXPECT_EQ(bus.send(Command::ARMW, Address::position(0, 0x0910), Bytes(8)).wkc, 1);
}

struct DriftingPair : testing::Test {
    DriftingPair() {
        bus.add_drive({.drift_ppm = 40, .clock_start = 3s}, dc_drive());
        bus.add_drive({.drift_ppm = -60, .clock_start = 1s}, dc_drive());
        bus.write(1, 0x0928, le<std::uint32_t>(650));           // delay: 600 + 50
        bus.write(1, 0x0920, le<std::int64_t>(2'000'000'300));  // 300 ns wrong on purpose
    }
    void spread(int frames) {
        for (int i = 0; i < frames; ++i) {
            worst = std::max<std::int64_t>(worst, std::abs(error()));
            EXPECT_EQ(bus.send(Command::ARMW, Address::position(0, 0x0910), Bytes(8)).wkc, 2);
            bus.wait(1ms);
        }
    }
    std::int64_t error() {
        return bus.network.slave(1).controller().clock().system(bus.now) - bus.network.slave(0).controller().clock().system(bus.now);
    }
    BusProbe bus;
    std::int64_t worst = 0;
};

TEST_F(DriftingPair, WithoutCorrectionRunApart) {
    bus.wait(1s);
    EXPECT_NEAR(static_cast<double>(error()), 300.0 - 100'000.0, 10.0);  // 100 ppm apart
}

TEST_F(DriftingPair, FollowTheReferenceAfterManyFrames) {
    spread(1000);
    worst = 0;
    spread(200);

    EXPECT_LE(worst, 20);  // ns; the SV33-E claims < 1 us between two slaves (manual 1.3.2)
    const auto difference = dc_difference_ns(bus.value<std::uint32_t>(1, 0x092C));
    EXPECT_LE(std::abs(difference), 20);
}

TEST_F(DriftingPair, AreNotPulledAcrossALargeOffset) {
    bus.write(1, 0x0920, le<std::int64_t>(0));  // 2 s wrong
    spread(1000);

    EXPECT_LT(error(), -1'900'000'000);
    EXPECT_LT(dc_difference_ns(bus.value<std::uint32_t>(1, 0x092C)), -1'900'000'000);
}

TEST(DcDifference, SignIsBit31) {
    BusProbe bus;
    bus.add_drive({}, dc_drive());
    bus.wait(1ms);
    const auto own = bus.value<std::int64_t>(0, 0x0910);

    bus.write(0, 0x0910, le<std::int64_t>(own + 5000));  // the reference is ahead, the local copy behind
    EXPECT_EQ(bus.value<std::uint32_t>(0, 0x092C), 0x80000000u + 5000u);
}

struct SyncedDrive : testing::Test {
    void start(double drift_ppm, Duration clock_start, std::int64_t lead_ns, std::uint32_t cycle) {
        bus.add_drive({.drift_ppm = drift_ppm, .clock_start = clock_start}, dc_drive());
        bus.to_preop(0);
        bus.process_managers(0);
        first = bus.value<std::int64_t>(0, 0x0910) + lead_ns;
        bus.write(0, 0x0990, le<std::int64_t>(first));
        bus.write(0, 0x09A0, le<std::uint32_t>(cycle));
        bus.write(0, 0x0981, bytes({0x03}));
        bus.request(0, 4);
        bus.recorders[0]->exchanges.clear();
    }
    BusProbe bus;
    std::int64_t first = 0;
};

TEST_F(SyncedDrive, FiresAtStartPlusCyclesOfItsOwnClock) {
    start(0, 100ms, 20'000'000, 1'000'000);
    bus.wait(30ms);

    const auto& at = bus.recorders[0]->exchanges;
    ASSERT_GE(at.size(), 3u);
    auto& clock = bus.network.slave(0).controller().clock();
    for (std::size_t k = 0; k < at.size(); ++k) {
        EXPECT_EQ(clock.system(at[k]), first + static_cast<std::int64_t>(k) * 1'000'000);
        EXPECT_LT(clock.system(at[k] - 1ns), first + static_cast<std::int64_t>(k) * 1'000'000);
    }
}

TEST_F(SyncedDrive, AFastClockFiresEarlyInMachineTime) {
    start(100, 0s, 20'000'000, 1'000'000);
    bus.wait(1s);

    const auto& at = bus.recorders[0]->exchanges;
    ASSERT_GE(at.size(), 501u);
    // 500 ms of a clock that runs 100 ppm fast pass in 500 ms / 1.0001 = 499.950005 ms.
    EXPECT_NEAR(static_cast<double>((at[500] - at[0]).count()), 499'950'005.0, 2.0);
}

TEST_F(SyncedDrive, StopsWhenDeactivated) {
    start(0, 0s, 20'000'000, 1'000'000);
    bus.wait(30ms);
    bus.write(0, 0x0981, bytes({0x00}));
    const auto before = bus.recorders[0]->exchanges.size();
    bus.wait(30ms);

    EXPECT_EQ(bus.recorders[0]->exchanges.size(), before);
}

TEST_F(SyncedDrive, LatchesTheNewestOutputsAtSync0AndCountsWhatDidNotCome) {
    start(0, 0s, 20'000'000, 1'000'000);
    auto& slave = bus.network.slave(0);
    bus.request(0, 8);
    bus.wait(20ms);
    const auto missed = slave.missed_outputs();

    bus.write(0, 0x1800, bytes({1, 0, 1, 0, 0, 0}));
    bus.write(0, 0x1800, bytes({2, 0, 2, 0, 0, 0}));
    EXPECT_NE(slave.dictionary().value(0x6040, 0), 2) << "only SYNC0 brings them in";
    bus.wait(3ms);

    EXPECT_EQ(slave.dictionary().value(0x6040, 0), 2);
    EXPECT_EQ(slave.missed_outputs(), missed + 2) << "three pulses, one with new outputs";
}

}  // namespace
}  // namespace taktwerk::ecat::sim
