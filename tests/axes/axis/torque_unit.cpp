// MC_TorqueControl on an axis: into the mode, in it, and out of it in motion without a jump. PLCopen Part 1 v2.0, 3.13.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

/// Rated torque gives 2000 u/s2; limits 100 u/s, 1000 u/s2.
AxisConfig torque_axis() {
    auto config = plain_axis();
    config.control.rated_acceleration = 2000;
    return config;
}
AxisCommand torque(double value, double ramp = 0, double velocity = 0, MC_Direction direction = mcPositiveDirection) {
    AxisCommand command{.kind = CommandKind::torque, .direction = direction, .velocity = velocity};
    command.details = TorqueDetails{value, ramp};
    return command;
}

struct TorqueRig : Rig {
    explicit TorqueRig(const AxisConfig& config = torque_axis(), const std::function<void(FakeDrive&)>& prepare = {})
        : Rig(config, prepare) {
        power_on();
    }
    /// What the motor feels, cycle by cycle: the largest change of its velocity, u/s per cycle.
    double largest_kick(int cycles) {
        double most = 0, before = motor_velocity();
        for (int i = 0; i < cycles; ++i) {
            step();
            most = std::max(most, std::abs(motor_velocity() - before));
            before = motor_velocity();
        }
        return most;
    }
    [[nodiscard]] double motor_velocity() const { return view().actual_velocity; }
};

// A drive that wants a pause after a change of its mode may yet take set-points in it. The axis would follow its own echo meanwhile.
TEST(TorqueAxis, APauseAfterTheChangeOfModeMakesNoDriveRunAwayThatTakesSetpointsInIt) {
    for (const int dead : {1, 2, 5}) {
        for (const auto pause : {1ms, 5ms, 30ms}) {
            for (const auto& next : {at_velocity(40), stop(), absolute(20, 40)}) {
                TorqueRig rig(torque_axis(), [&](FakeDrive& drive) {
                    drive.caps.mode_change_delay = pause;
                    drive.dead_cycles = dead;
                });
                rig.accept(torque(0.3, 0, 40));
                ASSERT_TRUE(rig.run_until([&] { return rig.motor_velocity() > 39; }, 1000));
                rig.accept(next);
                for (int i = 0; i < 300; ++i) {
                    rig.step();
                    ASSERT_LE(std::abs(rig.motor_velocity()), 46) << dead << " cycles late, pause " << to_seconds(pause);
                }
                EXPECT_TRUE(rig.alarms.empty());
            }
        }
    }
}

// P1-178, P1-179: the drive goes into cyclic torque, the torque follows its ramp, InTorque when it is there.
TEST(TorqueAxis, ApproachesTheTorqueWithItsRampAndHoldsIt) {
    TorqueRig rig;
    rig.drive.friction = 0.5;  // holds the motor
    const auto id = rig.accept(torque(0.25, 1));
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    ASSERT_TRUE(rig.run_until([&] { return rig.drive.last.torque != 0; }, 20));
    EXPECT_EQ(rig.drive.last.mode, DriveMode::cyclic_torque);
    double before = rig.drive.last.torque;
    int cycles = 1;
    while (rig.status(id) != CommandStatus::in_target && cycles < 400) {
        rig.step();
        ++cycles;
        EXPECT_LE(rig.drive.last.torque - before, 0.001 + 1e-12);
        before = rig.drive.last.torque;
    }
    EXPECT_EQ(cycles, 250);
    EXPECT_EQ(rig.drive.last.torque, 0.25);
    rig.run(500);
    EXPECT_EQ(rig.status(id), CommandStatus::in_target);
    EXPECT_EQ(rig.drive.last.torque, 0.25);
    EXPECT_TRUE(rig.alarms.empty());
}

// P1-180, P1-181: the velocity limit of the command binds; the limit also goes to drives that know one.
TEST(TorqueAxis, TheVelocityLimitHolds) {
    TorqueRig rig;
    const auto id = rig.accept(torque(0.8, 0, 30, mcNegativeDirection));
    rig.run(600);
    EXPECT_NEAR(rig.motor_velocity(), -30, 0.1);
    EXPECT_EQ(rig.status(id), CommandStatus::active) << "InTorque is FALSE: the velocity holds the torque back";
    EXPECT_EQ(rig.drive.last.velocity_limit, 30000);
    EXPECT_NEAR(rig.view().set_velocity, rig.motor_velocity(), 1e-9) << "the set-point follows the motor";
    EXPECT_EQ(rig.view().following_error, 0);
}

// P1-184, P1-187: positive direction with negative torque is a brake: down to standstill, not backwards.
TEST(TorqueAxis, NegativeTorqueInADirectionIsABrake) {
    TorqueRig rig;
    rig.accept(at_velocity(50));
    rig.run(200);
    rig.accept(torque(-0.3));
    rig.run(600);
    EXPECT_NEAR(rig.motor_velocity(), 0, 0.05);
    EXPECT_GT(rig.view().actual_position, 5);
    // P1-181: without a direction the torque's own sign decides.
    rig.accept(torque(-0.3, 0, 20, mcShortestWay));
    rig.run(300);
    EXPECT_NEAR(rig.motor_velocity(), -20, 0.1);
}

// P1-182: a motion command ends it. Bumpless: the motor goes on from where it is and as fast as it is.
TEST(TorqueAxis, AMotionCommandTakesOverInMotionWithoutAJump) {
    TorqueRig rig;
    const auto id = rig.accept(torque(0.3, 0, 40));
    rig.run(300);
    ASSERT_NEAR(rig.motor_velocity(), 40, 0.1);
    const auto next = rig.accept(absolute(60, 50));
    EXPECT_EQ(rig.status(id), CommandStatus::aborted);
    // 1000 u/s2 are 1 u/s per cycle; the rest is what a count more or less makes of a velocity.
    EXPECT_LE(rig.largest_kick(60), 1.0 + 2.1);
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_position);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(next), CommandStatus::done);
    EXPECT_EQ(rig.drive.last.position, 60000);
    EXPECT_TRUE(rig.alarms.empty());
}

// Relative moves count from where the motor was when they took over; P1-182: administrative blocks change nothing.
TEST(TorqueAxis, ParametersAreNoMotion) {
    TorqueRig rig;
    const auto id = rig.accept(torque(0.3, 0, 40));
    rig.run(300);
    EXPECT_EQ(rig.axis.set(Override{0.5, 1, 1}, Owner::program), ErrorId::none);
    rig.run(10);
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_torque);
}

TEST(TorqueAxis, StopAndHaltEndAtStandstill) {
    for (const auto& command : {stop(), halt()}) {
        TorqueRig rig;
        rig.accept(torque(0.3, 0, 40));
        rig.run(300);
        const auto id = rig.accept(command);
        EXPECT_LE(rig.largest_kick(60), 1.0 + 2.1);
        ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::done; }, 500));
        EXPECT_EQ(rig.motor_velocity(), 0);
        if (command.kind == CommandKind::stop) rig.axis.release_stop(id, Owner::program);
        rig.run(3);
        EXPECT_EQ(rig.view().state, AxisState::Standstill);
    }
}

TEST(TorqueAxis, ASecondTorqueGoesOnFromTheFirst) {
    TorqueRig rig;
    rig.drive.friction = 0.5;
    rig.accept(torque(0.25, 1));
    rig.run(400);
    const auto id = rig.accept(torque(0.1, 1));
    rig.run(75);
    EXPECT_NEAR(rig.drive.last.torque, 0.175, 1e-9);
    rig.run(80);
    EXPECT_EQ(rig.status(id), CommandStatus::in_target);
}

// P1-092: InTorque starts what waits.
TEST(TorqueAxis, ABufferedMoveBeginsWithInTorque) {
    TorqueRig rig;
    rig.drive.friction = 0.5;
    rig.accept(torque(0.25, 1));
    const auto next = rig.accept(absolute(10, 50, mcBuffered));
    rig.run(240);
    EXPECT_EQ(rig.status(next), CommandStatus::queued);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(next) == CommandStatus::done; }, 1000));
    EXPECT_EQ(rig.view().set_position, 10);
}

TEST(TorqueAxis, ALimitSwitchEndsIt) {
    TorqueRig rig;
    rig.drive.switches = true;
    rig.drive.positive_end = 5000;
    rig.accept(torque(0.3, 0, 40));
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 1000));
    EXPECT_TRUE(rig.raised(AxisAlarm::positive_limit_switch));
    ASSERT_TRUE(rig.run_until([&] { return rig.motor_velocity() == 0; }, 500));
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_position);
    EXPECT_FALSE(rig.raised(AxisAlarm::drive_mode_mismatch));
}

TEST(TorqueAxis, SoftwareLimitsHold) {
    auto config = torque_axis();
    config.homing.kind = HomingKind::set_here;
    config.limits.position_min = -1;
    config.limits.position_max = 10;
    TorqueRig rig(config);
    rig.accept(home(0));
    rig.run(5);
    rig.accept(torque(0.5, 0, 60));
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 1000));
    EXPECT_TRUE(rig.raised(AxisAlarm::software_limit_reached));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_velocity == 0; }, 500));
    EXPECT_LE(rig.view().actual_position, 10);
    EXPECT_GT(rig.view().actual_position, 9);
}

// A torque that is ended before anything of it is seen: the drive still shows the mode of before, and will be in torque for as long all the same. That is
// no word of its own.
TEST(TorqueAxis, AWishThatIsTakenBackAtOnceIsNoModeOfTheDrives) {
    for (const int dead : {1, 2, 4})
        for (int cycles = 1; cycles <= 12; ++cycles) {
            SCOPED_TRACE(::testing::Message() << dead << " cycles away, ended after " << cycles);
            TorqueRig rig(torque_axis(), [&](FakeDrive& drive) {
                drive.modes_travel = true;
                drive.dead_cycles = dead;
            });
            rig.accept(torque(0.3, 0, 40));
            rig.run(cycles);
            rig.accept(halt());
            bool was_in_torque = false;
            for (int i = 0; i < 200; ++i) {
                rig.step();
                was_in_torque = was_in_torque || rig.view().drive_mode == DriveMode::cyclic_torque;
                ASSERT_FALSE(rig.raised(AxisAlarm::drive_mode_mismatch)) << i;
            }
            EXPECT_TRUE(was_in_torque) << "it has shown nothing";
            EXPECT_EQ(rig.view().state, AxisState::Standstill);
            EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_position);
            // And it takes torque and moves again.
            rig.accept(torque(0.3, 0, 40));
            ASSERT_TRUE(rig.run_until([&] { return rig.motor_velocity() > 30; }, 1000));
            const auto move = rig.accept(absolute(10, 50));
            ASSERT_TRUE(rig.run_until([&] { return rig.status(move) == CommandStatus::done; }, 2000));
        }
}

// A link that fails while the drive is in torque: nobody hears in which mode it is, so nobody can say that it has refused one. The axis, whose error is that
// it hears nothing, comes to rest along its ramp; a drive that was told to leave its mode before has its time when it answers again.
TEST(TorqueAxis, ADriveThatIsNotHeardHasNotRefusedItsMode) {
    TorqueRig rig;
    rig.accept(torque(0.3, 0, 40));
    ASSERT_TRUE(rig.run_until([&] { return rig.motor_velocity() > 39; }, 1000));
    rig.accept(stop());
    rig.drive.silent = true;
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 100));
    EXPECT_TRUE(rig.raised(AxisAlarm::axis_feedback_lost));
    rig.run(3000);  // six times the patience with a drive that keeps its mode
    EXPECT_FALSE(rig.raised(AxisAlarm::drive_mode_mismatch));
    EXPECT_EQ(rig.view().set_velocity, 0);

    rig.drive.forced_mode = DriveMode::cyclic_torque;  // heard again, in the mode that it was lost in
    rig.drive.silent = false;
    rig.run(200);
    EXPECT_FALSE(rig.raised(AxisAlarm::drive_mode_mismatch));
}

// The same drive, heard all the time, that keeps its mode: that is the error. (The positive control of the one above.)
TEST(TorqueAxis, ADriveThatIsHeardAndKeepsItsModeIsAnError) {
    TorqueRig rig;
    rig.accept(torque(0.3, 0, 40));
    ASSERT_TRUE(rig.run_until([&] { return rig.motor_velocity() > 39; }, 1000));
    rig.drive.forced_mode = DriveMode::cyclic_torque;
    rig.accept(stop());
    rig.run(3000);
    EXPECT_TRUE(rig.raised(AxisAlarm::drive_mode_mismatch));
}

// A drive that does not take the mode: the command fails, the axis is where it was.
TEST(TorqueAxis, ADriveThatRefusesTheModeIsAnErrorOfTheCommand) {
    TorqueRig rig(torque_axis(), [](FakeDrive& drive) { drive.refuses_torque_mode = true; });
    const auto id = rig.accept(torque(0.3));
    rig.run(400);
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    rig.run(200);
    EXPECT_EQ(rig.error_of(id), ErrorId::drive_mode_refused);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 100));
    EXPECT_EQ(rig.view().set_position, 0);
    EXPECT_TRUE(rig.alarms.empty());
    rig.accept(absolute(5));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_position, 5);
}

TEST(TorqueAxis, WhatCannotBeBoundedOrIsUnknownIsRefused) {
    TorqueRig bare(plain_axis());
    EXPECT_EQ(bare.refuse(torque(0.3)), ErrorId::not_supported) << "neither the drive nor the axis could limit the velocity";
    TorqueRig without(torque_axis(), [](FakeDrive& drive) { drive.caps.modes = 1u << static_cast<unsigned>(DriveMode::cyclic_position); });
    EXPECT_EQ(without.refuse(torque(0.3)), ErrorId::not_supported);
    TorqueRig rig;
    EXPECT_EQ(rig.refuse(torque(std::numeric_limits<double>::quiet_NaN())), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.refuse(torque(0.3, -1)), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.refuse(torque(0.3, 0, -5)), ErrorId::invalid_velocity);
    EXPECT_EQ(rig.refuse({.kind = CommandKind::torque}), ErrorId::invalid_parameter);
}

// Drives that change their mode at standstill only: into torque from rest, out of it after braking in torque.
TEST(TorqueAxis, ADriveThatChangesAtStandstillIsBrakedInTorqueFirst) {
    const auto at_standstill = [](FakeDrive& drive) { drive.caps.mode_change_at_standstill = true; };
    TorqueRig rig(torque_axis(), at_standstill);
    rig.accept(at_velocity(20));
    rig.run(100);
    EXPECT_EQ(rig.refuse(torque(0.3)), ErrorId::not_at_standstill);
    rig.accept(halt());
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.accept(torque(0.3, 0, 40));
    rig.run(300);
    ASSERT_NEAR(rig.motor_velocity(), 40, 0.1);
    EXPECT_EQ(rig.refuse(absolute(1)), ErrorId::not_at_standstill);

    const auto id = rig.accept(stop());
    ASSERT_TRUE(rig.run_until([&] { return rig.drive.last.mode != DriveMode::cyclic_torque; }, 500));
    EXPECT_LE(std::abs(rig.motor_velocity()), 0.1) << "the window of standstill";
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::done; }, 100));
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_position);
    EXPECT_TRUE(rig.alarms.empty());
}

TEST(TorqueAxis, PowerGoesOffOutOfTorque) {
    TorqueRig rig;
    rig.accept(torque(0.3, 0, 40));
    rig.run(300);
    rig.enable = false;
    ASSERT_TRUE(rig.run_to(AxisState::Disabled, 1000));
    EXPECT_EQ(rig.motor_velocity(), 0);
    rig.power_on();
    rig.accept(relative(1));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_TRUE(rig.alarms.empty());
}

// ContinuousUpdate: other inputs, the same command.
TEST(TorqueAxis, AnUpdateChangesTheTorqueOnItsWay) {
    TorqueRig rig;
    rig.drive.friction = 0.5;
    const auto id = rig.accept(torque(0.25, 1));
    rig.run(100);
    EXPECT_EQ(rig.axis.update(id, torque(0.05, 1), Owner::program), ErrorId::none);
    rig.run(100);
    EXPECT_EQ(rig.drive.last.torque, 0.05);
    EXPECT_EQ(rig.status(id), CommandStatus::in_target);
}

// In torque the set-point follows the motor: both are told in the same coordinates, also in the cycle in which homing in passing gives them.
TEST(TorqueAxis, HomedInPassingItShowsBothPlacesInTheNewCoordinates) {
    TorqueRig rig(torque_axis(), [](FakeDrive& drive) {
        drive.switches = true;
        drive.home_low = 3000;
        drive.home_high = 9000;
    });
    HomingStepDetails step{.step = HomingStep::flying_switch, .switch_mode = MC_SwitchMode::mcRisingEdge, .set_position = 100};
    step.reference.source = TriggerSource::home_switch;
    const auto passing = rig.accept({.kind = CommandKind::homing_step, .details = step});
    rig.accept(torque(0.3, 0, 40));
    ASSERT_TRUE(rig.run_until(
        [&] {
            EXPECT_LT(std::abs(rig.view().set_position - rig.view().actual_position), 0.5);
            return rig.status(passing) == CommandStatus::done;
        },
        2000));
    EXPECT_GT(rig.view().actual_position, 90);
    EXPECT_LT(std::abs(rig.view().set_position - rig.view().actual_position), 0.5);  // 40 u/s for some cycles
}

}  // namespace
}  // namespace taktwerk::axes::test
