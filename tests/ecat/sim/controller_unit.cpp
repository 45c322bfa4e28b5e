// What a slave controller does beyond addressing and memory: protection, reset, owner of the EEPROM, PDI watchdog, events to the
// master, commands and mappings it may lack. Source: ETG.1000.4, SV33-E manual 6.2.4.

#include <gmock/gmock.h>

#include "ecat/sim/digital_terminal.hpp"
#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

/// Two datagrams to slave 0 in one frame; the working counter of the second.
std::uint16_t in_one_frame(BusProbe& bus, std::uint16_t first, std::uint16_t second, std::byte value) {
    std::array<std::byte, max_frame_size> buffer{};
    FrameBuilder builder{buffer, MacAddress{}};
    builder.add(Command::APWR, 1, Address::position(0, first), 1)[0] = std::byte{0};
    builder.add(Command::APWR, 2, Address::position(0, second), 1)[0] = value;
    const std::size_t size = builder.finish().size();
    (void)bus.network.process({buffer.data(), size}, bus.now);
    FrameReader reader{std::span<const std::byte>{buffer.data(), size}};
    (void)reader.next();
    return reader.next()->working_counter();
}

TEST(WriteProtection, OfRegistersIsLiftedForTheRestOfAFrame) {
    BusProbe bus;
    bus.add_drive();
    bus.write(0, 0x0021, bytes({1}));

    EXPECT_EQ(bus.write(0, 0x0010, le<std::uint16_t>(7)).wkc, 0);
    EXPECT_EQ(bus.write(0, 0x0F80, bytes({5})).wkc, 1) << "user RAM is not a register";
    EXPECT_EQ(in_one_frame(bus, 0x0020, 0x0010, std::byte{7}), 1);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0010), 7);
    EXPECT_EQ(bus.write(0, 0x0010, le<std::uint16_t>(8)).wkc, 0) << "protected again";
}

TEST(WriteProtection, OfEverythingCoversTheMemory) {
    BusProbe bus;
    bus.add_drive();
    bus.write(0, 0x0031, bytes({1}));

    EXPECT_EQ(bus.write(0, 0x1200, bytes({5})).wkc, 0);
    EXPECT_EQ(bus.read(0, 0x1200, 1).wkc, 1) << "reading is free";
    EXPECT_EQ(in_one_frame(bus, 0x0030, 0x1200, std::byte{5}), 1);
    EXPECT_EQ(in_one_frame(bus, 0x0030, 0x0031, std::byte{0}), 1);
    EXPECT_EQ(bus.write(0, 0x1200, bytes({6})).wkc, 1);
}

TEST(EcatReset, TakesThreeLettersInThreeFramesOneAfterTheOther) {
    BusProbe bus;
    bus.add_drive();
    const auto address = [&] { return bus.value<std::uint16_t>(0, 0x0010); };
    bus.write(0, 0x0010, le<std::uint16_t>(7));
    const auto letter = [&](char c) { bus.write(0, 0x0040, bytes({c})); };

    letter('R'), letter('E'), bus.read(0, 0, 1), letter('S');
    EXPECT_EQ(address(), 7) << "another frame came between";
    letter('R'), letter('S'), letter('E');
    EXPECT_EQ(address(), 7);
    letter('R'), letter('R'), letter('E'), letter('S');

    EXPECT_EQ(address(), 0);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0110), 0x5613) << "the link is there";
}

TEST(EepromOwner, IsTheMasterWhileBothSidesSaySo) {
    BusProbe bus;
    auto& slave = bus.add_drive();
    const auto busy_after_a_read = [&] {
        bus.write(0, 0x0502, bytes({0x00, 0x01, 0x08, 0x00, 0x00, 0x00}));
        const bool busy = (bus.value<std::uint16_t>(0, 0x0502) & 0x8000) != 0;
        bus.wait(1ms);
        return busy;
    };
    EXPECT_FALSE(slave.controller().take_eeprom(true)) << "not offered";
    EXPECT_TRUE(busy_after_a_read());

    bus.write(0, 0x0500, bytes({1}));
    EXPECT_TRUE(slave.controller().take_eeprom(true));
    bus.write(0, 0x0500, bytes({0}));
    EXPECT_FALSE(busy_after_a_read()) << "the application still has it";
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0501), 1);
    bus.write(0, 0x0501, bytes({0}));
    EXPECT_FALSE(busy_after_a_read()) << "0501h is not the master's";

    bus.write(0, 0x0500, bytes({2}));  // force
    EXPECT_TRUE(busy_after_a_read());
}

TEST(EepromErrors, AnAddressBeyondTheDeviceIsACommandError) {
    BusProbe bus;
    auto& slave = bus.add_drive();
    const auto words = static_cast<std::uint32_t>(slave.controller().eeprom().image().size() / 2);
    bus.write(0, 0x0504, le<std::uint32_t>(words));
    bus.write(0, 0x0502, le<std::uint16_t>(0x0100));
    bus.wait(1ms);

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0502) & 0xE000, 0x2000);
    bus.write(0, 0x0502, le<std::uint16_t>(0));
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0502) & 0xE000, 0) << "command 0 clears it";
}

TEST(EepromReload, TakesTheAliasWithoutAPowerCycle) {
    BusProbe bus;
    auto& slave = bus.add_drive({.alias = 5});
    auto& image = slave.controller().eeprom().image();
    store_le<std::uint16_t>(image, 8, 6);
    store_le<std::uint16_t>(image, 14, 0x0063);  // checksum by a separate script, as in Eeprom.ANewAliasCountsAfterThePowerCycle

    bus.write(0, 0x0502, le<std::uint16_t>(0x0400));
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0502) & 0x8000, 0x8000);
    bus.wait(1ms);

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0012), 6);
}

// 0410h: 1000 ticks of 100 us after power-on.
TEST(PdiWatchdog, RunsOutWhenTheFirmwareHangs) {
    BusProbe bus;
    auto& slave = bus.add_drive();
    bus.to_preop(0);
    slave.hang(true);
    bus.wait(99ms);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0110) & 2, 2);
    bus.wait(2ms);

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0110) & 2, 0);
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0443), 1);
    EXPECT_EQ(bus.request(0, 1), 2) << "nobody is there to change the state";
    slave.hang(false);
    bus.wait(1ms);
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0130), 1) << "what was asked meanwhile is done";
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0110) & 2, 2);
}

TEST(PdiWatchdog, IsOffAtZeroAndNeverFedByATerminalWithoutProcessor) {
    BusProbe bus;
    auto& slave = bus.add_drive();
    bus.add(digital_input_output_terminal(8, 8), std::make_unique<DigitalTerminal>());
    bus.write(0, 0x0410, le<std::uint16_t>(0));
    slave.hang(true);
    bus.wait(10s);

    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0443), 0);
    EXPECT_EQ(bus.value<std::uint16_t>(1, 0x0110) & 2, 0);
}

TEST(SlaveEvents, OfASyncManagerTellTheMasterThatThereIsAnAnswer) {
    BusProbe bus;
    bus.add_drive();
    bus.set_sync_manager(0, 0, 0x1000, 0x80, 0x26);
    bus.set_sync_manager(0, 1, 0x1400, 0x80, 0x32);  // with the interrupt to the master
    bus.request(0, 2);
    bus.write(0, 0x0200, le<std::uint16_t>(0x0020));  // bit 4 + 1
    Bytes request(0x80);
    const auto upload = bytes({10, 0, 0, 0, 0, 0x13, 0x00, 0x20, 0x40, 0x00, 0x10, 0x00});
    std::copy(upload.begin(), upload.end(), request.begin());
    bus.write(0, 0x1000, request);

    EXPECT_EQ(bus.read(0, 0x0F80, 1).irq, 0);
    bus.wait(1ms);
    EXPECT_EQ(bus.read(0, 0x0F80, 1).irq, 0x0020);
    bus.read(0, 0x1400, 0x80);
    EXPECT_EQ(bus.read(0, 0x0F80, 1).irq, 0);
}

// Status of a buffered sync manager: bits 5..4 the buffer written last (11: none), bit 0 written, bit 1 read.
TEST(SyncManagerStatus, NamesTheBufferWrittenLast) {
    BusProbe bus;
    bus.add_drive();
    bus.to_preop(0);
    bus.process_managers(0);
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x0815), 0x30);
    bus.request(0, 4);
    const auto status = [&] {
        bus.write(0, 0x1800, Bytes(6));
        return bus.value<std::uint8_t>(0, 0x0815) & 0x30;
    };

    EXPECT_EQ(status(), 0x00);
    EXPECT_EQ(status(), 0x10);
    EXPECT_EQ(status(), 0x20);
    EXPECT_EQ(status(), 0x00);
}

TEST(Features, ALogicalReadWritePassesAControllerThatHasNone) {
    BusProbe bus;
    bus.add_drive({.lrw = false});
    Fmmu f;
    f.logical_start = 0, f.length = 1, f.physical_start = 0x1200, f.read = true, f.active = true;
    bus.set_fmmu(0, 0, f);
    bus.write(0, 0x1200, bytes({9}));

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0008) & 0x0200, 0x0200);
    const auto lrw = bus.send(Command::LRW, Address::logical(0), bytes({1}));
    EXPECT_EQ(lrw.wkc, 0);
    EXPECT_EQ(lrw.data, bytes({1}));
    EXPECT_EQ(bus.send(Command::LRD, Address::logical(0), bytes({1})).data, bytes({9}));
}

TEST(Features, ReadWriteCommandsPassAControllerThatHasNone) {
    BusProbe bus;
    bus.add_drive({.read_write = false});
    bus.write(0, 0x0010, le<std::uint16_t>(0x1001));

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0008) & 0x0400, 0x0400);
    EXPECT_EQ(bus.send(Command::APRW, Address::position(0, 0x0F80), Bytes(2)).wkc, 0);
    EXPECT_EQ(bus.send(Command::FPRW, Address::physical(0x1001, 0x0F80), Bytes(2)).wkc, 0);
    EXPECT_EQ(bus.send(Command::BRW, Address::physical(0, 0x0F80), Bytes(2)).wkc, 0);
    EXPECT_EQ(bus.send(Command::BRD, Address::physical(0, 0x0F80), Bytes(2)).wkc, 1);
    EXPECT_EQ(bus.send(Command::FRMW, Address::physical(0x1001, 0x0F80), Bytes(2)).wkc, 1);
}

TEST(Features, AnFmmuThatIsNotBitwiseTakesWholeBytes) {
    BusProbe bus;
    bus.add_drive({.bitwise_fmmu = false});
    Fmmu f;
    f.logical_start = 0, f.length = 1, f.logical_start_bit = 2, f.logical_stop_bit = 3, f.physical_start = 0x1200, f.physical_start_bit = 5;
    f.read = true, f.active = true;
    bus.set_fmmu(0, 0, f);
    bus.write(0, 0x1200, bytes({0xA5}));

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0008) & 0x0001, 0x0001);
    EXPECT_EQ(bus.send(Command::LRD, Address::logical(0), bytes({0})).data, bytes({0xA5}));
}

TEST(PhysicalReadWriteOffset, MovesWhatAReadWriteCommandWrites) {
    BusProbe bus;
    bus.add_drive();
    bus.write(0, 0x0F80, bytes({1}));
    bus.write(0, 0x0108, le<std::uint16_t>(8));

    const auto answer = bus.send(Command::APRW, Address::position(0, 0x0F80), bytes({2}));

    EXPECT_EQ(answer.wkc, 3);
    EXPECT_EQ(answer.data, bytes({1}));
    EXPECT_EQ(bus.read(0, 0x0F80, 1).data, bytes({1}));
    EXPECT_EQ(bus.read(0, 0x0F88, 1).data, bytes({2}));
}

}  // namespace
}  // namespace taktwerk::ecat::sim
