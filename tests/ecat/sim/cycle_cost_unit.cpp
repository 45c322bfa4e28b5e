// The cyclic path allocates nothing.

#include <gtest/gtest.h>

#include "core/guard/allocation_guard.hpp"
#include "ecat/sim/digital_terminal.hpp"
#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::sim {
namespace {

class SilentModel : public DeviceModel {
public:
    void power_on(ObjectDictionary&, Instant) override {}
    void exchange(Instant) override { ++exchanges; }
    std::size_t exchanges = 0;
};

TEST(CycleCost, AThousandCyclesOfThreeDrivesAndATerminalAllocateNothing) {
    // Given three drives on SYNC0 and a terminal in OP, and one frame: FRMW of the time, LRW, BRD of the states
    BusProbe bus;
    auto description = small_drive();
    description.dc.supported = true;
    std::vector<SilentModel*> models;
    for (int i = 0; i < 3; ++i) {
        auto model = std::make_unique<SilentModel>();
        models.push_back(model.get());
        bus.add(description, std::move(model), {.drift_ppm = 10.0 * i});
    }
    bus.add(digital_input_output_terminal(8, 8), std::make_unique<DigitalTerminal>());
    const auto map = [&](std::uint16_t position, unsigned n, std::uint32_t logical, std::uint16_t length, std::uint16_t physical,
                         bool read) {
        Fmmu f;
        f.logical_start = logical, f.length = length, f.physical_start = physical, f.read = read, f.write = !read, f.active = true;
        bus.set_fmmu(position, n, f);
    };
    for (std::uint16_t i = 0; i < 3; ++i) {
        bus.to_preop(i);
        bus.process_managers(i);
        bus.write(i, reg::dc_start_time, le<std::int64_t>(bus.value<std::int64_t>(i, reg::dc_system_time) + 20'000'000));
        bus.write(i, reg::dc_sync0_cycle, le<std::uint32_t>(1'000'000));
        bus.write(i, reg::dc_activation, bytes({3}));
        bus.request(i, 4);
        bus.request(i, 8);
        map(i, 0, i * 6u, 6, 0x1800, false);
        map(i, 1, 19u + i * 6u, 6, 0x1C00, true);
    }
    bus.set_sync_manager(3, 0, 0x1000, 1, 0x44);
    bus.set_sync_manager(3, 1, 0x1100, 1, 0x00);
    map(3, 0, 18, 1, 0x1000, false);
    map(3, 1, 37, 1, 0x1100, true);
    for (const std::uint16_t state : {std::uint16_t{2}, std::uint16_t{4}, std::uint16_t{8}}) bus.request(3, state);
    bus.wait(10ms);
    std::array<std::byte, max_frame_size> buffer{};
    FrameBuilder builder{buffer, MacAddress{}};
    builder.add(Command::ARMW, 1, Address::position(0, reg::dc_system_time), 8);
    builder.add(Command::LRW, 2, Address::logical(0), 38);
    builder.add(Command::BRD, 3, Address::physical(0, reg::al_status), 2);
    const std::size_t size = builder.finish().size();
    const auto fresh = buffer;

    // when a thousand cycles pass
    const std::size_t exchanges = models[0]->exchanges;
    const NoAllocationScope scope;
    for (int i = 0; i < 1000; ++i) {
        buffer = fresh;
        (void)bus.network.process({buffer.data(), size}, bus.now);
        bus.now += 1ms;
        bus.network.advance(bus.now);
    }
    const auto heap = scope.used();

    // then nothing was allocated, and the cycles were real ones
    EXPECT_EQ(heap.total(), 0u) << heap.text();
    EXPECT_NEAR(static_cast<double>(models[0]->exchanges - exchanges), 1000.0, 1.0);
    FrameReader reader{std::span<const std::byte>{buffer.data(), size}};
    EXPECT_EQ(reader.next()->working_counter(), 3);   // one reads, two write; the terminal has no DC
    EXPECT_EQ(reader.next()->working_counter(), 12);  // four slaves, 3 each
    const auto states = reader.next();
    EXPECT_EQ(states->working_counter(), 4);
    EXPECT_EQ(states->data[0], std::byte{8});
}

}  // namespace
}  // namespace taktwerk::ecat::sim
