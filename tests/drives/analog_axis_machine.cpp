// An axis over +-10 V as config/machines/analog-axis.yaml ships it: amplifier and motor are played at the terminals, the encoder at its counter, everything
// goes over real frames. 10 V are 500 mm/s, a count is 1 um, kv 20/s, the amplifier lags 8 ms; limits 400 mm/s and 2000 mm/s2.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "axes/axis/alarms.hpp"
#include "config/machine_file/machine_loader.hpp"
#include "fb_library/all_blocks.hpp"
#include "runtime/check/machine_remarks.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::AxisAlarm;
using axes::AxisState;
using ::testing::HasSubstr;

using Changes = std::vector<std::pair<std::string, std::string>>;

const std::string analog_file = std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/analog-axis.yaml";

/// The shipped file, by hand as fast as otherwise, with some of its text exchanged; the first place of each.
std::variant<config::LoadedMachine, std::vector<Error>> load_analog(const Changes& changes) {
    std::ifstream in(analog_file);
    std::stringstream all;
    all << in.rdbuf();
    auto text = all.str();
    text.replace(text.find("    homing:"), 0, "    manual: { slow: 50 mm/s, fast: 400 mm/s }\n");
    for (const auto& [from, to] : changes) {
        const auto at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        if (at != std::string::npos) text.replace(at, from.size(), to);
    }
    return config::load_machine_text(analog_file, text, {});
}

MachineConfig analog_machine(const Changes& changes = {}) {
    auto loaded = load_analog(changes);
    if (auto* errors = std::get_if<std::vector<Error>>(&loaded)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return machine_config(1);
    }
    return std::get<config::LoadedMachine>(std::move(loaded)).machine;
}

std::string analog_problem(const Changes& changes) {
    auto loaded = load_analog(changes);
    const auto* errors = std::get_if<std::vector<Error>>(&loaded);
    if (errors == nullptr) return "none";
    std::string out;
    for (const auto& error : *errors) out += error.code + ": " + error.what + ". " + error.remedy + "\n";
    return out;
}

const std::pair<std::string, std::string> unhomed{"    homing:", "    require_homed: false\n    homing:"};
const std::pair<std::string, std::string> reversed{"drift: 20 mV }", "drift: 20 mV, reversed: true }"};

/// The machine with its motor, and what its wires were given in each cycle.
struct AnalogMachine : TestMachine {
    explicit AnalogMachine(const Changes& changes = {}) : TestMachine(analog_machine(changes)) {}
    /// The file is changed; what stands there is another.
    AnalogMachine(const Changes& changes, const MachineConfig& there) : TestMachine(analog_machine(changes), there) {}
    AnalogMotor& motor() { return *world.analog_motor("x"); }
    bool enabled() { return world.output("x_enable"); }
    /// V at the amplifier; 16 bits of which 32767 are 10 V.
    double volts() { return static_cast<double>(world.output_value("x_speed")) * 10 / 32767; }
    void happens(SimulationEvent::Kind kind, std::int64_t value) {
        SimulationEvent event;
        event.kind = kind;
        event.target = "x";
        event.value = value;
        world.happen(event);
    }
    void reset_and_enable() {
        EXPECT_EQ(command(OperatorAction::reset).answer, Answer::accepted);
        EXPECT_TRUE(until([&] { return axis(0).state != AxisState::ErrorStop; }, 3s)) << alarms();
        enable(0);
    }
    bool arrive(double u, double velocity, Duration patience = 10s) {
        EXPECT_EQ(command(OperatorAction::move_absolute, 0, false, u, velocity).answer, Answer::accepted);
        return until(
            [&] { return axis(0).state == AxisState::Standstill && axis(0).in_position && std::abs(axis(0).set_position - u) < 1e-9; },
            patience);
    }
};

TEST(AnalogAxis, HomesToItsSwitchMovesAndStands) {
    AnalogMachine m;
    ASSERT_TRUE(m.up());
    EXPECT_FALSE(m.enabled());
    EXPECT_EQ(m.volts(), 0);
    m.enable(0);
    m.home(0);
    // The switch lets go at 0 of the mechanics; at 4 mm/s three cycles are 0.012 mm.
    EXPECT_NEAR(m.motor().position() - m.axis(0).actual_position, 0, 0.02);

    double worst = 0, fastest = 0;
    m.on_cycle = [&] {
        worst = std::max(worst, std::abs(m.axis(0).following_error));
        fastest = std::max(fastest, m.motor().velocity());
    };
    ASSERT_TRUE(m.arrive(500, 400)) << m.alarms();
    m.on_cycle = {};
    EXPECT_NEAR(m.motor().position(), 500, 0.05 + 0.02) << "its window";
    EXPECT_LT(worst, 5) << "2000 mm/s2 of lag of 8 ms and 3 cycles of dead time, 22 mm/s over kv, and the integral part";
    EXPECT_NEAR(fastest, 400, 30);
    m.run(5s);
    EXPECT_NEAR(m.axis(0).following_error, 0, 0.003) << "the offset takes the drift away, the integral part the rest in ten of its times";
    EXPECT_NEAR(m.motor().velocity(), 0, 0.5);
    EXPECT_EQ(m.alarms(), "");
    m.expect_no_jump();
}

TEST(AnalogAxis, JogsAndStopsByHand) {
    AnalogMachine m;
    ASSERT_TRUE(m.up());
    m.enable(0);
    ASSERT_EQ(m.command(OperatorAction::jog, 0, true, 50).answer, Answer::accepted);
    for (int i = 0; i < 10; ++i) {
        m.run(50ms);
        (void)m.command(OperatorAction::jog, 0, false, 50);
    }
    EXPECT_NEAR(m.motor().velocity(), 50, 2);
    ASSERT_EQ(m.command(OperatorAction::stop, 0).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::Standstill; }, 1s)) << m.alarms();
    m.run(300ms);
    EXPECT_NEAR(m.motor().velocity(), 0, 0.5);
    EXPECT_EQ(m.alarms(), "");
    m.expect_no_jump();
}

/// MC_Power, MC_Home, MC_MoveAbsolute, MC_Stop, one after the other, as for any drive.
class Cycles final : public Program {
public:
    AxisRef x;
    fb::MC_Power power;
    fb::MC_Home home;
    fb::MC_MoveAbsolute move, cut_short;
    fb::MC_Stop stop;
    double step = 0;
    std::int64_t errors = 0;
    void declare(Declaration& d) override {
        x = d.axis("x");
        d.monitor("step", step);
        d.monitor("errors", errors);
        d.task<&Cycles::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power.Axis = home.Axis = move.Axis = cut_short.Axis = stop.Axis = x;
        power.Enable = true;
        power(ctx);
        home.Execute = power.Status;
        home(ctx);
        move.Position = 300;
        move.Velocity = 300;
        move.Execute = home.Done || step > 0;
        move(ctx);
        cut_short.Position = 0;
        cut_short.Velocity = 300;
        cut_short.Execute = move.Done || step > 1;
        cut_short(ctx);
        stop.Deceleration = 1500;
        stop.Execute = step > 1 && (ctx.view(x)->set_velocity < -290 || stop.Busy || stop.Done);
        stop(ctx);
        if (home.Done && step == 0) step = 1;
        if (move.Done && step == 1) step = 2;
        if (stop.Done && cut_short.CommandAborted) step = 3;
        errors += power.Error || home.Error || move.Error || cut_short.Error || stop.Error ? 1 : 0;
    }
};

TEST(AnalogAxis, TheBlocksWorkAsForAnyDrive) {
    auto config = analog_machine();
    config.start_mode = Mode::automatic;
    add_program(config, "p", &entry_of<Cycles>);
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return variable(m, "step") == 3; }, 40s)) << m.alarms() << variable(m, "step");
    EXPECT_EQ(variable(m, "errors"), 0);
    m.run(500ms);
    EXPECT_NEAR(m.world.analog_motor("x")->velocity(), 0, 0.5);
    EXPECT_GT(m.world.analog_motor("x")->position(), 50) << "it was stopped on its way";
    EXPECT_EQ(m.alarms(), "");
    m.expect_no_jump();
}

// The encoder counts the wrong way. At standstill the drift of 20 mV (1 mm/s) starts it: at 2 mm of runaway it has kv x 2 mm = 40 mm/s and what it gained
// in some cycles; 8 ms of lag and 4 cycles of dead time are another 0.5 mm.
TEST(AnalogAxis, AnEncoderWiredTheOtherWayRoundIsStoppedWithinItsDistance) {
    AnalogMachine m({reversed, {"offset: -20 mV", "offset: 0 mV"}, unhomed});
    ASSERT_TRUE(m.up());
    const double start = m.motor().position();
    ASSERT_EQ(m.command(OperatorAction::power, 0, true).answer, Answer::accepted);
    double furthest = 0;
    m.on_cycle = [&] { furthest = std::max(furthest, std::abs(m.motor().position() - start)); };
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::ErrorStop; }, 10s)) << m.alarms();
    m.run(5ms);
    EXPECT_TRUE(m.has_alarm(id(AxisAlarm::drive_polarity))) << m.alarms();
    EXPECT_THAT(m.alarms(), HasSubstr("wired against each other"));
    EXPECT_EQ(m.volts(), 0);
    EXPECT_TRUE(m.enabled()) << "it brakes";
    m.run(300ms);
    EXPECT_FALSE(m.enabled());
    m.run(1s);
    EXPECT_GT(furthest, 2);
    EXPECT_LT(furthest, 3);
    m.on_cycle = {};
}

// The same in a move that begins at once: with 2000 mm/s2 and its jerk it has at most 90 mm/s and kv x 4 mm more after 2 mm.
TEST(AnalogAxis, AMoveTheWrongWayIsStoppedWithinItsDistance) {
    AnalogMachine m({reversed, unhomed});
    ASSERT_TRUE(m.up());
    m.enable(0);
    const double start = m.motor().position();
    ASSERT_EQ(m.command(OperatorAction::move_absolute, 0, false, m.axis(0).set_position + 100, 400).answer, Answer::accepted);
    double furthest = 0;
    m.on_cycle = [&] { furthest = std::max(furthest, std::abs(m.motor().position() - start)); };
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::ErrorStop; }, 1s)) << m.alarms();
    m.run(1s);
    EXPECT_TRUE(m.has_alarm(id(AxisAlarm::drive_polarity))) << m.alarms();
    EXPECT_LT(furthest, 2 + 2.5) << "170 mm/s over 8 ms of lag and 4 cycles";
    m.on_cycle = {};
}

// Each remedy that the alarm names, at a machine that is wired the other way round and stays so.
TEST(AnalogAxis, EitherRemedyOfThePolarityAlarmIsOne) {
    const auto there = analog_machine({reversed});
    for (const Changes& told : {Changes{unhomed, {"feed: 10 mm }", "feed: 10 mm, inverted: true }"}},
                                Changes{unhomed, {"velocity_at_10V: 500", "velocity_at_10V: -500"}}}) {
        SCOPED_TRACE(told.back().second);
        AnalogMachine m(told, there);
        ASSERT_TRUE(m.up());
        m.enable(0);
        ASSERT_TRUE(m.arrive(m.axis(0).set_position + 50, 200)) << m.alarms();
        EXPECT_EQ(m.alarms(), "");
    }
}

TEST(AnalogAxis, WithoutReadyItIsNotEnabledAndTheInputIsNamed) {
    AnalogMachine m;
    ASSERT_TRUE(m.up());
    m.happens(SimulationEvent::Kind::main_power, 0);
    m.run(10ms);
    ASSERT_EQ(m.command(OperatorAction::power, 0, true).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::ErrorStop; }, 4s)) << m.alarms();
    m.run(5ms);
    EXPECT_TRUE(m.has_alarm(id(AxisAlarm::drive_not_ready))) << m.alarms();
    EXPECT_FALSE(m.has_alarm(id(AxisAlarm::enable_timeout))) << m.alarms();
    EXPECT_FALSE(m.enabled());
    m.happens(SimulationEvent::Kind::main_power, 1);
    m.run(10ms);
    m.reset_and_enable();
    EXPECT_EQ(m.alarms(), "");
}

TEST(AnalogAxis, ReadyThatGoesInAMoveTakesEnableAndPower) {
    AnalogMachine m({unhomed});
    ASSERT_TRUE(m.up());
    m.enable(0);
    ASSERT_EQ(m.command(OperatorAction::move_absolute, 0, false, m.axis(0).set_position + 300, 300).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.motor().velocity() > 290; }, 2s));
    m.happens(SimulationEvent::Kind::main_power, 0);
    ASSERT_TRUE(m.until([&] { return !m.enabled(); }, 6ms));
    EXPECT_EQ(m.volts(), 0);
    m.run(5ms);
    EXPECT_TRUE(m.has_alarm(id(AxisAlarm::drive_power_lost))) << m.alarms();
    EXPECT_EQ(m.axis(0).state, AxisState::ErrorStop);
}

// In full motion a wire of the encoder breaks: 0 V within the bus' dead time, the motor brakes by itself, and the reference is gone.
TEST(AnalogAxis, AWireOfItsEncoderThatBreaksOpensTheLoopAndBrakes) {
    AnalogMachine m;
    ASSERT_TRUE(m.up());
    m.enable(0);
    m.home(0);
    ASSERT_EQ(m.command(OperatorAction::move_absolute, 0, false, 550, 400).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.motor().velocity() > 390; }, 2s));
    m.happens(SimulationEvent::Kind::drive_fault, 2);
    const double broken_at = m.motor().position();
    ASSERT_TRUE(m.until([&] { return m.volts() < 0.1; }, 5ms)) << m.volts();
    EXPECT_TRUE(m.enabled());
    m.run(100ms);
    EXPECT_TRUE(m.has_alarm(id(AxisAlarm::encoder_lost))) << m.alarms();
    EXPECT_EQ(m.axis(0).state, AxisState::ErrorStop);
    EXPECT_LT(m.motor().velocity(), 1.1) << "what drift and no offset leave";
    EXPECT_LT(m.motor().position() - broken_at, 400 * (0.008 + 0.005) + 0.2) << "the lag, and five cycles";
    m.run(200ms);
    EXPECT_FALSE(m.enabled());

    EXPECT_EQ(m.command(OperatorAction::reset).answer, Answer::accepted);
    m.run(3s);
    EXPECT_EQ(m.axis(0).state, AxisState::ErrorStop) << "its cause is there still";
    m.happens(SimulationEvent::Kind::drive_fault, 0);
    m.run(10ms);
    EXPECT_FALSE(m.axis(0).homed) << "a counter has lost pulses";
    m.reset_and_enable();
    m.home(0);
    ASSERT_TRUE(m.arrive(100, 200)) << m.alarms();
    EXPECT_NEAR(m.motor().position(), 100, 0.08);
}

// An encoder whose terminal says nothing of it falls silent: the following error stops the axis, as far as its window.
TEST(AnalogAxis, AJammedMotorIsAFollowingError) {
    AnalogMachine m;
    ASSERT_TRUE(m.up());
    m.enable(0);
    m.home(0);
    ASSERT_EQ(m.command(OperatorAction::move_absolute, 0, false, 550, 200).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.motor().velocity() > 190; }, 2s));
    m.happens(SimulationEvent::Kind::jam, 0);
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::ErrorStop; }, 200ms));
    m.run(5ms);
    EXPECT_TRUE(m.has_alarm(id(AxisAlarm::following_error))) << m.alarms();
    m.happens(SimulationEvent::Kind::jam, 1);
    m.run(1s);
}

TEST(AnalogAxis, AFaultOfItsAmplifierIsToldAndResetByItsOutput) {
    AnalogMachine m;
    ASSERT_TRUE(m.up());
    m.enable(0);
    m.happens(SimulationEvent::Kind::drive_fault, 1);
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::ErrorStop; }, 10ms));
    m.run(5ms);
    EXPECT_TRUE(m.has_alarm(id(AxisAlarm::amplifier_fault))) << m.alarms();
    EXPECT_FALSE(m.enabled());
    bool was_reset = false;
    m.on_cycle = [&] { was_reset = was_reset || m.world.output("x_reset"); };
    m.reset_and_enable();
    m.on_cycle = {};
    EXPECT_TRUE(was_reset);
    EXPECT_FALSE(m.world.output("x_reset"));
    EXPECT_EQ(m.alarms(), "");
}

// Its brake opens with the enable, and the enable waits until it has closed.
TEST(AnalogAxis, ItsBrakeIsWorkedLikeThatOfAnyDrive) {
    AnalogMachine m;
    ASSERT_TRUE(m.up());
    Instant opened{}, closed{}, disabled{};
    bool was_open = false, was_enabled = false;
    m.on_cycle = [&] {
        const bool open = m.world.output("x_brake"), on = m.enabled();
        if (open && !was_open) opened = m.clock.now();
        if (!open && was_open) closed = m.clock.now();
        if (!on && was_enabled) disabled = m.clock.now();
        EXPECT_TRUE(on || !open) << "an open brake and no enable";
        was_open = open, was_enabled = on;
    };
    m.enable(0);
    EXPECT_GE(m.clock.now() - opened, 49ms) << "its release, and a cycle for the word";
    m.run(100ms);
    ASSERT_EQ(m.command(OperatorAction::power, 0, false).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return !m.enabled(); }, 1s));
    m.run(2ms);
    EXPECT_GE(disabled - closed, 49ms) << "its engage, and a cycle for the word";
    m.on_cycle = {};
}

// The terminal that tells the set-point loses its supply: the amplifier gets nothing, the axis stops, and it knows where it is all the same.
TEST(AnalogAxis, ATerminalOfItsWiresThatIsAwayStopsItAndCostsNoReference) {
    AnalogMachine m(
        {{"    - { name: volts, device: el4032 }\n", ""}, {"device: el2008 }", "device: el2008 }\n    - { name: volts, device: el4032 }"}});
    ASSERT_TRUE(m.up());
    m.enable(0);
    m.home(0);
    ASSERT_EQ(m.command(OperatorAction::move_absolute, 0, false, 550, 200).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.motor().velocity() > 190; }, 2s));
    m.world.set_slave_power("volts", false);
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::ErrorStop; }, 100ms)) << m.alarms();
    ASSERT_TRUE(m.until([&] { return !m.enabled(); }, 500ms)) << m.alarms();
    m.run(2s);
    EXPECT_NEAR(m.motor().velocity(), 0, 0.5);
    m.world.set_slave_power("volts", true);
    for (int tries = 0; tries < 100 && !m.alarms().empty(); ++tries) {  // until the terminal is back
        (void)m.command(OperatorAction::reset);
        m.run(300ms);
    }
    ASSERT_EQ(m.alarms(), "");
    EXPECT_TRUE(m.axis(0).homed);
    m.enable(0);
    ASSERT_TRUE(m.arrive(100, 200)) << m.alarms();
    EXPECT_NEAR(m.motor().position(), 100, 0.08);
}

// Without offset and I part the drift is a standing error of 1 mm/s over kv; with the offset that the page calculates from it, none.
TEST(AnalogAxis, TheOffsetThatTheStandingErrorGivesTakesTheDriftAway) {
    const std::pair<std::string, std::string> no_integral{", integral: { time: 500 ms }", ""};
    AnalogMachine drifts({no_integral, {"offset: -20 mV", "offset: 0 mV"}});
    ASSERT_TRUE(drifts.up());
    drifts.enable(0);
    drifts.run(2s);
    const double error = drifts.axis(0).following_error;
    EXPECT_NEAR(error, -1.0 / 20, 0.002);
    EXPECT_NEAR(error * 20 / 500 * 10, -0.02, 0.001) << "V: kv x error / velocity_at_10V x 10 V";
    AnalogMachine still({no_integral});
    ASSERT_TRUE(still.up());
    still.enable(0);
    still.run(2s);
    EXPECT_NEAR(still.axis(0).following_error, 0, 0.003);
}

TEST(AnalogAxis, WhatDoesNotFitIsSaid) {
    EXPECT_EQ(analog_problem({}), "none");
    EXPECT_THAT(analog_problem({{"velocity_at_10V: 500", "velocity_at_10V: 300"}}),
                HasSubstr("10 V are 300 mm/s, and limits.velocity is 400 mm/s"));
    EXPECT_THAT(analog_problem({{"mode: velocity, kv: 20, integral: { time: 500 ms }", "mode: position"}}),
                HasSubstr("closes no position loop"));
    EXPECT_THAT(analog_problem({{"    following_error: { window: 8 mm, time: 10 ms }\n", ""}}),
                HasSubstr("add `following_error: {window: ...}`"));
    EXPECT_THAT(analog_problem({{"setpoint: x_speed", "setpoint: x_sped"}}), HasSubstr("did you mean 'x_speed'?"));
    EXPECT_THAT(analog_problem({{"setpoint: x_speed", "setpoint: x_brake"}}), HasSubstr("output 'x_brake' has no unit"));
    EXPECT_THAT(analog_problem({{"enable: x_enable", "enable: x_speed"}}), HasSubstr("'x_speed' has 16 bits"));
    EXPECT_THAT(analog_problem({{"reset: x_reset", "reset: x_brake"}}), HasSubstr("already is another"));
    EXPECT_THAT(analog_problem({{"channel: ao1 }", "channel: ao1, safe: 1 V }"}}),
                HasSubstr("a motor would turn where nobody drives this output"));
    EXPECT_THAT(analog_problem({{"      home_switch: x_home\n", ""}}), HasSubstr("needs the input `analog.home_switch`"));
    EXPECT_THAT(analog_problem({{"kind: home_switch", "kind: drive, method: 17"}}), HasSubstr("homes by no method of its own"));
    EXPECT_THAT(analog_problem({{"offset: -20 mV", "offset: -2 V"}}), HasSubstr("must be from -1 V to 1 V"));
    EXPECT_THAT(analog_problem({{"offset: -20 mV", "offset: -20 mm"}}), HasSubstr("V"));
    EXPECT_THAT(analog_problem({{"    slave: counter ", "    slave: volts "}}), HasSubstr("names no encoder"));
    EXPECT_THAT(analog_problem({{"position: [-10 mm, 600 mm] }", "position: [-10 mm, 600 mm], torque: 1 }"}}),
                HasSubstr("is told no torque"));
    EXPECT_THAT(analog_problem({{"device: el4032", "device: el4002"}}),
                HasSubstr("axis.analog: axes.x.analog.setpoint: output 'x_speed' gives no -10 V: the motor would turn one way only"));
    EXPECT_THAT(analog_problem({{"fault: x_healthy", "fault: x_ready"}}), HasSubstr("'x_ready' is `ready`, too"));
    EXPECT_THAT(analog_problem({{"positive_limit: x_high", "positive_limit: x_low"}}), HasSubstr("'x_low' is `negative_limit`, too"));
    EXPECT_EQ(analog_problem({{"home_switch: x_home", "home_switch: x_low"}}), "none") << "a limit switch may be the home switch";
    EXPECT_THAT(analog_problem({{"polarity_distance: 2 mm", "polarity_distance: 0 mm"}}),
                HasSubstr("`0` for `axes.x.analog.polarity_distance` is out of range"));
    EXPECT_THAT(analog_problem({{"kv: 20", "kv: 5000"}}),
                HasSubstr("5000/s with a position and a set-point each 1 ms: this loop cannot be stable"));
    EXPECT_THAT(analog_problem({{"device: el4032 }", "device: el4032, sm_watchdog: 0 ms }"}}), HasSubstr("sm_watchdog"));
    EXPECT_THAT(analog_problem({{"    homing:", "    position_memory: { absolute: true }\n    homing:"}}),
                HasSubstr("'position1' of slave 'counter' is an incremental counter"));
    EXPECT_THAT(analog_problem({{"    homing:", "    simulated: true\n    homing:"}}), HasSubstr("simulated with its whole bus only"));
}

// A sync unit of 50 cycles closes the loop each 50 ms, and keeps the watchdog of its terminal three times as long.
TEST(AnalogAxis, ASlowSetpointTerminalIsNotTakenInSilence) {
    const std::pair<std::string, std::string> slow{"device: el4032 }", "device: el4032, sync_unit: slow }"};
    const auto units = [](int divisor) {
        return std::pair<std::string, std::string>{"bus:\n", fmt::format("bus:\n  sync_units: [{{ name: slow, divisor: {} }}]\n", divisor)};
    };
    EXPECT_THAT(analog_problem({slow, units(50)}),
                HasSubstr("20/s with a position and a set-point each 50 ms: this loop cannot be stable"));
    EXPECT_EQ(analog_problem({slow, units(10)}), "none");
}

// One wrong key is one error, at its place, and where it belongs is said.
TEST(AnalogAxis, AWrongKeyIsOneError) {
    const auto place = [](const Changes& changes) {
        auto loaded = load_analog(changes);
        const auto* errors = std::get_if<std::vector<Error>>(&loaded);
        if (errors == nullptr || errors->size() != 1) return std::string("not one error: ") + analog_problem(changes);
        return errors->front().text();
    };
    EXPECT_THAT(place({{"      ready: x_ready", "      redy: x_ready"}}), HasSubstr("did you mean `ready`?"));
    EXPECT_THAT(place({{"      ready: x_ready", "      enable_timeout: 5 s\n      ready: x_ready"}}),
                HasSubstr("`axes.x.analog` has no key `enable_timeout`"));
    EXPECT_THAT(place({{"      ready: x_ready", "      enable_timeout: 5 s\n      ready: x_ready"}}),
                HasSubstr("it is a key of `axes.x`: move it there"));
    EXPECT_THAT(place({{"      setpoint: x_speed\n", ""}}), HasSubstr("`axes.x.analog` lacks its key `setpoint`"));
}

TEST(AnalogAxis, WhatIsHardlyMeantIsRemarked) {
    const auto remarked = [](const Changes& changes) {
        std::string out;
        for (const auto& remark : remarks(analog_machine(changes), {}, 0)) out += remark.code + " ";
        return out;
    };
    EXPECT_EQ(remarked({}), "");
    EXPECT_EQ(remarked({{"velocity_at_10V: 500", "velocity_at_10V: 420"}}), "remark.analog_headroom ");
    EXPECT_EQ(remarked({{"offset: -20 mV", "offset: 200 mV"}}), "remark.analog_offset ");
    EXPECT_EQ(remarked({{"      ready: x_ready\n      fault: x_healthy\n", ""}}), "remark.analog_unwatched ");
    EXPECT_EQ(remarked({{"polarity_distance: 2 mm", "polarity_distance: 9 mm"}}), "remark.analog_polarity ");
    EXPECT_EQ(remarked({{"kv: 20", "kv: 150"}}), "remark.position_loop ");
    EXPECT_EQ(remarked({{"device: el4032 }", "device: el4032, sm_watchdog: 5 s }"}}), "remark.analog_watchdog ");
    EXPECT_EQ(remarked({{"device: el2008 }", "device: el2008, sm_watchdog: 5 s }"}}), "remark.analog_watchdog ");
    EXPECT_EQ(remarked({{"device: el4032 }", "device: el4032, sm_watchdog: 50 ms }"}}), "");
}

}  // namespace
}  // namespace taktwerk::runtime::testing
