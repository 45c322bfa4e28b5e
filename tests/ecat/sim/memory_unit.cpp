// FMMUs and sync managers of a simulated slave controller. Source: ETG.1000.4 5.6 (FMMU), 5.7 (sync manager).

#include <gmock/gmock.h>

#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

Fmmu mapping(std::uint32_t logical, std::uint16_t length, std::uint8_t first_bit, std::uint8_t last_bit, std::uint16_t physical,
             std::uint8_t physical_bit, bool read, bool write) {
    Fmmu f;
    f.logical_start = logical, f.length = length, f.logical_start_bit = first_bit, f.logical_stop_bit = last_bit;
    f.physical_start = physical, f.physical_start_bit = physical_bit, f.read = read, f.write = write, f.active = true;
    return f;
}

TEST(Fmmu, MapsWholeBytesBothWays) {
    BusProbe bus;
    bus.add_drive();
    bus.set_fmmu(0, 0, mapping(0x10000, 2, 0, 7, 0x1200, 0, false, true));
    bus.set_fmmu(0, 1, mapping(0x10002, 2, 0, 7, 0x1300, 0, true, false));
    bus.write(0, 0x1300, bytes({0xAA, 0xBB}));

    const auto answer = bus.send(Command::LRW, Address::logical(0x10000), bytes({1, 2, 0, 0}));

    EXPECT_EQ(answer.wkc, 3);  // read +1, write +2
    EXPECT_EQ(answer.data, bytes({1, 2, 0xAA, 0xBB}));
    EXPECT_EQ(bus.read(0, 0x1200, 2).data, bytes({1, 2}));
}

TEST(Fmmu, ReadAndWriteCommandsTouchOnlyTheirDirection) {
    BusProbe bus;
    bus.add_drive();
    bus.set_fmmu(0, 0, mapping(0, 1, 0, 7, 0x1200, 0, false, true));
    bus.set_fmmu(0, 1, mapping(1, 1, 0, 7, 0x1300, 0, true, false));

    EXPECT_EQ(bus.send(Command::LRD, Address::logical(0), Bytes(2)).wkc, 1);
    EXPECT_EQ(bus.send(Command::LWR, Address::logical(0), bytes({9, 9})).wkc, 1);
    EXPECT_EQ(bus.read(0, 0x1200, 1).data, bytes({9}));
    EXPECT_EQ(bus.read(0, 0x1300, 1).data, bytes({0}));
    EXPECT_EQ(bus.send(Command::LRW, Address::logical(0x100), Bytes(2)).wkc, 0) << "nothing is mapped there";
}

TEST(Fmmu, TwoSlavesShareOneLogicalByte) {
    BusProbe bus;
    bus.add_drive();
    bus.add_drive();
    bus.set_fmmu(0, 0, mapping(0x20, 1, 0, 2, 0x1200, 0, true, false));  // bits 0..2
    bus.set_fmmu(1, 0, mapping(0x20, 1, 3, 7, 0x1200, 1, true, false));  // bits 3..7 from physical bits 1..5
    bus.write(0, 0x1200, bytes({0b1111'1101}));
    bus.write(1, 0x1200, bytes({0b0010'0110}));

    const auto answer = bus.send(Command::LRD, Address::logical(0x20), Bytes(1));

    // By hand: slave 0 gives 101 in bits 2..0; slave 1 gives its bits 5..1 = 10011 in bits 7..3.
    EXPECT_EQ(answer.data, bytes({0b1001'1101}));
    EXPECT_EQ(answer.wkc, 2);
}

TEST(Fmmu, AWriteOfSomeBitsKeepsTheirNeighbours) {
    BusProbe bus;
    bus.add_drive();
    bus.write(0, 0x1200, bytes({0xFF, 0x00}));
    bus.set_fmmu(0, 0, mapping(0x30, 2, 6, 1, 0x1200, 6, false, true));  // 4 bits: byte 0 bits 6..7, byte 1 bits 0..1

    bus.send(Command::LWR, Address::logical(0x30), bytes({0b0000'0000, 0b1111'1111}));

    EXPECT_EQ(bus.read(0, 0x1200, 2).data, bytes({0b0011'1111, 0b0000'0011}));
}

TEST(Fmmu, ADatagramThatCoversOnlyPartOfTheRunGetsThatPart) {
    BusProbe bus;
    bus.add_drive();
    bus.write(0, 0x1200, bytes({1, 2, 3, 4}));
    bus.set_fmmu(0, 0, mapping(0x100, 4, 0, 7, 0x1200, 0, true, false));

    EXPECT_EQ(bus.send(Command::LRD, Address::logical(0x102), Bytes(4)).data, bytes({3, 4, 0, 0}));
}

TEST(Fmmu, MapsTheMailboxFullBitIntoTheCycle) {
    BusProbe bus;
    bus.add_drive();
    bus.to_preop(0);
    bus.set_fmmu(0, 2, mapping(0x40, 1, 0, 0, 0x080D, 3, true, false));  // status of SM1, bit 3
    EXPECT_EQ(bus.send(Command::LRD, Address::logical(0x40), Bytes(1)).data, bytes({0}));

    bus.write(0, 0x1000, [] {
        Bytes m(0x80);
        const auto request = bytes({10, 0, 0, 0, 0, 0x13, 0x00, 0x20, 0x40, 0x00, 0x10, 0x00});
        std::copy(request.begin(), request.end(), m.begin());
        return m;
    }());
    bus.wait(1ms);

    EXPECT_EQ(bus.send(Command::LRD, Address::logical(0x40), Bytes(1)).data, bytes({1}));
}

TEST(SyncManagerMailbox, FullUntilTakenThenRefusesTheNextWrite) {
    BusProbe bus;
    auto& slave = bus.add_drive();
    bus.to_preop(0);
    slave.stick_mailbox(true);

    EXPECT_EQ(bus.write(0, 0x1000, Bytes(0x80)).wkc, 1);
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0805), 0x09);  // full, written
    EXPECT_EQ(bus.write(0, 0x1000, Bytes(0x80)).wkc, 0);
}

TEST(SyncManagerMailbox, IsEmptyUntilItsLastByteIsWritten) {
    BusProbe bus;
    auto& slave = bus.add_drive();
    bus.to_preop(0);
    slave.stick_mailbox(true);

    EXPECT_EQ(bus.write(0, 0x1000, Bytes(16)).wkc, 1);
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0805), 0x00);
    EXPECT_EQ(bus.write(0, 0x107F, Bytes(1)).wkc, 1);
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0805), 0x09);  // full, written
}

TEST(SyncManagerMailbox, AWriteThatDoesNotOpenAtTheStartIsRefused) {
    BusProbe bus;
    bus.add_drive();
    bus.to_preop(0);

    EXPECT_EQ(bus.write(0, 0x1008, Bytes(8)).wkc, 0);
}

TEST(SyncManagerMailbox, AnEmptyInboxAndTheWrongDirectionAreRefused) {
    BusProbe bus;
    bus.add_drive();
    bus.to_preop(0);

    EXPECT_EQ(bus.read(0, 0x1400, 0x80).wkc, 0) << "nothing to read";
    EXPECT_EQ(bus.read(0, 0x1000, 0x80).wkc, 0) << "the master writes this one";
    EXPECT_EQ(bus.write(0, 0x1400, Bytes(0x80)).wkc, 0) << "the master reads this one";
}

TEST(SyncManagerRegisters, AreFrozenWhileOn) {
    BusProbe bus;
    bus.add_drive();
    bus.set_sync_manager(0, 2, 0x1800, 6, 0x64);

    bus.write(0, 0x0810, bytes({0x00, 0x19, 9, 0}));
    EXPECT_EQ(bus.read(0, 0x0810, 4).data, bytes({0x00, 0x18, 6, 0}));

    bus.write(0, 0x0816, bytes({0x00}));
    bus.write(0, 0x0810, bytes({0x00, 0x19, 9, 0}));
    EXPECT_EQ(bus.read(0, 0x0810, 4).data, bytes({0x00, 0x19, 9, 0}));
}

TEST(SyncManagerBuffer, OutputsAppearToTheDeviceOnlyWhenTheLastByteIsThere) {
    BusProbe bus;
    auto& slave = bus.add_drive();
    bus.to_safeop(0);
    bus.request(0, 8);
    bus.recorders[0]->exchanges.clear();

    bus.write(0, 0x1800, bytes({0x0F, 0x00, 0x11}));
    EXPECT_TRUE(bus.recorders[0]->exchanges.empty());
    bus.write(0, 0x1803, bytes({0x22, 0x33, 0x44}));

    EXPECT_EQ(bus.recorders[0]->exchanges.size(), 1u);
    EXPECT_EQ(slave.dictionary().value(0x6040, 0), 0x000F);
    EXPECT_EQ(slave.dictionary().value(0x607A, 0), 0x44332211);
}

TEST(SyncManagerBuffer, IsLockedBelowSafeop) {
    BusProbe bus;
    bus.add_drive();
    bus.to_preop(0);
    bus.process_managers(0);
    EXPECT_EQ(bus.write(0, 0x1800, Bytes(6)).wkc, 0);
    EXPECT_EQ(bus.read(0, 0x1C00, 6).wkc, 0);

    bus.request(0, 4);
    EXPECT_EQ(bus.write(0, 0x1800, Bytes(6)).wkc, 1);
    EXPECT_EQ(bus.read(0, 0x1C00, 6).wkc, 1);
}

}  // namespace
}  // namespace taktwerk::ecat::sim
