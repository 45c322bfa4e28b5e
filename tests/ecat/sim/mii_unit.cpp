// MII management of a simulated slave controller, frame by frame. Registers: ETG.1000.4, 0510h to 0517h.
#include <gmock/gmock.h>

#include "ecat/wire/phy.hpp"
#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

/// Starts a reading and waits for its end; what 0510h says then.
std::uint16_t read_phy(BusProbe& bus, std::uint16_t slave, int address, int reg) {
    bus.write(slave, 0x0512, bytes({address, reg}));
    bus.write(slave, 0x0510, le<std::uint16_t>(0x0100));
    bus.wait(100us);
    return bus.value<std::uint16_t>(slave, 0x0510);
}

TEST(MiiInterface, AReadingTakesItsTimeAndShowsTheLinkOfThePort) {
    BusProbe bus;
    bus.add_drive();
    bus.add_drive();
    bus.write(0, 0x0512, bytes({1, 1}));
    bus.write(0, 0x0510, le<std::uint16_t>(0x0100));
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0510), 0x8100) << "busy with a reading";
    bus.wait(26us);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0510), 0x0000);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0514) & 0x0024, 0x0024) << "port 1 leads to the second slave: link, negotiated";
    EXPECT_EQ(read_phy(bus, 1, 1, 1), 0x0000);
    EXPECT_EQ(bus.value<std::uint16_t>(1, 0x0514) & 0x0024, 0) << "nobody is behind the last";
    bus.network.set_cable(1, false);
    EXPECT_EQ(read_phy(bus, 0, 1, 1), 0x0000);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0514) & 0x0024, 0);
}

TEST(MiiInterface, OfAPortThatIsNotThereIsAReadError) {
    BusProbe bus;
    bus.add_drive();
    EXPECT_EQ(read_phy(bus, 0, 2, 2), 0x2000) << "bit 13: no PHY answered";
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0514), 0xFFFF);
    EXPECT_EQ(read_phy(bus, 0, 0, 2), 0x0000) << "the next command clears it";
}

TEST(MiiInterface, AWritingNeedsItsEnableBitInTheSameAccess) {
    BusProbe bus;
    bus.add_drive();
    bus.write(0, 0x0510, le<std::uint16_t>(0x0200));
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0510), 0x4000) << "bit 14: command error";
    bus.write(0, 0x0510, le<std::uint16_t>(0x0300));
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0510), 0x4000) << "no such command";
    bus.write(0, 0x0510, le<std::uint16_t>(0x0201));
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0510), 0x8200);
}

}  // namespace
}  // namespace taktwerk::ecat::sim
