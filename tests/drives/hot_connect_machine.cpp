// Groups of hot connect as programs, operators and screens see them, over real frames: presence as an input, values that nobody may believe,
// outputs that wait, axes that refuse with a reason, and what being pulled means to whom (docs/hot-connect.md).

#include <gmock/gmock.h>

#include "axes/axis/alarms.hpp"
#include "config/machine_file/machine_loader.hpp"
#include "runtime/alarms.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using ::testing::HasSubstr;

/// A carriage that is always there; a gripper (coupler, inputs, outputs) and a screwdriver (a drive) at two ports of a junction, and an encoder
/// on a trolley at the end. `axes`: further ones.
std::string tools_text(const std::string& more_axes = {}) {
    return "version: 1\nname: tools\ncycle: 1 ms\nstart_mode: manual\nbus:\n  interface: simulated\n  slaves:\n"
           "    - { name: x_drive, profile: sv33-e }\n    - { name: coupler, device: ek1100 }\n    - { name: io, device: el2004 }\n"
           "    - { name: junction, device: ek1122 }\n"
           "    - { name: gripper, device: ek1101, device_id: 1, hot_connect: tool_a }\n"
           "    - { name: gripper_in, device: el1004, hot_connect: tool_a }\n"
           "    - { name: gripper_out, device: el2004, hot_connect: tool_a }\n"
           "    - { name: screw_drive, profile: sv33-e, alias: 20, hot_connect: tool_b }\n"
           "io:\n  inputs:\n    gripped: { slave: gripper_in, channel: in1 }\n  outputs:\n"
           "    lamp: { slave: io, channel: out1 }\n    hold: { slave: gripper_out, channel: out1, safe: 1 }\n"
           "axes:\n  x:\n    slave: x_drive\n    unit: mm\n    gearing: { counts_per_revolution: 131072, feed: 10 mm }\n"
           "    limits: { velocity: 500 mm/s, acceleration: 5000 mm/s2, jerk: 100000 mm/s3 }\n    following_error: { window: 20 mm }\n"
           "    require_homed: false\n"
           "  screw:\n    slave: screw_drive\n    unit: rev\n    gearing: { counts_per_revolution: 131072, feed: 1 rev }\n"
           "    limits: { velocity: 20 rev/s, acceleration: 200 rev/s2, jerk: 8000 rev/s3 }\n    following_error: { window: 2 rev }\n"
           "    require_homed: false\n    homing: { kind: set_here }\n" +
           more_axes +
           "simulation:\n  slaves:\n    gripper: { behind: junction, port: 1 }\n    screw_drive: { behind: junction, port: 2 }\n";
}

MachineConfig tools(const std::string& more_axes = {}) {
    auto loaded = config::load_machine_text(std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/tools.yaml", tools_text(more_axes), {});
    if (auto* errors = std::get_if<std::vector<Error>>(&loaded)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return machine_config(1);
    }
    return std::get<config::LoadedMachine>(std::move(loaded)).machine;
}

constexpr std::uint16_t x = 0, screw = 1;

struct ToolMachine : TestMachine {
    using TestMachine::TestMachine;

    void plug(const std::string& group, bool connected) {
        SimulationEvent event;
        event.kind = SimulationEvent::Kind::group;
        event.target = group;
        event.value = connected ? 1 : 0;
        world.happen(event);
    }
    std::size_t input(const std::string& name) {
        const auto& names = machine->layout().inputs;
        for (std::size_t i = 0; i < names.size(); ++i)
            if (names[i] == name) return i;
        ADD_FAILURE() << "no input " << name;
        return 0;
    }
    bool is(const std::string& name) { return state().inputs[input(name)] != 0; }
    bool good(const std::string& name) { return state().input_values[input(name)].good; }
    bool joins(const std::string& group) {
        return until([&] { return is(group + ".present"); }, 10s);
    }
    bool leaves(const std::string& group) {
        return until([&] { return !is(group + ".present"); }, 2s);
    }
    std::size_t alarms_of(AlarmId id) {
        std::size_t count = 0;
        const auto& s = state();
        for (std::size_t i = 0; i < s.alarm_count; ++i) count += s.alarms[i].fact.id == id ? 1 : 0;
        return count;
    }
    bool set_output(const std::string& name, std::int64_t value) {
        const auto& names = machine->layout().outputs;
        OperatorCommand c;
        c.action = OperatorAction::set_output;
        for (std::size_t i = 0; i < names.size(); ++i)
            if (names[i] == name) c.index = static_cast<std::uint16_t>(i);
        c.value = static_cast<double>(value);
        return command(c).answer == Answer::accepted;
    }
};

runtime::GroupSimulation away(const std::string& group) {
    runtime::GroupSimulation out;
    out.group = group;
    out.connected = false;
    return out;
}

// A tool that lies in its rack when the machine starts is no trouble to anybody.
TEST(HotConnect, TheMachineComesUpWithoutItsTools) {
    auto config = tools();
    config.simulation.groups = {away("tool_a"), away("tool_b")};
    ToolMachine m{config};
    ASSERT_TRUE(m.up());
    m.run(1s);

    EXPECT_EQ(m.alarms(), "");
    EXPECT_FALSE(m.is("tool_a.present"));
    EXPECT_FALSE(m.is("tool_a.joining"));
    EXPECT_TRUE(m.good("tool_a.present")) << "that it is away is known";
    EXPECT_FALSE(m.good("gripped"));
    EXPECT_EQ(m.axis(screw).presence, axes::Presence::absent);
    EXPECT_EQ(m.command(OperatorAction::power, screw, true).error, axes::ErrorId::not_connected);
    EXPECT_EQ(m.command(OperatorAction::home, screw).error, axes::ErrorId::not_connected);
    m.run(12s);  // longer than any patience of an axis
    EXPECT_EQ(m.alarms(), "");
    EXPECT_EQ(m.axis(screw).state, axes::AxisState::Disabled);
    m.enable(x);
}

// Joined and left again, five times each, under an axis that runs: no alarm, no jump, nobody resets anything.
TEST(HotConnect, ToolsComeAndGoWhileTheRestRuns) {
    auto config = tools();
    config.simulation.groups = {away("tool_a"), away("tool_b")};
    ToolMachine m{config};
    ASSERT_TRUE(m.up());
    m.enable(x);
    EXPECT_EQ(m.command(OperatorAction::move_absolute, x, false, 10000, 20).answer, Answer::accepted);
    for (int round = 0; round < 5; ++round) {
        const std::string tool = round % 2 == 0 ? "tool_b" : "tool_a";
        m.plug(tool, true);
        ASSERT_TRUE(m.joins(tool)) << round << " " << m.alarms();
        if (tool == "tool_b") {
            m.enable(screw);
            EXPECT_EQ(m.command(OperatorAction::move_absolute, screw, false, 1000, 5).answer, Answer::accepted);
            m.run(500ms);
            EXPECT_EQ(m.command(OperatorAction::power, screw, false).answer, Answer::accepted);
            ASSERT_TRUE(m.until([&] { return m.axis(screw).state == axes::AxisState::Disabled; }, 2s));
            m.run(200ms);
        }
        m.plug(tool, false);
        ASSERT_TRUE(m.leaves(tool)) << round;
        m.run(200ms);
        EXPECT_EQ(m.alarms(), "") << round;
        EXPECT_EQ(m.axis(x).state, axes::AxisState::DiscreteMotion) << round;
    }
    m.expect_no_jump();
}

// The last value stands and is not good; no program reads a gripped part in a rack.
TEST(HotConnect, InputsAreNotGoodAndOutputsWaitForPresence) {
    ToolMachine m{tools()};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.joins("tool_a"));
    m.world.set_input("gripped", true);
    m.run(20ms);
    EXPECT_TRUE(m.is("gripped"));
    EXPECT_TRUE(m.good("gripped"));

    m.plug("tool_a", false);
    ASSERT_TRUE(m.leaves("tool_a"));
    EXPECT_FALSE(m.good("gripped"));
    EXPECT_TRUE(m.set_output("hold", 0));
    EXPECT_TRUE(m.set_output("lamp", 1)) << "always there";
    m.run(20ms);
    EXPECT_TRUE(m.world.output("lamp"));

    m.world.set_input("gripped", false);
    m.run(500ms);
    m.plug("tool_a", true);
    bool early = false;  // the wire carries what was written, and the group is not there yet
    ASSERT_TRUE(m.until(
        [&] {
            const bool there = m.is("tool_a.present");
            early = early || (!there && m.is("tool_a.joining") && m.machine->bus().health(6).al_state == ecat::AlState::op &&
                              !m.world.output("hold"));
            return there;
        },
        10s))
        << m.alarms();
    EXPECT_FALSE(early) << "`safe` until it is present";
    m.run(20ms);
    EXPECT_FALSE(m.world.output("hold")) << "what was written last";
    EXPECT_TRUE(m.good("gripped"));
    EXPECT_FALSE(m.is("gripped"));
    EXPECT_EQ(m.alarms(), "");
}

// One alarm that names the group, at the axis that had power; its axis stops, the carriage runs on.
TEST(HotConnect, PulledUnderPowerIsToldOnceAndStopsItsOwnAxes) {
    ToolMachine m{tools()};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.joins("tool_b"));
    m.enable(x);
    m.enable(screw);
    EXPECT_EQ(m.command(OperatorAction::move_absolute, x, false, 10000, 20).answer, Answer::accepted);
    EXPECT_EQ(m.command(OperatorAction::move_absolute, screw, false, 1000, 5).answer, Answer::accepted);
    m.run(300ms);

    m.plug("tool_b", false);
    ASSERT_TRUE(m.leaves("tool_b"));
    m.run(1s);

    EXPECT_EQ(m.alarms_of(id(MachineAlarm::group_pulled)), 1u);
    EXPECT_EQ(m.state().alarm_count, 1u) << m.alarms();
    EXPECT_THAT(m.alarms(), HasSubstr("axis screw: Group 'tool_b' was taken away while this axis had power"));
    EXPECT_EQ(m.axis(screw).state, axes::AxisState::ErrorStop);
    EXPECT_EQ(m.axis(x).state, axes::AxisState::DiscreteMotion);

    // The machine goes on without it: a reset needs no tool.
    EXPECT_EQ(m.command(OperatorAction::reset).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(screw).state == axes::AxisState::Disabled; }, 3s)) << m.alarms();
    m.run(100ms);
    EXPECT_EQ(m.alarms(), "");
    m.plug("tool_b", true);
    ASSERT_TRUE(m.joins("tool_b"));
    m.enable(screw);
    EXPECT_EQ(m.axis(x).state, axes::AxisState::DiscreteMotion);
    m.expect_no_jump();
}

// The reference of an incremental encoder is gone with the supply.
TEST(HotConnect, AToolIsNotHomedWhenItComesBack) {
    ToolMachine m{tools()};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.joins("tool_b"));
    m.enable(screw);
    m.home(screw);
    EXPECT_EQ(m.command(OperatorAction::power, screw, false).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(screw).state == axes::AxisState::Disabled; }, 2s));
    m.run(200ms);
    m.plug("tool_b", false);
    ASSERT_TRUE(m.leaves("tool_b"));
    m.run(500ms);
    m.plug("tool_b", true);
    ASSERT_TRUE(m.joins("tool_b"));
    m.run(100ms);

    EXPECT_FALSE(m.axis(screw).homed);
    EXPECT_EQ(m.alarms(), "");
}

}  // namespace
}  // namespace taktwerk::runtime::testing
