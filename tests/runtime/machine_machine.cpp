// One machine end to end in virtual time: YAML-free, real frames, simulated drives.

#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::AxisState;

TEST(Machine, ComesUpAndShowsItsAxesDisabled) {
    TestMachine m{machine_config(1)};
    ASSERT_TRUE(m.up());

    EXPECT_EQ(m.state().bus_phase, ecat::Master::Phase::operational);
    EXPECT_EQ(m.axis(0).state, AxisState::Disabled);
    EXPECT_TRUE(m.axis(0).online);
    EXPECT_EQ(m.state().alarm_count, 0u) << m.alarms();
}

TEST(Machine, AnOperatorEnablesHomesAndMovesAnAxisInManualMode) {
    TestMachine m{machine_config(1)};
    ASSERT_TRUE(m.up());

    m.enable(0);
    EXPECT_EQ(m.axis(0).state, AxisState::Standstill);
    m.home(0);
    EXPECT_EQ(m.command(OperatorAction::move_absolute, 0, false, 250, 100).answer, Answer::accepted);
    EXPECT_TRUE(m.until([&] { return m.axis(0).state == AxisState::Standstill && m.axis(0).in_position; }, 10s));

    EXPECT_EQ(m.axis(0).set_position, 250.0);
    EXPECT_NEAR(m.axis(0).actual_position, 250.0, 0.05);
    // Method 19 takes the rising.. falling edge of the home switch on its way back: 0 mm of the mechanics is 0 mm of the axis.
    EXPECT_NEAR(m.world.drive("x")->plant().position() / 1000.0, 250.0, 0.1);
    m.expect_no_jump();
}

TEST(Machine, TwoRunsGiveTheSameBits) {
    const auto play = [] {
        TestMachine m{machine_config(2)};
        std::vector<double> trace;
        if (!m.up()) return trace;
        m.on_cycle = [&] {
            for (std::size_t i = 0; i < 2; ++i) {
                const auto& v = m.axis(i);
                trace.insert(trace.end(), {v.set_position, v.actual_position, v.set_velocity, v.actual_torque, v.following_error});
            }
        };
        m.enable(0);
        m.enable(1);
        m.home(0);
        m.command(OperatorAction::move_absolute, 0, false, 333.3, 77.7);
        m.run(3s);
        return trace;
    };
    const auto first = play();
    ASSERT_GT(first.size(), 10000u);
    EXPECT_EQ(first, play());
}

}  // namespace
}  // namespace taktwerk::runtime::testing
