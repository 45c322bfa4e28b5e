// Points with a unit: what the field gives, through real frames, until a program, an operator and an alarm see it, and back.

#include <cmath>
#include <limits>

#include "runtime/alarms.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

ecat::ObjectEntry in_pdo(std::uint16_t index, std::uint8_t sub, ecat::DataType type, bool output) {
    ecat::ObjectEntry object;
    object.index = index, object.sub = sub;
    object.name = "value", object.type = type;
    object.access = output ? ecat::Access::rw : ecat::Access::ro;
    object.mappable = output ? ecat::Mappable::rx : ecat::Mappable::tx;
    return object;
}

/// A terminal with a mailbox: a signed 16-bit input with status bits before it, a REAL32 input, a signed 16-bit output.
std::shared_ptr<const ecat::DeviceDescription> analog_terminal() {
    using ecat::DataType;
    using ecat::SmUse;
    auto d = std::make_shared<ecat::DeviceDescription>();
    d->name = "analog";
    d->identity = {0x5457, 0xA1, 1, 0};
    d->mailbox = ecat::MailboxDescription{};
    d->sync_managers = {{SmUse::mailbox_out, 0x1000, 0x80, 0x26},
                        {SmUse::mailbox_in, 0x1080, 0x80, 0x22},
                        {SmUse::outputs, 0x1100, 0, 0x64},
                        {SmUse::inputs, 0x1180, 0, 0x20}};
    d->rx_pdos = {{0x1600, true, {{0x7000, 0x11, 16}}}};
    d->tx_pdos = {{0x1A00, true, {{0x6000, 1, 1}, {0x6000, 7, 1}, {0, 0, 14}, {0x6000, 0x11, 16}, {0x6010, 1, 32}}}};
    d->rx_assigned = {0x1600};
    d->tx_assigned = {0x1A00};
    d->objects = {in_pdo(0x6000, 1, DataType::BOOL, false), in_pdo(0x6000, 7, DataType::BOOL, false),
                  in_pdo(0x6000, 0x11, DataType::I16, false), in_pdo(0x6010, 1, DataType::REAL32, false),
                  in_pdo(0x7000, 0x11, DataType::I16, true)};
    return d;
}

/// 0 to 16 bar are 0 to 32 000 counts, -100 to 100 % -20 000 to 20 000.
MachineConfig with_analog(MachineConfig config) {
    ecat::SlaveConfig slave;
    slave.name = "analog";
    slave.device = analog_terminal();
    slave.position = static_cast<std::uint16_t>(config.bus.slaves.size());
    config.bus.slaves.push_back(slave);
    IoPoint pressure{"pressure", IoDirection::input, "analog", 0x6000, 0x11};
    pressure.unit = "bar";
    pressure.line.factor = 16.0 / 32000;
    pressure.limits = PointLimits{0.5, 15};
    pressure.status = {{PointStatus::Kind::error, 0x6000, 7}, {PointStatus::Kind::underrange, 0x6000, 1}};
    pressure.simulated = 12000;  // 6 bar
    IoPoint mass{"mass", IoDirection::input, "analog", 0x6010, 1};
    mass.unit = "kg";
    mass.line.number = PointLine::Number::real32;
    IoPoint valve{"valve", IoDirection::output, "analog", 0x7000, 0x11};
    valve.unit = "%";
    valve.line.factor = 100.0 / 20000;
    config.io.insert(config.io.end(), {pressure, mass, valve});
    return config;
}

std::size_t place_of(const std::vector<std::string>& names, std::string_view name) {
    return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}
PointValue input(TestMachine& m, std::string_view name) { return m.state().input_values[place_of(m.machine->layout().inputs, name)]; }
std::uint16_t output_index(TestMachine& m, std::string_view name) {
    return static_cast<std::uint16_t>(place_of(m.machine->layout().outputs, name));
}
bool listed(TestMachine& m, MachineAlarm alarm) {
    const auto& s = m.state();
    return std::any_of(s.alarms.begin(), s.alarms.begin() + static_cast<std::ptrdiff_t>(s.alarm_count),
                       [&](const ActiveAlarm& a) { return a.fact.id == id(alarm) && a.standing; });
}

TEST(Points, AnInputIsShownInItsUnit) {
    TestMachine m{with_analog(machine_config(1))};
    ASSERT_TRUE(m.up());
    EXPECT_DOUBLE_EQ(input(m, "pressure").value, 6.0);
    EXPECT_TRUE(input(m, "pressure").good);
    EXPECT_EQ(m.state().inputs[place_of(m.machine->layout().inputs, "pressure")], 12000) << "the raw word stays beside it";
    m.world.set_input_value("pressure", -2);
    m.world.set_input_value("mass", std::bit_cast<std::int32_t>(-12.5f));
    m.run(5ms);
    EXPECT_DOUBLE_EQ(input(m, "pressure").value, -0.001) << "signed 16 bits";
    EXPECT_DOUBLE_EQ(input(m, "mass").value, -12.5);
    EXPECT_TRUE(input(m, "mass").good);
    m.world.set_input_value("mass", std::bit_cast<std::int32_t>(std::numeric_limits<float>::quiet_NaN()));
    m.run(5ms);
    EXPECT_FALSE(input(m, "mass").good) << "no number, and no limits that would catch it";
    m.world.set_input_value("mass", std::bit_cast<std::int32_t>(3.0f));
    m.run(5ms);
    EXPECT_DOUBLE_EQ(input(m, "mass").value, 3);
    EXPECT_TRUE(input(m, "mass").good);
}

TEST(Points, AnOutputTakesItsUnitRoundsAndRefusesWhatTheTerminalCannotHold) {
    TestMachine m{with_analog(machine_config(1))};
    ASSERT_TRUE(m.up());
    const auto valve = output_index(m, "valve");
    ASSERT_EQ(m.command(OperatorAction::set_output, valve, false, 42.0026).answer, Answer::accepted);
    m.run(5ms);
    EXPECT_EQ(m.world.output_value("valve"), 8401) << "42.0026 % are 8400.52 counts";
    EXPECT_DOUBLE_EQ(m.state().output_values[valve], 42.005);
    for (const double bad : {164.0, -164.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        EXPECT_EQ(m.command(OperatorAction::set_output, valve, false, bad).answer, Answer::bad_value) << bad;
    m.run(5ms);
    EXPECT_EQ(m.world.output_value("valve"), 8401) << "what was refused changed nothing";
}

TEST(Points, ALimitRaisesOneAlarmAndNoiseAtItNoSecond) {
    TestMachine m{with_analog(machine_config(1))};
    ASSERT_TRUE(m.up());
    EXPECT_FALSE(listed(m, MachineAlarm::input_out_of_limits));
    int raised = 0;
    bool before = false;
    m.on_cycle = [&] {
        const bool now = listed(m, MachineAlarm::input_out_of_limits);
        raised += now && !before ? 1 : 0;
        before = now;
    };
    for (int i = 0; i < 100; ++i) {  // 15 bar are 30 000; 20 counts of noise around it
        m.world.set_input_value("pressure", 30000 + (i % 2 == 0 ? 20 : -20));
        m.run(2ms);
    }
    EXPECT_EQ(raised, 1);
    EXPECT_FALSE(input(m, "pressure").good);
    EXPECT_NE(m.alarms().find("15 bar"), std::string::npos) << m.alarms();
    m.world.set_input_value("pressure", 29000);
    m.run(5ms);
    EXPECT_FALSE(listed(m, MachineAlarm::input_out_of_limits));
    EXPECT_TRUE(input(m, "pressure").good);
    m.world.set_input_value("pressure", 0);
    m.run(5ms);
    EXPECT_NE(m.alarms().find("0.5 bar"), std::string::npos) << m.alarms();
}

TEST(Points, WhatTheTerminalReportsIsAnAlarmOfTheInput) {
    TestMachine m{with_analog(machine_config(1))};
    ASSERT_TRUE(m.up());
    m.world.set_input_fault("pressure", true);
    m.run(5ms);
    EXPECT_TRUE(listed(m, MachineAlarm::input_faulty));
    EXPECT_FALSE(input(m, "pressure").good);
    EXPECT_TRUE(input(m, "mass").good) << "its neighbour is innocent";
    EXPECT_NE(m.alarms().find("pressure"), std::string::npos) << m.alarms();
    m.world.set_input_fault("pressure", false);
    m.run(5ms);
    EXPECT_FALSE(listed(m, MachineAlarm::input_faulty));
    EXPECT_TRUE(input(m, "pressure").good);
}

TEST(Points, WhoseSlaveIsGoneIsNotGoodAndRaisesNothingOfItsOwn) {
    TestMachine m{with_analog(machine_config(1))};
    ASSERT_TRUE(m.up());
    m.world.set_slave_power("analog", false);
    m.run(20ms);
    EXPECT_FALSE(input(m, "pressure").good);
    EXPECT_DOUBLE_EQ(input(m, "pressure").value, 6.0) << "its last value, told to be old";
    EXPECT_FALSE(listed(m, MachineAlarm::input_faulty));
    EXPECT_FALSE(listed(m, MachineAlarm::input_out_of_limits));
}

TEST(Points, AFilterFollowsWithItsTimeConstant) {
    auto config = with_analog(machine_config(1));
    auto& pressure = *std::ranges::find(config.io, "pressure", &IoPoint::name);
    pressure.filter = 50ms;
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    EXPECT_DOUBLE_EQ(input(m, "pressure").value, 6.0) << "it begins at the first value, not at 0";
    m.world.set_input_value("pressure", 20000);  // 6 -> 10 bar
    m.run(2ms);                                  // there and back
    const double begun = input(m, "pressure").value;
    m.run(50ms);
    // A step response after one time constant: 63 %. The discrete filter with a step of T/50 is 1 % off, the beginning one cycle.
    EXPECT_NEAR((input(m, "pressure").value - begun) / (10 - begun), 1 - std::exp(-1.0), 0.015);
    m.run(500ms);
    EXPECT_NEAR(input(m, "pressure").value, 10, 0.001);
}

/// Opens the valve by as much as the pressure is above 5 bar, and writes NaN when it is told to.
class Regulator final : public Program {
public:
    Input<double> pressure;
    Output<double> valve;
    Parameter mad;
    double seen = 0;
    bool good = false;
    void declare(Declaration& d) override {
        pressure = d.input_real("pressure");
        valve = d.output_real("valve");
        mad = d.parameter("mad", {.value = 0, .minimum = 0, .maximum = 1, .kind = ParameterKind::whole});
        d.monitor("seen", seen);
        d.monitor("good", good);
        d.task<&Regulator::scan>("main");
    }
    void scan(TaskContext& ctx) noexcept {
        seen = ctx.get(pressure);
        good = ctx.good(pressure);
        if (good) ctx.set(valve, (seen - 5) * 10);
        if (ctx.get(mad) != 0) ctx.set(valve, std::numeric_limits<double>::quiet_NaN());
    }
};

class PointsInTasks : public ::testing::TestWithParam<std::uint16_t> {};

TEST_P(PointsInTasks, AProgramReadsAndWritesUnits) {
    TestMachine m{with_analog(with_program(1, entry_of<Regulator>, GetParam()))};
    ASSERT_TRUE(m.up());
    m.run(50ms);
    EXPECT_DOUBLE_EQ(variable(m, "seen"), 6.0);
    EXPECT_EQ(variable(m, "good"), 1.0);
    EXPECT_EQ(m.world.output_value("valve"), 2000) << "10 %";
    m.world.set_input_value("pressure", 14000);
    m.run(50ms);
    EXPECT_EQ(m.world.output_value("valve"), 4000);
    m.world.set_input_value("pressure", 32767);  // beyond the limits
    m.run(50ms);
    EXPECT_EQ(variable(m, "good"), 0.0);
    EXPECT_EQ(m.world.output_value("valve"), 4000) << "the program did not believe it";
    EXPECT_FALSE(listed(m, MachineAlarm::output_no_number));
    ASSERT_EQ(m.command(OperatorAction::set_parameter, 0, false, 1).answer, Answer::accepted);
    m.run(50ms);
    EXPECT_EQ(m.world.output_value("valve"), 4000) << "NaN reaches no terminal";
    EXPECT_TRUE(listed(m, MachineAlarm::output_no_number)) << m.alarms();
}
INSTANTIATE_TEST_SUITE_P(BaseAndSlow, PointsInTasks, ::testing::Values(1, 5));

TEST(PointLines, RoundToTheNearestAndClampToWhatTheBitsHold) {
    PointLine line{0.5, -10};
    line.least = -128, line.most = 127;
    EXPECT_EQ(line.raw_of(-10), 0);
    EXPECT_EQ(line.raw_of(-9.76), 0);
    EXPECT_EQ(line.raw_of(-9.74), 1);
    EXPECT_EQ(line.raw_of(1e30), 127);
    EXPECT_EQ(line.raw_of(-1e30), -128);
    EXPECT_FALSE(line.holds(53.8));
    EXPECT_TRUE(line.holds(53.5));
    EXPECT_FALSE(line.holds(std::nan("")));
    EXPECT_EQ((PointLine{2, 0, PointLine::Number::real64}.value_of(std::bit_cast<std::int64_t>(1.25))), 2.5);
    EXPECT_EQ((PointLine{2, 0, PointLine::Number::real32}.raw_of(5)), std::bit_cast<std::int32_t>(2.5f));
}

}  // namespace
}  // namespace taktwerk::runtime::testing
