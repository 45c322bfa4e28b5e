// Where one thing ends while another begins: what random walks (coupled_walk.hpp) found there, each in a few lines. What is asserted beside the oracle
// of the rigs, which looks at every cycle, is that the scene was played at all.

#include "tests/axes/axis/coupling_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisCommand torque_of(double value) { return {.kind = CommandKind::torque, .details = TorqueDetails{value, 0}}; }

/// Several axes with a jerk limit: 100 u/s, 1000 u/s2, 20000 u/s3.
std::vector<AxisConfig> jerked(std::size_t count) { return std::vector<AxisConfig>(count, plain_axis()); }

// A slave with something superimposed gets a faster master: the sum keeps the velocity limit, the slave falls behind.
TEST(Seams, ASlaveWithAnAdditionKeepsTheLimitWhenItsMasterGetsFaster) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(60));
    const auto gear = rig.accept(1, gear_in(0));
    ASSERT_TRUE(rig.run_to_sync(1, gear));
    rig.accept(1, on_top(30, 30));
    rig.run(100);
    ASSERT_NEAR(rig.view(1).set_velocity, 90, 1e-6);
    rig.accept(0, at_velocity(100));
    double most = 0;
    for (int i = 0; i < 400; ++i) {
        rig.step();
        most = std::max(most, rig.view(1).set_velocity);
    }
    EXPECT_GT(most, 99);
    EXPECT_LE(most, 100 * (1 + 1e-9));
}

// Where the drive takes no set-point there is nothing to add to: refused beside a torque, also before the drive has taken its mode.
TEST(Seams, NothingIsSuperimposedOnATorque) {
    auto config = plain_axis();
    config.control.rated_acceleration = 2000;
    Rig rig(config, [](FakeDrive& drive) { drive.mode_delay = 30; });
    rig.power_on();
    rig.accept(at_velocity(20));
    rig.run(200);
    rig.accept(torque_of(0.1));
    rig.step();
    ASSERT_NE(rig.view().drive_mode, DriveMode::cyclic_torque);
    EXPECT_EQ(rig.refuse(on_top(5, 10)), ErrorId::state_forbids);
    ASSERT_TRUE(rig.run_until([&] { return rig.view().drive_mode == DriveMode::cyclic_torque; }, 200));
    EXPECT_EQ(rig.refuse(on_top(5, 10)), ErrorId::state_forbids);
}

// A torque behind a move with an addition: until the drive has taken its mode the addition halts along its ramp, in its own time.
TEST(Seams, AnAdditionHaltsBeforeATorque) {
    auto config = plain_axis();
    config.control.rated_acceleration = 2000;
    Rig rig(config, [](FakeDrive& drive) { drive.mode_delay = 30; });
    rig.power_on();
    rig.accept(absolute(20, 50));
    rig.run(200);
    const auto addition = rig.accept(on_top(60, 20));
    auto command = torque_of(0.1);
    command.buffer_mode = mcBuffered;
    const auto push = rig.accept(command);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(push) == CommandStatus::active; }, 1000));
    EXPECT_EQ(rig.status(addition), CommandStatus::aborted);
    ASSERT_NEAR(rig.view().set_velocity, 20, 0.2);
    rig.run(10);  // 20000 u/s3 take off 20000 * 0.01^2 / 2 = 1 u/s
    EXPECT_NEAR(rig.view().set_velocity, 19, 0.3);
    ASSERT_TRUE(rig.run_until([&] { return rig.view().drive_mode == DriveMode::cyclic_torque; }, 1000));
}

// A table over time that begins in the very instant in which the move before it ends, and is aborted in the next scan, has never moved the axis:
// nothing of its first acceleration is shown or left. (20 u at 50 u/s with 1000 u/s2 and 20000 u/s3 take 0.4 + 0.05 + 0.05 s: whole cycles.)
TEST(Seams, ATableAbortedBeforeItMovedLeavesNothing) {
    CouplingRig rig(jerked(1));
    const auto table = rig.tables.add_time_table(std::vector<TimePoint>{{200ms, 100.0}, {200ms, 0.0}});
    rig.start();
    rig.accept(0, absolute(20, 50));
    const auto given = rig.accept(
        0, {.kind = CommandKind::acceleration_profile, .buffer_mode = mcBuffered, .details = TimeProfileDetails{table, 1, 1, 0}});
    ASSERT_TRUE(rig.run_until([&] { return rig.status(0, given) == CommandStatus::active; }, 1000));
    EXPECT_NEAR(rig.view(0).set_velocity, 0, 1e-9);
    EXPECT_NEAR(rig.view(0).set_acceleration, 0, 1e-6);
    rig.accept(0, halt());
    rig.run(50);
    EXPECT_NEAR(rig.view(0).set_position, 20, 1e-9);
    EXPECT_EQ(rig.status(0, given), CommandStatus::aborted);
}

// ContinuousUpdate of an addition with less jerk while it speeds up: the acceleration that is there goes as fast as the limit of the sum needs.
TEST(Seams, AnAdditionUpdatedWithLessJerkKeepsTheLimit) {
    Rig rig;
    rig.power_on();
    rig.accept(at_velocity(50));
    rig.run(300);
    auto command = on_top(100, 0);
    const auto addition = rig.accept(command);
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_acceleration > 700; }, 200));
    command.jerk = 3000;
    EXPECT_EQ(rig.axis.update(addition, command, Owner::program), ErrorId::none);
    double most = 0;
    for (int i = 0; i < 500; ++i) {
        rig.step();
        most = std::max(most, rig.view().set_velocity);
    }
    EXPECT_GT(most, 99);
    EXPECT_LE(most, 100 * (1 + 1e-9));
}

// A motion and a coupling that waits for its master are given in one scan, over a motion with an addition: the motion never began, the axis goes
// on as it moved.
TEST(Seams, AWaitingCouplingEndsAMotionThatHadNotBegun) {
    CouplingRig rig(jerked(2));
    rig.start();
    rig.accept(1, at_velocity(40));
    rig.run(200);
    rig.accept(1, on_top(20, 20));
    rig.run(80);
    ASSERT_GT(rig.view(1).set_velocity, 50);
    const auto motion = rig.accept(1, relative(100, 30));
    const auto coupling = rig.accept(1, gear_in_pos(0, 100, 0, 30));
    EXPECT_EQ(rig.status(1, motion), CommandStatus::aborted);
    rig.run(300);
    EXPECT_EQ(rig.status(1, coupling), CommandStatus::active);
    const double here = rig.view(1).set_position;
    rig.run(100);
    EXPECT_NEAR(rig.view(1).set_position - here, rig.view(1).set_velocity * 0.1, 1e-6);
    EXPECT_GT(rig.view(1).set_velocity, 1);
}

// The axis speeds up when its direction is barred and loses its acceleration with its own jerk. What is given meanwhile is stopped in the very cycle in
// which it begins and has moved nothing: the acceleration goes on as it went. (A slave's, or a table's, would be dropped at once.)
TEST(Seams, WhatIsBarredInItsFirstCycleHasNotMadeTheAcceleration) {
    CouplingRig rig(jerked(2));
    const auto table = rig.tables.add_time_table(std::vector<TimePoint>{{1s, 60.0}, {1s, 0.0}});
    rig.start();
    const std::vector<AxisCommand> given{
        gear_in(0),
        combine(0, 0),
        {.kind = CommandKind::velocity_profile, .details = TimeProfileDetails{table, 1, 1, 0}},
        {.kind = CommandKind::external},
    };
    for (const auto& command : given) {
        SCOPED_TRACE(static_cast<int>(command.kind));
        rig.permits[1] = 3;
        rig.step();
        rig.accept(1, at_velocity(80));
        ASSERT_TRUE(rig.run_until([&] { return rig.view(1).set_acceleration > 900; }, 100));
        rig.permits[1] = 2;
        rig.run(20);  // 900 u/s2 with 20000 u/s3: 45 cycles
        const double before = rig.view(1).set_acceleration;
        ASSERT_GT(before, 400);
        const auto barred = rig.accept(1, command);
        rig.step();
        EXPECT_EQ(rig.error_of(1, barred), ErrorId::interlocked);
        EXPECT_NEAR(rig.view(1).set_acceleration, before - 20, 1e-6);
        rig.run(300);
        EXPECT_EQ(rig.view(1).state, AxisState::Standstill);
    }
}

// MC_Home behind a move, in place: the view's set and actual position change their coordinates in one cycle.
TEST(Seams, AHomingBehindAMoveShowsBothPositionsAnewAtOnce) {
    auto config = plain_axis();
    config.homing.kind = HomingKind::set_here;
    Rig rig(config);
    rig.power_on();
    rig.accept(absolute(10, 50));
    auto command = home(500);
    command.buffer_mode = mcBuffered;
    const auto homing = rig.accept(command);
    ASSERT_TRUE(rig.run_until(
        [&] {
            EXPECT_NEAR(rig.view().set_position, rig.view().actual_position, 1);  // lag of a few cycles at 50 u/s
            return rig.status(homing) == CommandStatus::done;
        },
        2000));
    EXPECT_NEAR(rig.view().set_position, 500, 1e-9);
    EXPECT_NEAR(rig.view().actual_position, 500, 0.2);
    EXPECT_TRUE(rig.view().homed);
}

// A profile of the drive behind a move with an addition: the addition halts along its ramp, then the drive takes over.
TEST(Seams, AnAdditionHaltsBeforeAProfileOfTheDrive) {
    Rig rig(plain_axis(), [](FakeDrive& drive) {
        drive.caps.profile_buffer = 1;
        drive.caps.velocity_limit = true;
    });
    rig.power_on();
    rig.accept(absolute(20.013, 47));  // ends between two cycles
    rig.run(200);
    rig.accept(on_top(40, 20));
    const auto by_drive = rig.accept({.kind = CommandKind::drive_move_absolute, .buffer_mode = mcBuffered, .position = 60, .velocity = 30});
    ASSERT_TRUE(rig.run_until([&] { return rig.status(by_drive) == CommandStatus::done; }, 8000));
    EXPECT_NEAR(rig.view().actual_position, 60, 0.01);
}

// MaxVelocityAppl is lowered under a motion over a drive in CSV: the loop may still give what the system allows, or a motor that is faster than
// the new limit would be torn back. Its limit is 1.2 times 100 u/s.
TEST(Seams, AnApplicationLimitDoesNotCutWhatTheLoopGives) {
    auto config = plain_axis();
    config.control = {.mode = ControlMode::velocity, .kv = 20};
    Rig rig(config);
    rig.power_on();
    rig.accept(at_velocity(90));
    rig.run(300);
    ASSERT_EQ(rig.view().drive_mode, DriveMode::cyclic_velocity);
    ASSERT_NEAR(rig.drive.last.velocity, 90'000, 100);
    EXPECT_EQ(rig.axis.set(WriteParameter{velocity_of_application, 20}, Owner::program), ErrorId::none);
    rig.step();
    EXPECT_GT(rig.drive.last.velocity, 85'000);  // it brakes with 1000 u/s2, not at once to 24 u/s
    rig.run(500);
    EXPECT_GT(rig.oracle.compared(), 500);
}

}  // namespace
}  // namespace taktwerk::axes::test
