// What another master left in the slaves when it ended: ports it had closed, EEPROMs it had handed over. The bring-up puts it right.
#include <gtest/gtest.h>

#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

/// One datagram of another master to the slave at a position.
void other_master_writes(TestBus& bus, std::uint16_t position, std::uint16_t address, std::uint8_t value) {
    std::array<std::byte, min_frame_size> buffer{};
    FrameBuilder builder{buffer, MacAddress{0x00, 0x11, 0x22, 0x33, 0x44, 0x55}};
    store_le(builder.add(Command::APWR, 0x40, Address::position(position, address), 1), 0, value);
    (void)builder.finish();
    (void)bus.network.process(buffer, bus.now);
}

// Port 1 of the first slave, then of the second: closed one behind the other (0101h: 3 = closed in bits 2 and 3).
TEST(LeftBehind, PortsThatWereClosedAreOpenedAgain) {
    TestBus bus{"tts"};
    other_master_writes(bus, 1, reg::dl_control_loops, 0x0C);
    other_master_writes(bus, 0, reg::dl_control_loops, 0x0C);
    EXPECT_TRUE(bus.bring_up()) << bus.why();
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(bus.state(i), sim::EsmState::op) << i;
}

// SOEM hands the EEPROM to the slave's processor on the way to PREOP (0500h = 1) and leaves it there.
TEST(LeftBehind, AnEepromThatItsProcessorHoldsIsTakenBack) {
    TestBus bus{"s"};
    other_master_writes(bus, 0, reg::eeprom_configuration, 1);
    EXPECT_TRUE(bus.bring_up()) << bus.why();
}

}  // namespace
}  // namespace taktwerk::ecat::test
