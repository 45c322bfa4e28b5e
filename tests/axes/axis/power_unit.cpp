// Power: MC_Power's rules (PLCopen Part 1 v2.0, 3.1; notes 2 and 5 of figure 2) over a drive that takes its time.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

// P1-021: Disabled is the initial state, and nothing moves the axis there.
TEST(AxisPower, StartsDisabledAndRefusesMotion) {
    Rig rig;
    rig.run(10);

    EXPECT_EQ(rig.view().state, AxisState::Disabled);
    EXPECT_EQ(rig.refuse(absolute(1)), ErrorId::not_powered);
    EXPECT_EQ(rig.refuse(stop()), ErrorId::not_powered);
}

// P1-115, P1-116: Standstill only when the drive reports enabled, and not before the dwell after it.
TEST(AxisPower, WaitsForTheDriveAndItsDwell) {
    Rig rig(plain_axis(), [](FakeDrive& drive) { drive.caps.enable_delay = 20ms; });
    rig.enable = true;

    ASSERT_TRUE(rig.run_until([&] { return rig.drive.power == PowerState::enabled; }, 100));
    const auto enabled_at = rig.now;
    EXPECT_EQ(rig.view().state, AxisState::Disabled);
    EXPECT_FALSE(rig.view().powered);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 100));

    EXPECT_EQ(rig.now - enabled_at, 20ms);
    EXPECT_TRUE(rig.view().powered);
}

// The target stands on the actual position when the drive switches on, wherever the axis was pushed before.
TEST(AxisPower, TargetIsAlignedBeforeEnabling) {
    Rig rig(plain_axis(), [](FakeDrive& drive) {
        drive.position = 123456;
        drive.coasting = 7;
    });
    rig.run(50);
    rig.drive.coasting = 0;
    rig.power_on();
    rig.run(20);

    EXPECT_EQ(rig.drive.largest_step, 0);
    EXPECT_EQ(rig.drive.last.position, std::llround(rig.drive.position));
    rig.expect_no_jump();
}

// The set-point comes back from a large following error no faster than the axis may be: power is not asked for before it has arrived.
TEST(AxisPower, IsNotAskedForBeforeTheSetpointHasComeBack) {
    Rig rig;
    rig.power_on();
    rig.drive.blocked = true;
    rig.accept(absolute(20));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.enable = false;
    rig.run(5);
    rig.drive.blocked = false;
    rig.enable = true;
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 500));
    rig.run(10);

    EXPECT_NEAR(rig.view().set_position, 0, 1e-9);
    rig.expect_no_jump();
}

// Turned by hand, further than the axis would go in the time that the drive has to switch on.
TEST(AxisPower, IsNotRefusedForAWayThatSomebodyTurnedTheMotor) {
    auto config = plain_axis();
    config.patience.enable = 2s;
    Rig rig(config);
    rig.power_on();
    rig.enable = false;
    rig.run(10);
    rig.drive.coasting = 1000;  // counts per cycle: 1000 u/s, ten times the axis' limit
    rig.run(20'000);
    rig.drive.coasting = 0;
    rig.enable = true;
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 3000));

    EXPECT_NEAR(rig.view().set_position, 20'000, 1e-9);
    EXPECT_LE(rig.drive.largest_step, 100);  // counts: the limit for a cycle
}

// P1-022: a bus that comes up late is no enable timeout (the time runs from when the drive can be asked), and no Standstill without feedback.
TEST(AxisPower, WaitsForALateBusWithoutAnError) {
    auto config = plain_axis();
    config.patience.enable = 100ms;
    Rig rig(config, [](FakeDrive& drive) { drive.offline = true; });
    rig.enable = true;
    rig.run(1000);
    EXPECT_EQ(rig.view().state, AxisState::Disabled);
    EXPECT_FALSE(rig.view().online);
    rig.drive.offline = false;
    EXPECT_TRUE(rig.run_to(AxisState::Standstill, 100));
    EXPECT_TRUE(rig.alarms.empty());
}

// The drive was never asked: what it must not be blamed for.
TEST(AxisPower, IsNotAskedForWhileTheMotorTurnsFast) {
    for (const double velocity : {11.0, 50.0, 99.0, 101.0, 150.0, -60.0}) {  // u/s; the axis' limit is 100
        SCOPED_TRACE(velocity);
        auto config = plain_axis();
        config.patience.enable = 500ms;
        Rig rig(config);
        rig.drive.coasting = velocity;  // 1000 counts a unit, 1 ms a cycle
        rig.run(100);
        rig.enable = true;
        for (int i = 0; i < 520; ++i) {
            rig.step();
            ASSERT_EQ(rig.drive.last.power, PowerRequest::off);
        }
        EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
        EXPECT_TRUE(rig.raised(AxisAlarm::motor_turns));
        EXPECT_FALSE(rig.raised(AxisAlarm::enable_timeout));
    }
}

// A tenth of so slow an axis is less than what a drive at rest shows.
TEST(AxisPower, ComesAlsoForAnAxisThatIsSlowerThanTheNoiseOfItsFeedback) {
    auto config = plain_axis();
    config.limits.velocity = 1;
    config.windows.standstill_velocity = 0.5;
    Rig rig(config);
    rig.drive.coasting = 0.4;
    rig.run(100);
    ASSERT_GT(rig.view().actual_velocity, 0.1);
    rig.enable = true;
    EXPECT_TRUE(rig.run_to(AxisState::Standstill, 1000));
    EXPECT_TRUE(rig.alarms.empty());
}

TEST(AxisPower, ComesWhenTheMotorHasCoastedOut) {
    Rig rig;
    rig.drive.coasting = 99;
    rig.run(100);
    rig.enable = true;
    for (int i = 0; i < 1000; ++i) {
        rig.drive.coasting = std::max(0.0, rig.drive.coasting - 0.1);
        rig.step();
        if (rig.drive.last.power == PowerRequest::on) {
            ASSERT_LE(rig.drive.coasting, 10) << i;
        }
    }
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    EXPECT_TRUE(rig.alarms.empty());
}

// P1-117 asks that a drive that never enables hangs nothing; we make it an axis error after enable_timeout.
TEST(AxisPower, DriveThatNeverEnablesIsAnErrorAfterTheTimeout) {
    auto config = plain_axis();
    config.patience.enable = 500ms;
    Rig rig(config, [](FakeDrive& drive) { drive.refuses_power = true; });
    rig.run(1);
    rig.enable = true;

    rig.run(500);
    EXPECT_EQ(rig.view().state, AxisState::Disabled);
    rig.run(3);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_TRUE(rig.raised(AxisAlarm::enable_timeout));
    EXPECT_EQ(rig.drive.last.power, PowerRequest::off);
}

// P1-023, U-17: power off in motion ramps down first, commands are aborted, then Disabled.
TEST(AxisPower, OffInMotionRampsDownBeforeTheDriveIsReleased) {
    Rig rig;
    rig.power_on();
    const auto id = rig.accept(at_velocity(80));
    rig.run(300);
    ASSERT_EQ(rig.view().set_velocity, 80);

    rig.enable = false;
    rig.step();
    EXPECT_EQ(rig.view().state, AxisState::Stopping);
    EXPECT_EQ(rig.status(id), CommandStatus::aborted);
    bool asked_off_while_moving = false;
    ASSERT_TRUE(rig.run_until([&] {
        asked_off_while_moving = asked_off_while_moving || (rig.drive.last.power == PowerRequest::off && rig.view().set_velocity != 0);
        return rig.view().state == AxisState::Disabled;
    }));

    EXPECT_FALSE(asked_off_while_moving);
    rig.run(5);
    EXPECT_EQ(rig.drive.power, PowerState::disabled);
    rig.expect_no_jump();
}

// Enable comes back while the axis still ramps down for its fall: it goes through Disabled and switches on anew.
TEST(AxisPower, EnableDuringTheRampSwitchesOnAgain) {
    Rig rig;
    rig.power_on();
    rig.accept(at_velocity(80));
    rig.run(300);
    rig.enable = false;
    rig.run(5);
    rig.enable = true;

    ASSERT_TRUE(rig.run_to(AxisState::Disabled, 500));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 500));
    EXPECT_EQ(rig.drive.power, PowerState::enabled);
    rig.expect_no_jump();
}

// P1-023: from Standstill the state is Disabled at once, and MC_Power's second holder is told.
TEST(AxisPower, OffFromStandstillAtOnceAndTwoHoldersConflict) {
    Rig rig;
    rig.power_on();
    rig.enable = false;
    rig.step();
    EXPECT_EQ(rig.view().state, AxisState::Disabled);

    rig.program = [&] { EXPECT_EQ(rig.axis.power(true, true, true, Owner::program), ErrorId::power_conflict); };
    rig.step();
}

// P1-118: loss of power in operation is an axis error; the running command ends with it.
TEST(AxisPower, LossOfPowerInMotionIsAnErrorAndNothingJumps) {
    Rig rig;
    rig.power_on();
    const auto id = rig.accept(at_velocity(100));
    rig.run(300);

    rig.drive.refuses_power = true;
    rig.run(5);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_TRUE(rig.raised(AxisAlarm::drive_power_lost));
    EXPECT_EQ(rig.status(id), CommandStatus::error);
    EXPECT_EQ(rig.error_of(id), static_cast<ErrorId>(AxisAlarm::drive_power_lost));
    rig.run(100);
    EXPECT_NEAR(rig.view().set_position, rig.view().actual_position, 1e-9);
    EXPECT_EQ(rig.drive.last.power, PowerRequest::off);

    // note 3: reset without power gives Disabled; Enable is still TRUE, so it switches on again
    rig.drive.refuses_power = false;
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.run_to(AxisState::Disabled, 5));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 100));
    rig.expect_no_jump();
}

// An axis left out for commissioning is never enabled.
TEST(AxisPower, DisabledByConfigurationStaysOff) {
    auto config = plain_axis();
    config.disabled = true;
    Rig rig(config);
    rig.run(5);
    rig.axis.update(rig.now);

    EXPECT_EQ(rig.axis.power(true, true, true, Owner::program), ErrorId::drive_not_ready);
    rig.run(50);
    EXPECT_EQ(rig.drive.last.power, PowerRequest::off);
}

}  // namespace
}  // namespace taktwerk::axes::test
