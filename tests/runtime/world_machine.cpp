// The simulated machine: what the configuration puts into it, and the named points between terminal and program.

#include "runtime/alarms.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

TEST(World, EventsHappenAtTheirTime) {
    auto config = machine_config(1);
    using Kind = SimulationEvent::Kind;
    config.simulation.events = {{3s, Kind::input, "button", 0}, {2s, Kind::input, "button", 1}, {4s, Kind::drive_fault, "x", 0x3130}};
    TestMachine m{config};
    const auto begin = m.clock.now();
    ASSERT_TRUE(m.up());
    Instant pressed{}, released{};
    m.on_cycle = [&] {
        const bool button = m.state().inputs[1] != 0;
        if (button && pressed == Instant{}) pressed = m.clock.now();
        if (!button && pressed != Instant{} && released == Instant{}) released = m.clock.now();
    };
    ASSERT_LT(m.clock.now() - begin, 2s) << "the bring-up took longer than this test allows for";
    m.run(4s);
    // A frame on its way, and one cycle to come back.
    EXPECT_NEAR(to_seconds(pressed - begin), 2.0, 0.003);
    EXPECT_NEAR(to_seconds(released - begin), 3.0, 0.003);
    EXPECT_EQ(m.axis(0).drive_error, 0x3130);
}

TEST(World, AnInvertedAxisStandsAndMovesWhereItsOwnUnitsSay) {
    auto config = machine_config(1);
    config.axes[0].axis.gearing.inverted = true;
    config.axes[0].axis.homing.kind = axes::HomingKind::set_here;
    config.axes[0].simulation.start = 100;
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    EXPECT_NEAR(m.world.drive("x")->plant().position(), -100000, 1);
    EXPECT_NEAR(m.axis(0).actual_position, 0, 0.01) << "an incremental encoder counts from where it was switched on";
    m.enable(0);
    m.home(0);  // here is 0 from now on
    ASSERT_EQ(m.command(OperatorAction::move_absolute, 0, false, 50, 100).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).in_position; }, 5s));
    // 1000 counts a mm, against the drive's sense: from -100 000 to -150 000.
    EXPECT_NEAR(m.world.drive("x")->plant().position(), -150000, 50);
}

TEST(World, ALimitSwitchStopsTheAxisAndLetsItBack) {
    auto config = machine_config(1);
    config.axes[0].axis.homing.kind = axes::HomingKind::set_here;
    config.axes[0].simulation.start = 0;
    config.axes[0].simulation.positive_limit = 60;
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    m.enable(0);
    m.home(0);
    ASSERT_EQ(m.command(OperatorAction::move_absolute, 0, false, 100, 50).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).state == axes::AxisState::ErrorStop; }, 5s));
    EXPECT_TRUE(m.axis(0).positive_limit_switch);
    m.run(500ms);
    m.command(OperatorAction::reset);
    m.run(100ms);
    EXPECT_EQ(m.command(OperatorAction::move_absolute, 0, false, 100, 50).error, axes::ErrorId::interlocked);
    EXPECT_EQ(m.command(OperatorAction::move_absolute, 0, false, 10, 50).answer, Answer::accepted);
    EXPECT_TRUE(m.until([&] { return m.axis(0).in_position; }, 5s)) << m.alarms();
    m.expect_no_jump();
}

// Commissioning one axis at a time: the slave of a simulated axis is not on the cable, those behind it move up.
TEST(World, TheSlaveOfASimulatedAxisIsNotOnTheCable) {
    auto config = machine_config(2);
    config.axes[0].axis.simulated = true;
    config.axes[0].axis.homing.kind = axes::HomingKind::set_here;
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    EXPECT_EQ(m.world.drive("x"), nullptr);
    ASSERT_NE(m.world.drive("y"), nullptr);
    m.enable(0);
    m.home(0);
    EXPECT_EQ(m.command(OperatorAction::move_absolute, 0, false, 20, 50).answer, Answer::accepted);
    m.enable(1);
    EXPECT_TRUE(m.until([&] { return m.axis(0).in_position && m.axis(0).set_position == 20; }, 5s)) << m.alarms();
    m.world.set_input("button", true);
    m.run(5ms);
    EXPECT_EQ(m.state().inputs[1], 1);
}

TEST(IoPoints, AnInvertedOneSaysTheOppositeOfItsTerminal) {
    auto config = machine_config(1);
    config.io[1].inverted = config.io[2].inverted = true;
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    EXPECT_EQ(m.state().inputs[1], 1) << "the contact is open";
    EXPECT_EQ(m.state().outputs[0], 0);
    EXPECT_TRUE(m.world.output("lamp"));
    ASSERT_EQ(m.command(OperatorAction::set_output, 0, false, 1).answer, Answer::accepted);
    m.world.set_input("button", true);
    m.run(5ms);
    EXPECT_EQ(m.state().inputs[1], 0);
    EXPECT_FALSE(m.world.output("lamp"));
}

TEST(IoPoints, OutputsHaveTheirSafeValueFromTheStartAndWhenTheRunEnds) {
    auto config = machine_config(1);
    config.io[2].safe_value = 1;
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    EXPECT_TRUE(m.world.output("lamp"));
    ASSERT_EQ(m.command(OperatorAction::set_output, 0, false, 0).answer, Answer::accepted);
    m.run(5ms);
    ASSERT_FALSE(m.world.output("lamp"));
    m.machine->request_shutdown();
    m.run(5ms);
    EXPECT_TRUE(m.world.output("lamp"));
}

TEST(IoPoints, AnObjectThatIsNotMappedIsNamedWhenTheMachineIsArmed) {
    auto config = machine_config(1);
    config.io[1].index = 0x6010;
    TestMachine m{config};
    const auto up = m.runner->bring_up();
    ASSERT_FALSE(up.ok());
    EXPECT_NE(up.error().text().find("io point 'button'"), std::string::npos) << up.error().text();
}

TEST(World, HangsItsSlavesWhereTheConfigurationSays) {
    auto config = machine_config(3);  // x, y, z and a terminal, in a line
    const std::string first = config.bus.slaves[0].name, last = config.bus.slaves[2].name;
    config.simulation.slaves = {{config.bus.slaves[1].name, first, 3, 100, 25.0}, {last, first, 1, 10, {}}};
    World world{config, Instant{} + 1s};
    auto& network = world.network();

    // Port 3 comes before port 1, so the order stays; the second slave no longer carries the third.
    world.set_cable(config.bus.slaves[1].name, false);
    EXPECT_EQ(network.reachable(), network.size() - 1);
    EXPECT_EQ(network.slave(1).options().drift_ppm, 25.0);
    world.set_cable(config.bus.slaves[1].name, true);
    world.set_cable(last, false);
    EXPECT_EQ(network.reachable(), 2u) << "what follows the last of the branch is gone with it";
}

}  // namespace
}  // namespace taktwerk::runtime::testing
