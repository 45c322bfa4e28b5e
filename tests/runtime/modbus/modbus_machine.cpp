// Modbus TCP devices in a machine: their registers as points, what is said of each way to be lost, and that nobody else feels it.

#include <bit>
#include <cmath>
#include <thread>

#include <gmock/gmock.h>

#include "modbus/tcp/tcp_exchange.hpp"
#include "runtime/alarms.hpp"
#include "runtime/run/realtime_runner.hpp"
#include "tests/modbus/tcp/raw_device.hpp"
#include "tests/runtime/modbus/modbus_rig.hpp"

namespace taktwerk::runtime::testing {
namespace {

using modbus::tcp::DeviceAlarm;
using modbus::tcp::Fault;
using ::testing::HasSubstr;
using Kind = Fault::Kind;

TEST(ModbusMachine, RegistersAreInputsWithUnitAndAge) {
    ModbusRig rig;
    rig.device.registers[{Table::input, 0}] = 0xFFF6;  // -10: -1.0 bar
    rig.device.registers[{Table::input, 1}] = 0x0008;
    rig.device.registers[{Table::holding, 10}] = 0x4060;  // 3.5
    ASSERT_TRUE(rig.up());
    EXPECT_DOUBLE_EQ(rig.input("pressure").value, -1.0);
    EXPECT_TRUE(rig.input("pressure").good);
    EXPECT_EQ(rig.input("ready").value, 1);
    EXPECT_DOUBLE_EQ(rig.input("force").value, 3.5);
    EXPECT_TRUE(rig.input("force").good);
    rig.device.registers[{Table::input, 0}] = 123;
    rig.run(25ms);
    EXPECT_DOUBLE_EQ(rig.input("pressure").value, 12.3) << "after a poll and a cycle";
    EXPECT_EQ(rig.modbus_alarms().size(), 0u);
}

TEST(ModbusMachine, LimitsHoldAsForEveryInput) {
    ModbusRig rig;
    rig.device.registers[{Table::input, 0}] = 950;
    ASSERT_TRUE(rig.up());
    EXPECT_FALSE(rig.input("pressure").good) << "95 bar, limit 90";
}

// A transmitter whose sensor is off says NaN: that is told, with limits or without, and goes with the first number.
TEST(ModbusMachine, ARealInputThatIsNoNumberIsTold) {
    ModbusRig rig;
    rig.device.registers[{Table::holding, 10}] = 0x7FC0;
    ASSERT_TRUE(rig.up());
    rig.run(100ms);
    EXPECT_FALSE(rig.input("force").good);
    ASSERT_EQ(rig.standing_alarms(), 1u);
    const auto fact = rig.state().alarms[0].fact;
    EXPECT_EQ(fact.id, id(MachineAlarm::input_faulty));
    const auto words = rig.machine->describe(fact);
    EXPECT_THAT(words.english, HasSubstr("no number"));
    EXPECT_THAT(words.cause, HasSubstr("word order"));
    EXPECT_THAT(words.remedy, HasSubstr("press"));

    rig.device.registers[{Table::holding, 10}] = 0x4120;
    rig.run(100ms);
    EXPECT_EQ(rig.standing_alarms(), 0u);
    EXPECT_TRUE(rig.input("force").good);
    EXPECT_DOUBLE_EQ(rig.input("force").value, 10.0);
}

// Whose answers are late is told as who does not answer at all: a stall that begins with the one and goes on with the other is one alarm.
TEST(ModbusMachine, WhoIsLateAndThenSilentIsToldOnce) {
    auto config = with_press(machine_config(1));
    config.modbus[0].poll = config.modbus[0].max_age = 100ms;  // a write that comes between makes a reading late, without any fault
    ModbusRig rig{config};
    ASSERT_TRUE(rig.up());
    std::vector<AlarmFact> told;
    const auto watch = [&](Duration time) {
        for (Duration past{}; past < time; past += 1ms) {
            rig.run(1ms);
            for (const auto& fact : rig.modbus_alarms()) told.push_back(fact);
        }
    };
    watch(3s);
    ASSERT_FALSE(told.empty()) << "late";
    const auto late = told.size();
    rig.device.connecting = rig.device.answering = {Kind::timeout};
    watch(600ms);
    ASSERT_GT(told.size(), late + 300) << "and silent";
    for (const auto& fact : told) {
        EXPECT_EQ(fact.id, modbus::tcp::id(DeviceAlarm::silent));
        EXPECT_EQ(fact.b, told[0].b);
    }
    EXPECT_EQ(rig.machine->describe(told[0]).english.find("function"), std::string::npos) << "no request is to blame";
}

TEST(ModbusMachine, OutputsHaveTheirSafeValuesFirstAndThenWhatIsGiven) {
    ModbusRig rig;
    ASSERT_TRUE(rig.up());
    EXPECT_EQ(rig.at(Table::coil, 3), 1);
    EXPECT_EQ(rig.at(Table::holding, 20), 50);
    ASSERT_EQ(rig.set_output("speed", 12.3), Answer::accepted);
    ASSERT_EQ(rig.set_output("lamp2", 0), Answer::accepted);
    rig.run(10ms);
    EXPECT_EQ(rig.at(Table::holding, 20), 123);
    EXPECT_EQ(rig.at(Table::coil, 3), 0);
    EXPECT_EQ(rig.set_output("speed", 6553.6), Answer::bad_value) << "beyond 16 bits";
}

TEST(ModbusMachine, TheEndLeavesTheSafeValuesAtTheDevice) {
    ModbusRig rig;
    ASSERT_TRUE(rig.up());
    ASSERT_EQ(rig.set_output("speed", 12.3), Answer::accepted);
    ASSERT_EQ(rig.set_output("lamp2", 0), Answer::accepted);
    rig.run(10ms);
    rig.runner->shut_down();
    EXPECT_EQ(rig.at(Table::coil, 3), 1);
    EXPECT_EQ(rig.at(Table::holding, 20), 50);
    EXPECT_FALSE(rig.device.connected());
}

struct Loss {
    const char* what;
    Fault connecting, answering;
    DeviceAlarm alarm;
    const char* cause;
};

class ModbusLoss : public ::testing::TestWithParam<Loss> {};

// A cause, an alarm: with the device, its address, and a remedy. Inputs keep their values and are not good; the bus and its axis feel nothing.
TEST_P(ModbusLoss, IsToldWithItsCauseAndGoesWhenTheDeviceIsBack) {
    ModbusRig rig;
    rig.device.registers[{Table::input, 0}] = 50;
    ASSERT_TRUE(rig.up());
    rig.device.connecting = GetParam().connecting;
    rig.device.answering = GetParam().answering;
    rig.device.registers[{Table::input, 0}] = 70;
    rig.run(70ms);  // the last reading was a poll ago at most, 20 ms and the turns of a few requests
    EXPECT_TRUE(rig.modbus_alarms().empty()) << "younger than max_age";
    rig.run(80ms);

    ASSERT_EQ(rig.modbus_alarms().size(), 1u) << "one cause is one alarm";
    const auto fact = rig.modbus_alarms()[0];
    EXPECT_EQ(fact.id, modbus::tcp::id(GetParam().alarm));
    const auto words = rig.machine->describe(fact);
    EXPECT_EQ(words.source, "Modbus device 'press'");
    EXPECT_THAT(words.english, HasSubstr("192.0.2.7 port 502, unit 1"));
    EXPECT_THAT(words.cause, HasSubstr(GetParam().cause));
    EXPECT_FALSE(words.remedy.empty());
    EXPECT_DOUBLE_EQ(rig.input("pressure").value, 5.0) << "the last one";
    EXPECT_FALSE(rig.input("pressure").good);
    EXPECT_EQ(rig.standing_alarms(), 1u) << "nobody else complains";
    EXPECT_EQ(rig.state().bus.frames_lost, 0u);

    rig.device.connecting = rig.device.answering = {};
    rig.run(1s);
    EXPECT_TRUE(rig.modbus_alarms().empty());
    EXPECT_DOUBLE_EQ(rig.input("pressure").value, 7.0);
    EXPECT_TRUE(rig.input("pressure").good);
}

INSTANTIATE_TEST_SUITE_P(
    Each, ModbusLoss,
    ::testing::Values(Loss{"refused", {Kind::refused}, {Kind::closed}, DeviceAlarm::refused, "nobody listens at the port"},
                      Loss{"unreachable", {Kind::unreachable}, {Kind::timeout}, DeviceAlarm::unreachable, "network port of this computer"},
                      Loss{"half_open", {Kind::timeout}, {Kind::timeout}, DeviceAlarm::silent, "no supply"},
                      Loss{"slow_or_wrong_unit", {}, {Kind::timeout}, DeviceAlarm::silent, "`unit`"},
                      Loss{"closed", {}, {Kind::closed}, DeviceAlarm::closed, "fewer clients"},
                      Loss{"gateway", {}, {Kind::exception, 11}, DeviceAlarm::exception, "nobody behind the gateway has this unit"},
                      Loss{"short_answer", {}, {Kind::bad_answer}, DeviceAlarm::wrong_answer, "shorter"}),
    [](const auto& one) { return one.param.what; });

TEST(ModbusMachine, AnExceptionNamesItsRequestAndSparesTheOthers) {
    ModbusRig rig;
    rig.device.refused_at[{Table::holding, 10}] = {Kind::exception, 2};
    rig.device.registers[{Table::input, 0}] = 50;
    ASSERT_TRUE(rig.up());
    rig.run(200ms);
    ASSERT_EQ(rig.modbus_alarms().size(), 1u);
    const auto words = rig.machine->describe(rig.modbus_alarms()[0]);
    EXPECT_THAT(words.english, HasSubstr("exception 2"));
    EXPECT_THAT(words.english, HasSubstr("function 3, holding registers 10 to 11"));
    EXPECT_THAT(words.cause, HasSubstr("illegal data address"));
    EXPECT_TRUE(rig.input("pressure").good);
    EXPECT_FALSE(rig.input("force").good);
}

TEST(ModbusMachine, AnOutputThatIsNotTakenIsToldToo) {
    ModbusRig rig;
    ASSERT_TRUE(rig.up());
    ASSERT_EQ(rig.set_output("lamp2", 0), Answer::accepted);
    rig.run(10ms);
    ASSERT_EQ(rig.at(Table::coil, 3), 0) << "confirmed now";
    rig.device.refused_at[{Table::coil, 3}] = {Kind::exception, 4};
    rig.run(570ms);
    EXPECT_TRUE(rig.modbus_alarms().empty()) << "refresh and max_age have not passed";
    rig.run(60ms);
    ASSERT_EQ(rig.modbus_alarms().size(), 1u);
    EXPECT_THAT(rig.machine->describe(rig.modbus_alarms()[0]).english, HasSubstr("function 5, coils 3"));
}

TEST(ModbusMachine, ADeviceThatIsNeverThereDoesNotKeepTheMachineFromStarting) {
    ModbusRig rig;
    rig.device.connecting = {Kind::unreachable};
    ASSERT_TRUE(rig.up());
    rig.run(200ms);
    ASSERT_EQ(rig.modbus_alarms().size(), 1u);
    EXPECT_EQ(rig.modbus_alarms()[0].id, modbus::tcp::id(DeviceAlarm::unreachable));
    EXPECT_EQ(rig.state().phase, MachinePhase::running);
    EXPECT_FALSE(rig.input("pressure").good);
}

TEST(ModbusMachine, ASimulatedDeviceTakesWhatTheWorldGivesIt) {
    auto config = with_press(machine_config(1));
    config.modbus[0].host.clear();
    VirtualClock clock{Instant{} + 1s};
    World world{config, clock.now()};
    auto built = Machine::build(config, world.bus(), world.serial().lines(), world.modbus().exchanges());
    ASSERT_EQ(built.index(), 0u);
    auto& machine = *std::get<0>(built);
    VirtualRunner runner{machine, world, clock};
    world.set_input_value("pressure", 42);
    ASSERT_TRUE(runner.bring_up().ok());
    runner.run_for(50ms);
    const auto pressure = ModbusRig::place(machine.layout().inputs, "pressure");
    EXPECT_DOUBLE_EQ(machine.latest()->input_values[pressure].value, 4.2);
    EXPECT_EQ(world.output_value("speed"), 50);
    world.set_slave_power("press", false);
    runner.run_for(200ms);
    EXPECT_FALSE(machine.latest()->input_values[pressure].good);
}

// --- what a configuration may not be -------------------------------------------------------------------------------------------

std::string refusal(const MachineConfig& config) {
    VirtualClock clock{Instant{} + 1s};
    World world{machine_config(1), clock.now()};
    ScriptedDevice device;
    const auto built = Machine::build(config, world.bus(), world.serial().lines(), {&device});
    std::string out;
    if (const auto* errors = std::get_if<1>(&built))
        for (const auto& error : *errors) out += error.code + ": " + error.text() + "\n";
    return out;
}

TEST(ModbusMachine, RefusesWhatCannotWork) {
    const auto good = with_press(machine_config(1));
    EXPECT_EQ(refusal(good), "");
    auto bad = good;
    bad.modbus[0].host = "press.local";
    EXPECT_THAT(refusal(bad), HasSubstr("modbus.host"));
    bad = good;
    bad.modbus[0].unit = 248;
    EXPECT_THAT(refusal(bad), HasSubstr("modbus.unit"));
    bad = good;
    bad.modbus[0].timeout = 3s;
    EXPECT_THAT(refusal(bad), HasSubstr("modbus.timeout"));
    bad = good;
    bad.modbus[0].max_age = 10ms;
    EXPECT_THAT(refusal(bad), HasSubstr("modbus.max_age"));
    bad = good;
    bad.modbus[0].channels[4].table = Table::input;
    EXPECT_THAT(refusal(bad), HasSubstr("modbus.read_only"));
    bad = good;
    bad.modbus[0].channels[4].type = NumberType::boolean;
    EXPECT_THAT(refusal(bad), HasSubstr("modbus.bit_written"));
    bad = good;
    bad.emergency_stop.input = "ready";
    EXPECT_THAT(refusal(bad), HasSubstr("modbus.not_for_this"));
    bad = good;
    bad.modbus[0].name = bad.bus.slaves[0].name;
    EXPECT_THAT(refusal(bad), HasSubstr("config.duplicate_name"));
}

TEST(ModbusMachine, WantsAnExchangeForEachDevice) {
    VirtualClock clock{Instant{} + 1s};
    const auto config = with_press(machine_config(1));
    World world{config, clock.now()};
    const auto built = Machine::build(config, world.bus(), world.serial().lines());
    ASSERT_EQ(built.index(), 1u);
    EXPECT_EQ(std::get<1>(built)[0].code, "modbus.no_exchange");
}

// --- in real time, over a socket ------------------------------------------------------------------------------------------------

// The device answers nothing: its thread waits all the time, and the machine comes up, runs and ends as if it were not there.
TEST(ModbusMachine, ADeviceThatHangsHoldsUpNeitherTheCycleNorTheEnd) {
    auto config = with_press(machine_config(0));
    config.modbus[0].host = "127.0.0.1";
    config.modbus[0].timeout = 300ms;
    config.simulation.supervision = Supervision::relaxed;
    config.realtime.priority = 0;
    config.realtime.lock_memory = false;
    modbus::tcp::testing::RawDevice silent{[](int, const auto&) {}};
    config.modbus[0].port = silent.port();
    SystemClock clock;
    World world{config, clock.now()};
    modbus::tcp::TcpExchange exchange{config.modbus[0]};
    auto built = Machine::build(config, world.bus(), world.serial().lines(), {&exchange});
    ASSERT_EQ(built.index(), 0u);
    auto& machine = *std::get<0>(built);
    RealtimeRunner runner{machine, &world};
    ASSERT_TRUE(runner.start().ok());
    bool told = false;
    Instant asked{};
    const auto ok = runner.serve([&](Instant now) {
        const auto* s = machine.latest();
        for (std::size_t i = 0; s != nullptr && i < s->alarm_count; ++i)
            told = told || s->alarms[i].fact.id == modbus::tcp::id(DeviceAlarm::silent);
        if (told && asked == Instant{}) asked = now;
        return !told;
    });
    EXPECT_TRUE(ok.ok());
    runner.finish();
    EXPECT_TRUE(told);
    EXPECT_LT(clock.now() - asked, 3s) << "its last request ends with its timeout";
}

}  // namespace
}  // namespace taktwerk::runtime::testing
