// An axis whose slave is exchanged every fourth cycle beside one that is exchanged in each.
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

MachineConfig x_every_fourth_cycle() {
    auto config = machine_config(2);
    for (auto& binding : config.axes) binding.axis.homing.kind = axes::HomingKind::set_here;
    config.bus.sync_units = {{"slow", 4}};
    config.bus.slaves[0].sync_unit = "slow";
    return config;
}

// At 100 mm/s an axis goes 0.1 mm a cycle, 0.4 mm between two exchanges. Were a set-point compared with the actual value of another
// instant, the following error would show that; the plant follows its target within a fraction of it.
TEST(SyncUnit, AnAxisOfASlowerUnitMovesWithTheFollowingErrorOfAFastOne) {
    TestMachine m{x_every_fourth_cycle()};
    ASSERT_TRUE(m.up());
    for (std::uint16_t axis = 0; axis < 2; ++axis) {
        m.enable(axis);
        m.home(axis);
        ASSERT_EQ(m.command(OperatorAction::move_absolute, axis, false, 100, 100).answer, Answer::accepted);
    }
    std::array<double, 2> worst{};
    m.on_cycle = [&] {
        for (std::size_t i = 0; i < 2; ++i) worst[i] = std::max(worst[i], std::abs(m.axis(i).following_error));
    };
    ASSERT_TRUE(m.until([&] { return m.axis(0).in_position && m.axis(1).in_position; }, 5s)) << m.alarms();
    EXPECT_NEAR(m.axis(0).actual_position, 100, 0.05);
    EXPECT_NEAR(m.world.drive("x")->plant().position() - m.world.drive("y")->plant().position(), 0, 50) << "counts, of 1000 a mm";
    EXPECT_LT(worst[0], worst[1] + 0.1) << "mm";
    EXPECT_EQ(m.alarms(), "");
    // Between two exchanges the target may go as far as full speed goes in four cycles.
    EXPECT_LE(m.world.drive("x")->largest_increment(), 4 * 500 * 0.001 * 1000 + 2);
}

// The limit of stale cycles is 3; between two exchanges of a healthy unit lie three cycles without news.
TEST(SyncUnit, AnAxisOfASlowerUnitIsOnlineBetweenItsExchanges) {
    TestMachine m{x_every_fourth_cycle()};
    ASSERT_TRUE(m.up());
    m.enable(0);
    m.home(0);
    int offline = 0;
    m.on_cycle = [&] { offline += m.axis(0).online ? 0 : 1; };
    m.run(100ms);
    EXPECT_EQ(offline, 0);
    EXPECT_EQ(m.axis(0).state, axes::AxisState::Standstill);
    EXPECT_EQ(m.alarms(), "");
}

}  // namespace
}  // namespace taktwerk::runtime::testing
