// Registers, addressing and working counters of a simulated slave controller. Values: ETG.1000.4, SV33-E manual 6.2.4.

#include <gmock/gmock.h>

#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

TEST(SlaveRegisters, TellWhatTheControllerHas) {
    BusProbe bus;
    bus.add_drive();

    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0004), 8);        // FMMUs
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0005), 8);        // sync managers
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0006), 4);        // KiB
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0007), 0x0F);     // two MII ports
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0400), 2498);    // 100 us ticks
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0420), 1000);    // 100 ms
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0130), 0x0001);  // INIT
}

TEST(SlaveRegisters, FeatureBitsSayWhetherThereIsADcUnit) {
    BusProbe bus;
    auto with_dc = small_drive();
    with_dc.dc.supported = true;
    bus.add_drive({}, with_dc);
    bus.add_drive();

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0008) & 0x000C, 0x000C);
    EXPECT_EQ(bus.value<std::uint16_t>(1, 0x0008) & 0x000C, 0);
}

TEST(SlaveRegisters, ReadOnlyBytesKeepTheirValue) {
    BusProbe bus;
    bus.add_drive();

    bus.write(0, 0x0130, bytes({0x08, 0x00}));
    bus.write(0, 0x0004, bytes({0x01}));

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0130), 0x0001);
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0004), 8);
}

TEST(SlaveRegisters, AnyWriteClearsAnErrorCounterBlock) {
    BusProbe bus;
    auto& slave = bus.add_drive();
    bus.to_safeop(0);
    bus.request(0, 8);
    bus.wait(200ms);  // the SM watchdog (100 ms) expires once
    ASSERT_EQ(static_cast<int>(slave.controller().peek(0x0442)), 1);

    bus.write(0, 0x0442, bytes({0x55}));

    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0442), 0);
}

TEST(SlaveRegisters, BroadcastReadCountsSlavesAndOrsTheirData) {
    BusProbe bus;
    for (int i = 0; i < 3; ++i) bus.add_drive();
    bus.to_preop(1);

    const auto answer = bus.send(Command::BRD, Address::physical(0, 0x0130), Bytes(2));

    EXPECT_EQ(answer.wkc, 3);
    EXPECT_EQ(answer.adp, 3);                                // each slave adds one
    EXPECT_EQ(load_le<std::uint16_t>(answer.data), 0x0003);  // INIT | PREOP
}

TEST(SlaveRegisters, StationAddressIsGivenByPositionAndThenAnswersFixedCommands) {
    BusProbe bus;
    for (int i = 0; i < 3; ++i) bus.add_drive();
    for (std::uint16_t i = 0; i < 3; ++i) EXPECT_EQ(bus.write(i, 0x0010, le<std::uint16_t>(static_cast<std::uint16_t>(0x1001 + i))).wkc, 1);

    const auto answer = bus.send(Command::FPRD, Address::physical(0x1002, 0x0010), Bytes(2));

    EXPECT_EQ(answer.wkc, 1);
    EXPECT_EQ(load_le<std::uint16_t>(answer.data), 0x1002);
    EXPECT_EQ(answer.adp, 0x1002);  // fixed addresses pass unchanged
    EXPECT_EQ(bus.send(Command::FPRD, Address::physical(0x2000, 0x0010), Bytes(2)).wkc, 0);
}

TEST(SlaveRegisters, AliasAnswersOnlyWhenDlControlAllows) {
    BusProbe bus;
    bus.add_drive({.alias = 0x0123});
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0012), 0x0123);
    EXPECT_EQ(bus.send(Command::FPRD, Address::physical(0x0123, 0x0130), Bytes(2)).wkc, 0);

    bus.write(0, 0x0103, bytes({0x01}));

    EXPECT_EQ(bus.send(Command::FPRD, Address::physical(0x0123, 0x0130), Bytes(2)).wkc, 1);
}

// Working counters of all physical commands: read +1, write +1; read and write: read +1, write +2 (ETG.1000.4 5.4.1.2).
TEST(WorkingCounter, OfEachPhysicalCommand) {
    BusProbe bus;
    for (int i = 0; i < 3; ++i) bus.add_drive();
    bus.write(1, 0x0010, le<std::uint16_t>(0x1001));
    const std::uint16_t ram = 0x0F80;
    const auto wkc = [&](Command command, Address address) { return bus.send(command, address, Bytes(4)).wkc; };

    EXPECT_EQ(wkc(Command::NOP, Address::position(0, ram)), 0);
    EXPECT_EQ(wkc(Command::APRD, Address::position(2, ram)), 1);
    EXPECT_EQ(wkc(Command::APRD, Address::position(3, ram)), 0);
    EXPECT_EQ(wkc(Command::APWR, Address::position(2, ram)), 1);
    EXPECT_EQ(wkc(Command::APRW, Address::position(2, ram)), 3);
    EXPECT_EQ(wkc(Command::FPRD, Address::physical(0x1001, ram)), 1);
    EXPECT_EQ(wkc(Command::FPWR, Address::physical(0x1001, ram)), 1);
    EXPECT_EQ(wkc(Command::FPRW, Address::physical(0x1001, ram)), 3);
    EXPECT_EQ(wkc(Command::BRD, Address::physical(0, ram)), 3);
    EXPECT_EQ(wkc(Command::BWR, Address::physical(0, ram)), 3);
    EXPECT_EQ(wkc(Command::BRW, Address::physical(0, ram)), 9);
    EXPECT_EQ(wkc(Command::ARMW, Address::position(1, ram)), 3);  // one reads, two write
    EXPECT_EQ(wkc(Command::FRMW, Address::physical(0x1001, ram)), 3);
}

TEST(WorkingCounter, ReadMultipleWriteCarriesTheValueToTheSlavesBehind) {
    BusProbe bus;
    for (int i = 0; i < 3; ++i) bus.add_drive();
    bus.write(1, 0x0F80, le<std::uint32_t>(0xCAFE0001));

    const auto answer = bus.send(Command::ARMW, Address::position(1, 0x0F80), le<std::uint32_t>(7));

    EXPECT_EQ(load_le<std::uint32_t>(answer.data), 0xCAFE0001);
    EXPECT_EQ(bus.value<std::uint32_t>(0, 0x0F80), 7u);  // before the one read: what the master sent
    EXPECT_EQ(bus.value<std::uint32_t>(2, 0x0F80), 0xCAFE0001);
}

TEST(WorkingCounter, ExchangeReturnsTheOldContentAndKeepsTheNew) {
    BusProbe bus;
    bus.add_drive();
    bus.write(0, 0x0F80, le<std::uint16_t>(0x1111));

    const auto answer = bus.send(Command::APRW, Address::position(0, 0x0F80), le<std::uint16_t>(0x2222));

    EXPECT_EQ(load_le<std::uint16_t>(answer.data), 0x1111);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0F80), 0x2222);
}

TEST(WorkingCounter, IsZeroForUnitsTheControllerDoesNotHave) {
    BusProbe bus;
    auto description = small_drive();
    description.fmmus = 3;
    description.sync_manager_count = 4;
    bus.add_drive({}, description);

    EXPECT_EQ(bus.write(0, 0x0620, Bytes(16)).wkc, 1);
    EXPECT_EQ(bus.write(0, 0x0630, Bytes(16)).wkc, 0);
    EXPECT_EQ(bus.write(0, 0x0600, Bytes(64)).wkc, 1) << "part of it is there";
    EXPECT_EQ(bus.write(0, 0x0818, Bytes(8)).wkc, 1);
    EXPECT_EQ(bus.write(0, 0x0820, Bytes(8)).wkc, 0);
}

TEST(WorkingCounter, IsZeroBeyondTheMemory) {
    BusProbe bus;
    bus.add_drive();

    EXPECT_EQ(bus.read(0, 0x2000, 4).wkc, 0);
    EXPECT_EQ(bus.write(0, 0x2000, Bytes(4)).wkc, 0);
    EXPECT_EQ(bus.read(0, 0x1FFC, 4).wkc, 1);
}

TEST(SlaveEvents, ShowInTheIrqFieldWhenMasked) {
    BusProbe bus;
    bus.add_drive();
    bus.to_preop(0);  // AL status changed: event bit 3
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0210) & 0x0008, 0) << "reading AL status clears the request";
    bus.write(0, 0x0200, le<std::uint16_t>(0x0008));

    bus.write(0, 0x0120, le<std::uint16_t>(1));
    bus.wait(1ms);

    EXPECT_EQ(bus.read(0, 0x0F80, 2).irq, 0x0008);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0130), 1);
    EXPECT_EQ(bus.read(0, 0x0F80, 2).irq, 0);
}

TEST(Eeprom, AReadTakesItsTimeAndGivesEightBytes) {
    BusProbe bus;
    bus.add_drive({.eeprom_read_time = 100us});

    bus.write(0, 0x0502, bytes({0x00, 0x01, 0x08, 0x00, 0x00, 0x00}));  // read command, word 8: vendor, product
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0502) & 0x8000, 0x8000);
    bus.wait(99us);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0502) & 0x8000, 0x8000);
    bus.wait(1us);

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0502), 0x00C0);  // idle, 8-byte reads, two address bytes, no error
    EXPECT_EQ(bus.value<std::uint32_t>(0, 0x0508), 0x000007FBu);
    EXPECT_EQ(bus.value<std::uint32_t>(0, 0x050C), 0x000C0108u);
}

TEST(Eeprom, AWriteNeedsItsEnableBitInTheSameAccess) {
    BusProbe bus;
    bus.add_drive();
    bus.write(0, 0x0504, le<std::uint32_t>(0x0100));
    bus.write(0, 0x0508, le<std::uint16_t>(0xBEEF));

    bus.write(0, 0x0502, le<std::uint16_t>(0x0200));
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0502) & 0xC000, 0x4000);  // write-enable error, not busy

    bus.write(0, 0x0502, le<std::uint16_t>(0x0201));
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0502) & 0xC000, 0x8000);
    bus.wait(2ms);
    bus.write(0, 0x0502, le<std::uint16_t>(0x0100));
    bus.wait(1ms);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0508), 0xBEEF);
}

TEST(Eeprom, WithABadChecksumTheControllerLoadsNothing) {
    BusProbe bus;
    auto& slave = bus.add_drive({.alias = 5});
    store_le<std::uint16_t>(slave.controller().eeprom().image(), 8, 9);  // another alias in word 4, word 7 left as it was
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0012), 5) << "taken over only at power-on";

    bus.network.set_power(0, false);
    bus.network.set_power(0, true);

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0012), 0);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0502) & 0x1800, 0x1800);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0110) & 0x0001, 0);
}

TEST(Eeprom, ANewAliasCountsAfterThePowerCycle) {
    BusProbe bus;
    bus.add_drive({.alias = 5});
    // Words 0..6 are 0008h 6608h 0 0 alias 0 0. The CRC-8 (07h, start FFh) for alias 6 was computed with a separate script,
    // which also gives D2h for the words of the SV33-E manual 6.2.6.2.
    const auto put = [&](std::uint32_t word, std::uint16_t value) {
        bus.write(0, 0x0504, le<std::uint32_t>(word));
        bus.write(0, 0x0508, le<std::uint16_t>(value));
        bus.write(0, 0x0502, le<std::uint16_t>(0x0201));
        bus.wait(3ms);
    };
    put(4, 6);
    put(7, 0x0063);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0012), 5);

    bus.network.set_power(0, false);
    bus.network.set_power(0, true);

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0012), 6);
}

TEST(Eeprom, MasterCommandsGoNowhereWhileTheApplicationOwnsIt) {
    BusProbe bus;
    bus.add_drive();
    bus.write(0, 0x0500, bytes({0x01}));

    bus.write(0, 0x0502, bytes({0x00, 0x01, 0x08, 0x00, 0x00, 0x00}));

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0502) & 0x8000, 0);
}

}  // namespace
}  // namespace taktwerk::ecat::sim
