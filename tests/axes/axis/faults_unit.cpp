// Faults: what the axis announces, how it stops, how it comes back. No set-point jumps in any of them.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

// The drive falls while the axis moves at full speed: ErrorStop, commands end in error, the set-point follows the falling axis.
TEST(AxisFault, DriveFaultInMotionAndRecovery) {
    Rig rig;
    rig.power_on();
    const auto active = rig.accept(at_velocity(100));
    const auto waiting = rig.accept(absolute(0, 10, mcBuffered));
    rig.run(100);  // still accelerating: the waiting one has not started

    rig.drive.fault_code = 0x7500;
    rig.drive.coasting = 40;
    rig.run(3);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_EQ(rig.view().error, AlarmId{0x3002});
    EXPECT_EQ(rig.view().drive_error, 0x7500);
    EXPECT_EQ(rig.error_of(active), static_cast<ErrorId>(0x3002));
    EXPECT_EQ(rig.error_of(waiting), ErrorId::aborted_by_axis_error);  // P1-040
    ASSERT_EQ(rig.alarms.size(), 1u);                                  // one cause, one alarm: no "power lost" on top
    EXPECT_EQ(rig.alarms[0].id, 0x3002);
    EXPECT_EQ(rig.alarms[0].a, 0x7500);
    EXPECT_EQ(rig.refuse(absolute(1)), ErrorId::in_error_stop);  // P1-026
    rig.run(50);
    rig.drive.coasting = 0;
    rig.run(50);

    // P1-234: while the cause is there the reset fails and says so
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::none);
    EXPECT_TRUE(rig.view().resetting);
    rig.run(2100);
    EXPECT_FALSE(rig.view().resetting);
    EXPECT_EQ(rig.view().reset_error, ErrorId::reset_failed);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);

    // the cause goes: the fault reset reaches the drive, and Enable is still TRUE
    rig.drive.fault_code = 0;
    rig.axis.reset(Owner::program);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 200));
    EXPECT_TRUE(rig.axis.active_alarms().empty());
    EXPECT_EQ(rig.view().queued_count, 0);  // P1-042
    const auto again = rig.accept(absolute(0, 100));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(again), CommandStatus::done);
    rig.expect_no_jump();
}

// P1-024: in ErrorStop MC_Power may switch off, the state stays; note 3 then leads to Disabled.
TEST(AxisFault, PowerOffInErrorStopKeepsTheState) {
    Rig rig;
    rig.power_on();
    rig.axis.stop_for_error(0x6001, false);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    rig.run(5);
    EXPECT_EQ(rig.drive.power, PowerState::enabled);
    rig.enable = false;
    rig.run(5);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_EQ(rig.drive.power, PowerState::disabled);

    rig.axis.reset(Owner::program);
    rig.run(3);
    EXPECT_EQ(rig.view().state, AxisState::Disabled);
}

// A machine-wide stop with power off: the axis ramps down, then power goes, and only a reset brings it back although Enable stays TRUE.
TEST(AxisFault, MachineStopWithPowerOffRampsFirst) {
    Rig rig;
    rig.power_on();
    rig.accept(at_velocity(100));
    rig.run(300);
    rig.axis.stop_for_error(0x6001, true);
    bool off_while_moving = false;
    ASSERT_TRUE(rig.run_until([&] {
        off_while_moving = off_while_moving || (rig.drive.last.power == PowerRequest::off && rig.view().set_velocity != 0);
        return rig.drive.power == PowerState::disabled;
    }));
    EXPECT_FALSE(off_while_moving);
    rig.run(100);
    EXPECT_EQ(rig.drive.power, PowerState::disabled);
    EXPECT_EQ(rig.alarms.back().a, 0x6001);

    rig.axis.reset(Owner::operator_panel);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 200));
    rig.expect_no_jump();
}

// An idle, switched-off axis is not drawn into errors of others.
TEST(AxisFault, MachineStopLeavesADisabledAxisAlone) {
    Rig rig;
    rig.run(10);
    rig.axis.stop_for_error(0x6001, true);
    rig.axis.demand_emergency_stop(EmergencyStop::stop_and_power_off);
    rig.run(10);
    EXPECT_EQ(rig.view().state, AxisState::Disabled);
    EXPECT_TRUE(rig.alarms.empty());
}

// The emergency stop is a level: while it is there nothing is enabled, commanded or reset.
TEST(AxisFault, EmergencyStopHoldsWhileItIsDemanded) {
    auto config = plain_axis();
    config.limits.stop_deceleration = 4000;
    config.limits.stop_jerk = 200'000;
    Rig rig(config);
    rig.power_on();
    rig.accept(at_velocity(100));
    rig.run(300);
    const auto begin = rig.now;
    rig.axis.demand_emergency_stop(EmergencyStop::stop_and_power_off);
    ASSERT_TRUE(rig.run_until([&] { return rig.drive.power == PowerState::disabled; }));
    // 100 u/s with 4000 u/s2 and 200000 u/s3: 25 ms + 20 ms of jerk, and a few cycles for the drive
    EXPECT_LE(rig.now - begin, 55ms);
    EXPECT_TRUE(rig.raised(AxisAlarm::emergency_stop));
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::interlocked);
    rig.run(100);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);

    rig.axis.demand_emergency_stop(EmergencyStop::none);
    rig.run(100);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);  // releasing the button starts nothing
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 200));
    rig.expect_no_jump();
}

// A few cycles without answer are ridden out in motion time; more than the limit stop the axis.
TEST(AxisFault, MissedFeedbackIsToleratedUpToTheLimit) {
    Rig rig;
    rig.power_on();
    rig.accept(at_velocity(50));
    rig.run(300);
    const double before = rig.view().set_position;

    rig.drive.silent = true;
    rig.run(3);  // stale_limit
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    EXPECT_NEAR(rig.view().set_position, before + 3 * 0.05, 1e-9);
    EXPECT_TRUE(rig.view().online);
    rig.drive.silent = false;
    rig.run(10);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);

    rig.drive.silent = true;
    rig.run(4);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_FALSE(rig.view().online);
    EXPECT_TRUE(rig.raised(AxisAlarm::axis_feedback_lost));
    rig.run(500);
    EXPECT_EQ(rig.view().set_velocity, 0);

    // It comes back, still enabled: the set-point held, so nothing jumps.
    rig.drive.silent = false;
    rig.axis.reset(Owner::program);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 200));
    rig.expect_no_jump();
}

// While a drive is silent it may still be enabled: its set-point is held until it is known to have let go.
TEST(AxisFault, SilentDriveIsNotPulledToItsOldPosition) {
    Rig rig;
    rig.power_on();
    rig.accept(at_velocity(100));
    rig.run(300);
    rig.drive.silent = true;
    rig.run(10);
    rig.enable = false;  // wanted off now; the ramp comes first
    rig.run(400);
    const auto held = rig.drive.last.position;
    rig.run(100);
    EXPECT_EQ(rig.drive.last.position, held);
    EXPECT_EQ(rig.drive.last.power, PowerRequest::off);
    rig.expect_no_jump();
}

// An incremental axis that left the bus may come back with another zero.
TEST(AxisFault, LeavingTheBusLosesTheReference) {
    auto config = plain_axis();
    config.homing.kind = HomingKind::set_here;
    config.require_homed = true;
    Rig rig(config);
    rig.power_on();
    EXPECT_EQ(rig.refuse(absolute(1)), ErrorId::not_homed);
    rig.accept(home(12.5));
    rig.run(3);
    ASSERT_TRUE(rig.view().homed);
    rig.drive.offline = true;
    rig.run(10);
    EXPECT_FALSE(rig.view().homed);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
}

// What it shows is its command: where a motor without an encoder has come to rest after a fault nobody knows (SE-808X 2.4).
TEST(AxisFault, AMotorWithoutAnEncoderIsNotHomedAfterAFault) {
    for (const bool encoder : {true, false}) {
        auto config = plain_axis();
        config.homing.kind = HomingKind::set_here;
        Rig rig(config, [&](FakeDrive& drive) { drive.caps.motor_has_encoder = encoder; });
        rig.power_on();
        rig.accept(home(0));
        rig.run(5);
        ASSERT_TRUE(rig.view().homed);
        rig.drive.fault_code = 0x3221;
        rig.run(10);
        EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
        EXPECT_EQ(rig.view().homed, encoder);
    }
}

// Warnings are shown and go by themselves.
TEST(AxisFault, WarningStopsNothingAndClearsItself) {
    Rig rig;
    rig.power_on();
    rig.accept(at_velocity(10));
    rig.drive.warning = true;
    rig.run(50);
    EXPECT_TRUE(rig.raised(AxisAlarm::drive_warning));
    EXPECT_EQ(rig.axis.active_alarms().size(), 1u);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    rig.drive.warning = false;
    rig.run(2);
    EXPECT_TRUE(rig.axis.active_alarms().empty());
    EXPECT_EQ(rig.alarms.size(), 1u);
}

// A drive in another mode does not follow our set-points: stop, and power off.
TEST(AxisFault, ForeignModeStopsAndSwitchesOff) {
    Rig rig;
    rig.power_on();
    rig.drive.forced_mode = DriveMode::profile_velocity;
    rig.run(10);
    EXPECT_TRUE(rig.raised(AxisAlarm::drive_mode_mismatch));
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_EQ(rig.drive.power, PowerState::disabled);
}

// Ending the run (Ctrl-C): ramp, then power off, without an error.
TEST(AxisFault, ShutDownRampsAndSwitchesOffWithoutError) {
    Rig rig;
    rig.power_on();
    rig.accept(at_velocity(100));
    rig.run(300);
    rig.program = {};
    rig.enable = false;
    rig.axis.shut_down();
    EXPECT_EQ(rig.view().state, AxisState::Stopping);
    ASSERT_TRUE(rig.run_to(AxisState::Disabled));
    rig.run(5);
    EXPECT_EQ(rig.drive.power, PowerState::disabled);
    EXPECT_TRUE(rig.alarms.empty());
    rig.expect_no_jump();
}

// A drive's shared alarm code is told apart by a further object that is read later (SV33-E P21.08): the alarm's number follows.
TEST(AxisFault, TheDetailOfADrivesAlarmArrivesAfterItAndIsShown) {
    Rig rig;
    rig.power_on();
    rig.drive.fault_code = 0x7305;
    rig.run(5);
    ASSERT_EQ(rig.view().state, AxisState::ErrorStop);
    ASSERT_FALSE(rig.axis.active_alarms().empty());
    EXPECT_EQ(rig.axis.active_alarms()[0].b, 0.0);

    rig.drive.alarm_detail = 0x731;
    rig.run(2);
    EXPECT_EQ(rig.axis.active_alarms()[0].a, 0x7305);
    EXPECT_EQ(rig.axis.active_alarms()[0].b, 0x731);
}

// An alarm that needs a power cycle: MC_Reset says so at once instead of waiting for what cannot come (SV33-E table 7.2, R = no).
TEST(AxisFault, AResetOfAnAlarmThatNeedsAPowerCycleFailsAtOnce) {
    Rig rig;
    rig.power_on();
    rig.drive.fault_code = 0x2312;
    rig.drive.resettable = false;
    rig.run(5);
    ASSERT_EQ(rig.view().state, AxisState::ErrorStop);

    rig.axis.reset(Owner::program);
    rig.run(3);
    EXPECT_FALSE(rig.view().resetting);
    EXPECT_EQ(rig.view().reset_error, ErrorId::reset_failed);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
}

// AxisView::resetting: it waits for standstill. 100 u/s at 20 u/s2 are 5 s, longer than a drive has for its fault.
TEST(AxisFault, AResetGivenInALongRampWaitsForItsEnd) {
    auto config = plain_axis();
    config.limits.deceleration = config.limits.stop_deceleration = 20;
    Rig rig(config);
    rig.power_on();
    rig.accept(at_velocity(100));
    rig.run(500);
    rig.axis.stop_for_error(AlarmId{4711}, false);
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::none);
    rig.run(3000);
    EXPECT_TRUE(rig.view().resetting);
    ASSERT_TRUE(rig.run_until([&] { return !rig.view().resetting; }, 3000));
    EXPECT_EQ(rig.view().reset_error, ErrorId::none);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
}

// A drive that was away may count from another zero. Its axis has no power, so the set-point goes there at once: enabling does not wait.
TEST(AxisFault, ADriveThatComesBackWithAnotherZeroTakesTheSetPointAlong) {
    Rig rig;
    rig.power_on();
    rig.enable = false;
    ASSERT_TRUE(rig.run_to(AxisState::Disabled, 1000));
    rig.run(10);  // the drive has followed
    rig.drive.offline = true;
    rig.run(20);

    rig.drive.zero = -5'000'000;  // 5000 u away: at 100 u/s the set-point would walk for 50 s
    ++rig.drive.epoch;
    rig.drive.offline = false;
    rig.run(3);
    EXPECT_NEAR(rig.view().set_position, rig.view().actual_position, 0.001);
    rig.enable = true;
    EXPECT_TRUE(rig.run_to(AxisState::Standstill, 200));
    EXPECT_LE(rig.drive.largest_step, 101);
}

}  // namespace
}  // namespace taktwerk::axes::test
