#pragma once
// A machine in virtual time with a bus, an axis and a Modbus device whose other end the test holds.

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "modbus/tcp/alarms.hpp"
#include "modbus/tcp/channel_words.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/run/virtual_runner.hpp"
#include "runtime/world/world.hpp"
#include "tests/machines/plain_machine.hpp"
#include "tests/machines/replay_check.hpp"
#include "tests/modbus/tcp/scripted_device.hpp"

namespace taktwerk::runtime::testing {

using modbus::tcp::Channel;
using modbus::tcp::DeviceConfig;
using modbus::tcp::NumberType;
using modbus::tcp::Table;
using modbus::tcp::testing::ScriptedDevice;

/// Device `press`: pressure (input register 0, int16, 0.1 bar), ready (bit 3 of input register 1), force (holding 10, float32),
/// lamp2 (coil 3, safe 1), speed (holding 20, safe 5 %).
inline MachineConfig with_press(MachineConfig config) {
    DeviceConfig device;
    device.name = "press";
    device.host = "192.0.2.7";  // TEST-NET-1: nobody's
    device.poll = 20ms, device.timeout = 200ms, device.max_age = 100ms, device.refresh = 500ms;
    const auto add = [&](const char* name, Table table, std::uint16_t address, NumberType type, IoDirection direction) -> IoPoint& {
        Channel channel;
        channel.name = name, channel.table = table, channel.address = address, channel.type = type;
        channel.use = direction == IoDirection::input ? Channel::Use::read : Channel::Use::written;
        device.channels.push_back(channel);
        IoPoint point{name, direction, "press", static_cast<std::uint16_t>(device.channels.size() - 1), 0};
        point.beside = modbus::tcp::signal_of(type);
        config.io.push_back(point);
        return config.io.back();
    };
    auto& pressure = add("pressure", Table::input, 0, NumberType::int16, IoDirection::input);
    pressure.unit = "bar", pressure.line.factor = 0.1, pressure.limits = PointLimits{-5, 90};
    add("ready", Table::input, 1, NumberType::boolean, IoDirection::input);
    device.channels.back().bit = 3;
    add("force", Table::holding, 10, NumberType::float32, IoDirection::input).line.number = PointLine::Number::real32;
    add("lamp2", Table::coil, 3, NumberType::boolean, IoDirection::output).safe_value = 1;
    auto& speed = add("speed", Table::holding, 20, NumberType::uint16, IoDirection::output);
    speed.unit = "%", speed.line.factor = 0.1, speed.safe_value = 50;
    config.modbus.push_back(device);
    return config;
}

class ModbusRig {
public:
    explicit ModbusRig(const MachineConfig& config = with_press(machine_config(1))) : clock(Instant{} + 1s), world(config, clock.now()) {
        auto built = Machine::build(config, world.bus(), world.serial().lines(), {&device});
        if (auto* errors = std::get_if<1>(&built)) {
            for (const auto& error : *errors) ADD_FAILURE() << error.text();
            return;
        }
        machine = std::move(std::get<0>(built));
        runner = std::make_unique<VirtualRunner>(*machine, world, clock);
        replayed.watch(*machine, runner.get(), clock.now());
    }
    bool up() {
        const auto ok = runner->bring_up();
        if (!ok) ADD_FAILURE() << ok.error().text();
        run(50ms);
        return ok.ok();
    }
    void run(Duration time) { runner->run_for(time); }
    const Snapshot& state() { return *machine->latest(); }
    static std::size_t place(const std::vector<std::string>& names, std::string_view name) {
        return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    }
    PointValue input(std::string_view name) { return state().input_values[place(machine->layout().inputs, name)]; }
    Answer set_output(std::string_view name, double value) {
        OperatorCommand c;
        c.action = OperatorAction::set_output;
        c.axis = c.index = static_cast<std::uint16_t>(place(machine->layout().outputs, name));
        c.value = value;
        c.client = 1;
        c.sequence = ++sequence_;
        EXPECT_TRUE(machine->submit(c));
        for (int i = 0; i < 10; ++i) {
            run(machine->config().cycle);
            while (auto answer = machine->next_answer())
                if (answer->sequence == sequence_) return answer->answer;
        }
        ADD_FAILURE() << "no answer";
        return {};
    }
    std::uint16_t at(Table table, std::uint16_t address) { return device.registers[{table, address}]; }
    /// Those that stand, of the Modbus floor.
    std::vector<AlarmFact> modbus_alarms() {
        std::vector<AlarmFact> out;
        const auto& s = state();
        for (std::size_t i = 0; i < s.alarm_count; ++i)
            if (s.alarms[i].standing && find_alarm(modbus::tcp::device_alarms, s.alarms[i].fact.id) != nullptr)
                out.push_back(s.alarms[i].fact);
        return out;
    }
    std::size_t standing_alarms() {
        const auto& s = state();
        std::size_t count = 0;
        for (std::size_t i = 0; i < s.alarm_count; ++i) count += s.alarms[i].standing ? 1 : 0;
        return count;
    }

    VirtualClock clock;
    World world;
    ScriptedDevice device;
    ReplayCheck replayed;
    std::unique_ptr<Machine> machine;
    std::unique_ptr<VirtualRunner> runner;

private:
    std::uint64_t sequence_ = 0;
};

}  // namespace taktwerk::runtime::testing
