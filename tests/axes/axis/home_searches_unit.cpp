// MC_Home by the searches of PLCopen Part 5: limit switch, fixed stop, home switch and index pulse, absolute encoder. The failures are those
// of the axis: an alarm and ErrorStop.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

void with_limits(FakeDrive& drive) {
    drive.switches = true;
    drive.home_low = -10'000;
    drive.home_high = -8'000;
    drive.negative_end = -30'000;
    drive.positive_end = 30'000;
}

class HomeByLimitSwitch : public ::testing::TestWithParam<double> {};
TEST_P(HomeByLimitSwitch, TakesTheEdgeSlowlyOnTheWayBack) {
    Rig rig(homing_by(HomingKind::limit_switch, 30s), [](FakeDrive& drive) {
        with_limits(drive);
        drive.position = GetParam() * 1000;
    });
    rig.power_on();
    const auto id = rig.accept(home(-5));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) != CommandStatus::active; }, 20000));
    ASSERT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    EXPECT_TRUE(rig.view().homed);
    EXPECT_FALSE(rig.view().negative_limit_switch);
    EXPECT_NEAR(rig.view().actual_position - rig.drive.position / 1000, 25, 0.0015);  // half a cycle at 1 u/s, and a count
    EXPECT_TRUE(rig.alarms.empty());
    rig.expect_no_jump();
}
INSTANTIATE_TEST_SUITE_P(FromFreeAndFromOnIt, HomeByLimitSwitch, ::testing::Values(0.0, -30.5, 29.0));

TEST(HomeByBlock, TakesTheStopAndStandsThere) {
    auto config = homing_by(HomingKind::block, 30s);
    config.homing.torque = 0.2;
    config.homing.negative = false;
    Rig rig(config, [](FakeDrive& drive) {
        drive.positive_stop = 12'000;
        drive.stiffness = 0.0001;
    });
    rig.power_on();
    const auto id = rig.accept(home(500));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) != CommandStatus::active; }, 20000));
    ASSERT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_NEAR(rig.view().actual_position, 500, 0.001);
    EXPECT_NEAR(rig.view().set_position, 500, 0.002);
    EXPECT_EQ(rig.drive.position, 12'000);
    EXPECT_TRUE(rig.alarms.empty());
    rig.expect_no_jump();
}

TEST(HomeByBlock, NothingInReachIsATimeoutOfTheAxis) {
    auto config = homing_by(HomingKind::block, 30s);
    config.homing.torque = 0.2;
    config.homing.timeout = 1s;
    Rig rig(config);
    rig.power_on();
    rig.accept(home(0));
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 2000));
    EXPECT_TRUE(rig.raised(AxisAlarm::homing_timeout));
    EXPECT_FALSE(rig.view().homed);
}

// The switch's edge at -8 u only says which turn; the pulse behind it, at -6.5 u, is the reference and exact.
TEST(HomeByReferencePulse, TakesTheFirstPulseBehindTheSwitch) {
    Rig rig(homing_by(HomingKind::reference_pulse, 30s), [](FakeDrive& drive) {
        with_limits(drive);
        drive.caps.probes = 1;
        drive.index_distance = 10'000;
        drive.index_at = 3'500;
    });
    rig.power_on();
    const auto id = rig.accept(home(0));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) != CommandStatus::active; }, 20000));
    ASSERT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_NEAR(rig.view().actual_position - rig.drive.position / 1000, 6.5, 1e-9);
    EXPECT_NEAR(rig.drive.position / 1000, -6.5, 0.1);
    EXPECT_TRUE(rig.alarms.empty());
    rig.expect_no_jump();
    EXPECT_FALSE(rig.drive.last.probes[0].armed);

    Rig without(homing_by(HomingKind::reference_pulse, 30s), with_limits);
    without.power_on();
    EXPECT_EQ(without.refuse(home(0)), ErrorId::no_such_probe);
}

// The encoder's zero becomes Position; a raw position that has wrapped has its zero at the next multiple of the range.
TEST(HomeByAbsoluteEncoder, NeedsNoMotion) {
    auto config = homing_by(HomingKind::absolute, 30s);
    config.memory = {.absolute = true, .range = 100'000};
    Rig rig(config, [](FakeDrive& drive) { drive.position = 302'500; });
    rig.power_on();
    const auto id = rig.accept(home(40));
    rig.step();
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_TRUE(rig.view().homed);
    EXPECT_DOUBLE_EQ(rig.view().actual_position, 42.5);
    EXPECT_EQ(rig.drive.largest_step, 0);

    Rig incremental(homing_by(HomingKind::absolute, 30s));
    incremental.power_on();
    EXPECT_EQ(incremental.refuse(home(0)), ErrorId::not_supported);
}

}  // namespace
}  // namespace taktwerk::axes::test
