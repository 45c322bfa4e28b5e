// Process data, plain terminals and the line: power, cables, lost frames, allocation.

#include <gmock/gmock.h>

#include "ecat/sim/digital_terminal.hpp"
#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

Fmmu whole(std::uint32_t logical, std::uint16_t length, std::uint16_t physical, bool read) {
    Fmmu f;
    f.logical_start = logical, f.length = length, f.physical_start = physical, f.read = read, f.write = !read, f.active = true;
    return f;
}

/// Copies its target to its actual: one exchange is visible as one step.
class EchoModel : public DeviceModel {
public:
    void power_on(ObjectDictionary& dictionary, Instant) override {
        target_ = dictionary.find(0x607A, 0);
        actual_ = dictionary.find(0x6064, 0);
    }
    void exchange(Instant) override { actual_->set(target_->get()); }

private:
    Entry *target_ = nullptr, *actual_ = nullptr;
};

TEST(ProcessData, TravelsInOneLogicalDatagram) {
    BusProbe bus;
    bus.add(small_drive(), std::make_unique<EchoModel>());
    bus.to_safeop(0);
    bus.set_fmmu(0, 0, whole(0, 6, 0x1800, false));
    bus.set_fmmu(0, 1, whole(6, 6, 0x1C00, true));
    bus.request(0, 8);
    const Bytes outputs = bytes({0x0F, 0, 0xFE, 0xFF, 0xFF, 0xFF, 0, 0, 0, 0, 0, 0});  // target -2

    EXPECT_EQ(bus.send(Command::LRW, Address::logical(0), outputs).wkc, 3);
    bus.wait(1ms);
    const auto second = bus.send(Command::LRW, Address::logical(0), outputs);

    EXPECT_EQ(Bytes(second.data.begin() + 6, second.data.end()), bytes({0x50, 0x02, 0xFE, 0xFF, 0xFF, 0xFF}));
}

TEST(ProcessData, OutputsDoNothingBelowOp) {
    BusProbe bus;
    auto& slave = bus.add(small_drive(), std::make_unique<EchoModel>());
    bus.to_safeop(0);

    EXPECT_EQ(bus.write(0, 0x1800, bytes({0x0F, 0, 1, 0, 0, 0})).wkc, 1);
    bus.wait(1ms);

    EXPECT_EQ(slave.dictionary().value(0x6040, 0), 0);
}

TEST(ProcessData, PackedBitsAndGapsKeepTheirPlaces) {
    BusProbe bus;
    auto description = small_drive();
    description.rx_pdos[0].entries = {{0x6060, 0, 8}, {0, 0, 4}, {0x6040, 0, 16}};
    auto& slave = bus.add_drive({}, description);
    bus.to_preop(0);
    bus.process_managers(0, 4, 6);
    ASSERT_EQ(bus.request(0, 4), 4);
    bus.request(0, 8);

    // 8 bits FEh (-2), 4 bits gap, 16 bits 1234h from bit 12 on.
    bus.write(0, 0x1800, bytes({0xFE, 0x4F, 0x23, 0x01}));

    EXPECT_EQ(slave.dictionary().value(0x6060, 0), -2);
    EXPECT_EQ(slave.dictionary().value(0x6040, 0), 0x1234);
}

struct TerminalOnBus : testing::Test {
    TerminalOnBus() {
        auto model = std::make_unique<DigitalTerminal>();
        terminal = model.get();
        bus.add(digital_input_output_terminal(12, 10), std::move(model));
        bus.set_sync_manager(0, 0, 0x1000, 2, 0x44);
        bus.set_sync_manager(0, 1, 0x1100, 2, 0x00);
        bus.set_fmmu(0, 0, whole(0, 2, 0x1000, false));
        bus.set_fmmu(0, 1, whole(2, 2, 0x1100, true));
    }
    void to_op() {
        ASSERT_EQ(bus.request(0, 2), 2);
        ASSERT_EQ(bus.request(0, 4), 4);
        ASSERT_EQ(bus.request(0, 8), 8);
    }
    BusProbe bus;
    DigitalTerminal* terminal = nullptr;
};

TEST_F(TerminalOnBus, BringsInputsOfTheMomentAndSetsOutputs) {
    to_op();
    terminal->set_input(0, true);
    terminal->set_input(11, true);

    const auto answer = bus.send(Command::LRW, Address::logical(0), bytes({0x02, 0x02, 0, 0}));

    EXPECT_EQ(answer.wkc, 3);
    EXPECT_EQ(answer.data, bytes({0x02, 0x02, 0x01, 0x08}));
    EXPECT_TRUE(terminal->output(1));
    EXPECT_TRUE(terminal->output(9));
    EXPECT_FALSE(terminal->output(0));
}

TEST_F(TerminalOnBus, HasNoOutputsBelowOp) {
    bus.request(0, 2);
    bus.request(0, 4);
    bus.send(Command::LRW, Address::logical(0), bytes({0xFF, 0xFF, 0, 0}));
    EXPECT_FALSE(terminal->output(0));

    ASSERT_EQ(bus.request(0, 8), 8);
    bus.send(Command::LRW, Address::logical(0), bytes({0xFF, 0xFF, 0, 0}));
    EXPECT_TRUE(terminal->output(0)) << "the same frame in OP";
}

TEST_F(TerminalOnBus, LosesItsOutputsWhenTheWatchdogExpires) {
    to_op();
    bus.send(Command::LRW, Address::logical(0), bytes({0xFF, 0xFF, 0, 0}));
    ASSERT_TRUE(terminal->output(0));

    bus.wait(101ms);

    EXPECT_FALSE(terminal->output(0));
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0130), 0x14);
    EXPECT_EQ(bus.code(0), 0x001B);
}

TEST_F(TerminalOnBus, SaysInItsEepromThatItHasNoMailbox) {
    bus.write(0, 0x0502, bytes({0x00, 0x01, 0x18, 0x00, 0x00, 0x00}));
    bus.wait(1ms);
    EXPECT_EQ(bus.read(0, 0x0508, 8).data, Bytes(8));
}

TEST(Line, MarksWhatTheSlavesForwardedInTheSourceAddress) {
    BusProbe bus;
    bus.add_drive();
    bus.read(0, 0, 1);
    EXPECT_EQ(bus.source_mac_first, std::byte{0x02});
}

// DL status: bit 0 EEPROM loaded, bit 1 the application feeds the PDI watchdog, link bits 4 and 5, loop closed 8 and 10, signal 9 and 11; ports 2 and 3 do not exist (12 and 14 closed).
TEST(Line, DlStatusShowsTheNeighbours) {
    BusProbe bus;
    bus.add_drive();
    bus.add_drive();

    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0110), 0x5A33);
    EXPECT_EQ(bus.value<std::uint16_t>(1, 0x0110), 0x5613);
}

TEST(Line, APulledCableEndsTheLineThere) {
    BusProbe bus;
    for (int i = 0; i < 3; ++i) bus.add_drive();
    bus.write(2, 0x0010, le<std::uint16_t>(0x1003));

    bus.network.set_cable(2, false);
    EXPECT_EQ(bus.send(Command::BRD, Address::physical(0, 0), Bytes(1)).wkc, 2);
    EXPECT_EQ(bus.value<std::uint16_t>(1, 0x0110), 0x5613);

    bus.network.set_cable(2, true);
    EXPECT_EQ(bus.send(Command::BRD, Address::physical(0, 0), Bytes(1)).wkc, 3);
    EXPECT_EQ(bus.value<std::uint16_t>(2, 0x0010), 0x1003) << "it kept its power and its address";

    bus.network.set_cable(0, false);
    bus.read(0, 0, 1);
    EXPECT_FALSE(bus.flight.has_value());
}

TEST(Line, PowerLossForgetsEverything) {
    BusProbe bus;
    bus.add_drive();
    bus.add_drive();
    bus.write(1, 0x0010, le<std::uint16_t>(0x1002));
    bus.to_preop(1);

    bus.network.set_power(1, false);
    EXPECT_EQ(bus.send(Command::BRD, Address::physical(0, 0), Bytes(1)).wkc, 1);
    EXPECT_EQ(bus.recorders[1]->power_offs, 1);
    bus.network.set_power(1, true);

    EXPECT_EQ(bus.value<std::uint16_t>(1, 0x0010), 0);
    EXPECT_EQ(bus.value<std::uint16_t>(1, 0x0130), 1);
}

TEST(Line, LosesFramesOnDemand) {
    BusProbe bus;
    bus.add_drive();
    bus.network.lose_frames(2);
    for (const bool arrives : {false, false, true}) {
        bus.write(0, 0x0F80, bytes({1}));
        EXPECT_EQ(bus.flight.has_value(), arrives);
    }
}

TEST(Line, PortOneForcedShutEndsTheLine) {
    BusProbe bus;
    bus.add_drive();
    bus.add_drive();
    bus.write(0, 0x0101, bytes({0x0C}));
    EXPECT_EQ(bus.send(Command::BRD, Address::physical(0, 0), Bytes(1)).wkc, 1);
}

TEST(Line, OfABrokenFrameOnlyTheSourceAddressIsTouched) {
    BusProbe bus;
    bus.add_drive();
    std::array<std::byte, max_frame_size> buffer{};
    FrameBuilder builder{buffer, MacAddress{}};
    builder.add(Command::BWR, 1, Address::physical(0, 0x0010), 2)[0] = std::byte{7};
    const std::size_t size = builder.finish().size();
    buffer[14] = std::byte{0x05};  // the EtherCAT header says five bytes: the datagram does not fit

    auto expected = buffer;
    expected[6] = std::byte{0x02};
    EXPECT_TRUE(bus.network.process({buffer.data(), size}, bus.now).has_value());

    EXPECT_EQ(buffer, expected);
    EXPECT_EQ(bus.value<std::uint8_t>(0, 0x030C), 1) << "the processing unit counts it";
    EXPECT_EQ(bus.value<std::uint16_t>(0, 0x0010), 0);
}

TEST(Line, BringsTheModelsToTheTimeOfEachAdvance) {
    BusProbe bus;
    bus.add_drive();
    bus.wait(123us);
    EXPECT_EQ(bus.recorders[0]->advanced, bus.now);
}

}  // namespace
}  // namespace taktwerk::ecat::sim
