// Modbus TCP devices of a machine file: what the example loads as. What must be refused: tests/config/bad/modbus_*.yaml.

#include <gtest/gtest.h>

#include <algorithm>

#include "config/machine_file/machine_loader.hpp"

namespace taktwerk::config {
namespace {

using namespace std::chrono_literals;
using modbus::tcp::Channel;
using modbus::tcp::NumberType;

LoadResult load_example(bool simulate) {
    LoadOptions options;
    options.simulate = simulate;
    return load_machine(std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/press-valves.yaml", options);
}

const runtime::IoPoint& point_named(const runtime::MachineConfig& machine, const std::string& name) {
    return *std::ranges::find(machine.io, name, &runtime::IoPoint::name);
}

TEST(ModbusTcpFile, TheExampleLoadsAsItIsWritten) {
    const auto result = load_example(false);
    ASSERT_EQ(result.index(), 0u) << std::get<1>(result)[0].text();
    const auto& machine = std::get<0>(result).machine;
    ASSERT_EQ(machine.modbus.size(), 1u);
    const auto& device = machine.modbus[0];
    EXPECT_EQ(device.name, "valves");
    EXPECT_EQ(device.host, "192.168.1.50");
    EXPECT_EQ(device.port, 502) << "the default";
    EXPECT_EQ(device.timeout, 200ms);
    ASSERT_EQ(device.channels.size(), 6u);
    EXPECT_EQ(device.channels[0].type, NumberType::boolean) << "a discrete input, without `type`";
    EXPECT_EQ(device.channels[2].order, modbus::tcp::WordOrder::low_first);
    EXPECT_EQ(device.channels[3].bit, 3);
    EXPECT_EQ(device.channels[4].use, Channel::Use::written);
    EXPECT_EQ(device.channels[0].use, Channel::Use::read);

    const auto& pressure = point_named(machine, "tank_pressure");
    ASSERT_TRUE(pressure.beside);
    EXPECT_EQ(pressure.beside->bits, 16);
    EXPECT_TRUE(pressure.beside->is_signed);
    EXPECT_EQ(pressure.index, 1) << "the second register";
    EXPECT_DOUBLE_EQ(pressure.line.value_of(13824), 8) << "half of 27648 is half of 16 bar";
    EXPECT_EQ(point_named(machine, "flow").line.number, PointLine::Number::real32);
    EXPECT_FALSE(point_named(machine, "door_closed").beside);
}

TEST(ModbusTcpFile, InASimulationNobodyIsCalled) {
    const auto result = load_example(true);
    ASSERT_EQ(result.index(), 0u);
    EXPECT_EQ(std::get<0>(result).machine.modbus[0].host, "");
}

}  // namespace
}  // namespace taktwerk::config
