// An axis over the line of an XP200: power, motion, stops, reset, homing, and what happens when the line falls silent.

#include "tests/axes/drives/xp200/axis_rig.hpp"

namespace taktwerk::axes::xp200 {
namespace {

TEST(Xp200Axis, OpensTheDriveStoppedAndDisabledAndSetsItsParameters) {
    AxisRig rig;
    rig.drive.servo().power_on(rig.now);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().online; }, 5s));
    const auto& parameters = rig.drive.servo().parameters();
    EXPECT_EQ(parameters[25], 1) << "internal speeds (5.4.1 Pr025)";
    EXPECT_EQ(parameters[136], 1);
    EXPECT_EQ(parameters[108], 9);
    EXPECT_EQ(parameters[122], 0);
    EXPECT_FALSE(rig.drive.servo().energised());
    EXPECT_TRUE(rig.port.setup_problems().empty());
}

// 5.4.2 Pr169: brake release 500 ms, so the axis reports power 600 ms after RUN at the earliest; disabling holds Pr166 for the brake.
TEST(Xp200Axis, PowerOnWaitsForRunAndTheBrakeAndPowerOffForRest) {
    AxisRig rig;
    rig.drive.servo().power_on(rig.now);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().online; }, 5s));
    rig.power();
    ASSERT_TRUE(rig.until([&] { return rig.drive.servo().energised(); }, 1s));
    const auto energised = rig.now;
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().powered; }, 2s));
    EXPECT_GE(rig.now - energised, 600ms);
    EXPECT_EQ(rig.drive.servo().enabled_in_motion(), 0u);
    rig.power(false);
    ASSERT_TRUE(rig.until([&] { return !rig.drive.servo().energised(); }, 2s));
    EXPECT_TRUE(rig.until([&] { return rig.axis.view().drive_state == PowerState::disabled; }, 1s));
}

// 50 mm/s are 300 r/min. The motor gets there by steps of the line, and the axis shows the velocity it has.
TEST(Xp200Axis, MoveVelocityReachesItsSpeedAndHalts) {
    AxisRig rig;
    rig.go();
    ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, 50).error, ErrorId::none);
    rig.run(2s);
    EXPECT_EQ(rig.axis.view().state, AxisState::ContinuousMotion);
    EXPECT_NEAR(rig.rpm(), 300, 3);
    EXPECT_NEAR(rig.axis.view().actual_velocity, 50, 1);
    rig.run(5s);
    EXPECT_NEAR(rig.rpm(), 300, 3);
    EXPECT_LT(std::abs(rig.axis.view().following_error), 3);
    ASSERT_EQ(rig.submit(CommandKind::halt, 0, 0).error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::Standstill; }, 2s));
    EXPECT_NEAR(rig.rpm(), 0, 0.5) << "done only when the motor stands";
    const double at = rig.millimetres();
    rig.run(2s);
    EXPECT_NEAR(rig.millimetres(), at, 0.03) << "it does not creep back to where the set-point ended";
}

// MC_Stop: one word on the line (Pr122 = 0), and the drive ramps by Pr061: 100 mm/s2 are 600 r/min per s, 1667 ms for 1000 r/min (4.3.4).
TEST(Xp200Axis, StopSelectsRestFirstAndTheDriveRamps) {
    AxisRig rig;
    rig.go();
    ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, 50).error, ErrorId::none);
    rig.run(2s);
    ASSERT_EQ(rig.submit(CommandKind::stop, 0, 0, 100).error, ErrorId::none);
    const auto stopped = rig.now;
    ASSERT_TRUE(rig.until([&] { return rig.drive.servo().parameters()[122] == 0; }, 100ms));
    EXPECT_LT(rig.now - stopped, 40ms);
    rig.run(100ms);
    EXPECT_EQ(rig.drive.servo().parameters()[61], 1667);
    ASSERT_TRUE(rig.until([&] { return std::abs(rig.rpm()) < 1; }, 2s));
    EXPECT_NEAR(to_seconds(rig.now - stopped), 0.5, 0.15);  // 50 mm/s at 100 mm/s2
    EXPECT_EQ(rig.axis.view().state, AxisState::Stopping) << "Execute is still held";
}

// P1-127, P1-128: Done when the axis stands, which its motor does after its set-point. An Execute that falls between the two takes no Done away,
// and what waits begins behind it.
TEST(Xp200Axis, AStopThatIsReleasedBeforeTheMotorStandsIsDoneAllTheSame) {
    AxisRig rig;
    rig.go();
    ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, 80).error, ErrorId::none);
    rig.run(2s);
    const auto stop = rig.submit(CommandKind::stop, 0, 0);
    ASSERT_EQ(stop.error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().set_velocity == 0; }, 1s));
    ASSERT_EQ(rig.axis.view().status(stop.id), CommandStatus::active) << "the motor still turns";
    AxisCommand next{.kind = CommandKind::move_relative, .buffer_mode = mcBuffered, .position = 5, .velocity = 20};
    const auto waiting = rig.axis.submit(next, Owner::program);
    ASSERT_EQ(waiting.error, ErrorId::none);
    rig.axis.release_stop(stop.id, Owner::program);
    EXPECT_EQ(rig.axis.view().state, AxisState::Stopping);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().status(stop.id) == CommandStatus::done; }, 1s));
    EXPECT_NEAR(rig.rpm(), 0, 1);
    EXPECT_TRUE(rig.until([&] { return rig.axis.view().status(waiting.id) == CommandStatus::done; }, 3s));
}

// A motor that was held comes free just when the axis is halted, and is faster than the questions: a position from before says that it stands. Done
// counts when one that was asked for after the halt says so; else the position loop would take it back there.
TEST(Xp200Axis, AHaltBelievesNoPositionFromBeforeIt) {
    for (auto later = 0ms; later < 8ms; later += 1ms) {
        AxisRig rig;
        rig.go();
        rig.drive.servo().jam(true);
        ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, 5).error, ErrorId::none);
        rig.run(527ms);
        rig.drive.servo().jam(false);
        rig.run(later);
        ASSERT_EQ(rig.submit(CommandKind::halt, 0, 0).error, ErrorId::none);
        ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::Standstill; }, 2s));
        EXPECT_NEAR(rig.rpm(), 0, 5) << to_seconds(later);
        const double at = rig.millimetres();
        rig.run(2s);
        EXPECT_NEAR(rig.millimetres(), at, 0.06) << to_seconds(later);
    }
}

// It comes to rest behind its last set-point. That is where it is from then on: what the set-point was while the line still told of it drives nothing.
TEST(Xp200Axis, AHaltedMotorIsNotDrivenToWhereTheSetPointWas) {
    AxisRig rig;
    rig.go();
    ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, 90).error, ErrorId::none);
    rig.run(2s);
    ASSERT_EQ(rig.submit(CommandKind::halt, 0, 0).error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::Standstill; }, 2s));
    const double at = rig.millimetres();
    double furthest = 0;
    (void)rig.until([&] { return furthest = std::max(furthest, std::abs(rig.millimetres() - at)), false; }, 500ms);
    EXPECT_LE(furthest, 0.03) << "a turn per minute or two for the window of a count";
}

// A stop in the middle of a reversal: the motor, which turns round a poll and a ramp after its set-point, brakes at once from the speed that it has, the
// set-point from its own. They come to rest far from each other, and the drive has done what it was told. Told to move again at once, it makes up the rest.
TEST(Xp200Axis, AStopInAReversalIsNoFollowingError) {
    for (auto later = 500ms; later < 1000ms; later += 100ms) {
        AxisRig rig{{{97, 33}, {108, 9}, {136, 1}, {164, 1}, {63, 200}}, {}, HomingKind::set_here, {}, 14};
        rig.go();
        ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, 90).error, ErrorId::none);
        rig.run(2s);
        ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, -90).error, ErrorId::none);
        rig.run(later);
        ASSERT_NE(rig.axis.view().state, AxisState::ErrorStop) << "a reversal alone stays in the window, " << to_seconds(later);
        ASSERT_EQ(rig.submit(CommandKind::halt, 0, 0).error, ErrorId::none);
        rig.run(200ms);
        const double apart = std::abs(rig.axis.view().following_error);
        ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, -20).error, ErrorId::none);
        rig.run(4s);
        EXPECT_EQ(rig.axis.view().state, AxisState::ContinuousMotion) << to_seconds(later) << " s, " << apart << " mm apart";
        EXPECT_NEAR(rig.axis.view().following_error, 0, 1) << "made up";
    }
}

// One that does not brake is one all the same.
TEST(Xp200Axis, AMotorThatRunsOnAfterAStopIsAFollowingError) {
    AxisRig rig;
    rig.go();
    ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, 50).error, ErrorId::none);
    rig.run(2s);
    const auto selected = static_cast<std::uint16_t>(rig.drive.servo().parameters()[122]);
    ASSERT_NE(selected, 0);
    ASSERT_EQ(rig.submit(CommandKind::halt, 0, 0).error, ErrorId::none);
    const double from = rig.millimetres();
    ASSERT_TRUE(rig.until(
        [&] {
            (void)rig.drive.servo().parameters().write(122, selected);  // the speed stays selected, whoever did that
            return rig.axis.view().state == AxisState::ErrorStop;
        },
        3s));
    EXPECT_GT(rig.millimetres() - from, 10) << "beyond the window, and the way that it takes to brake";
}

TEST(Xp200Axis, JogForwardAndBackEndsByItsLease) {
    AxisRig rig;
    rig.go();
    for (const double velocity : {20.0, -20.0}) {
        const auto jog = rig.submit(CommandKind::jog, 0, velocity);
        ASSERT_EQ(jog.error, ErrorId::none);
        for (int i = 0; i < 10; ++i) {
            rig.run(100ms);
            EXPECT_EQ(rig.axis.renew_jog(jog.id, velocity, Owner::program), ErrorId::none);
        }
        EXPECT_NEAR(rig.rpm(), velocity * 6, 6);
        ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::Standstill; }, 3s)) << "nobody renews it";
        EXPECT_NEAR(rig.rpm(), 0, 1);
    }
}

// Coarse supervised positioning: one r/min is 167 counts/s, kv 3/s: it rests within 0.5 / 3 * 167 = 28 counts, 0.028 mm.
TEST(Xp200Axis, MoveAbsoluteEndsInItsWindow) {
    AxisRig rig;
    rig.go();
    ASSERT_EQ(rig.submit(CommandKind::home, 0, 0).error, ErrorId::none);
    rig.run(50ms);
    ASSERT_TRUE(rig.axis.view().homed);
    const double zero = rig.millimetres();
    for (const double target : {100.0, 99.0, -50.0}) {
        ASSERT_EQ(rig.submit(CommandKind::move_absolute, target, 60).error, ErrorId::none);
        ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::Standstill; }, 10s)) << target;
        EXPECT_NEAR(rig.millimetres() - zero, target, 0.06) << "window 0.05 mm";
        EXPECT_EQ(rig.axis.view().error, 0);
        rig.run(1s);
        EXPECT_NEAR(rig.millimetres() - zero, target, 0.06);
    }
}

// A fed, coupled or tabled set-point does not get through a slow line.
TEST(Xp200Axis, WhatNeedsEachCycleIsNotSupported) {
    AxisRig rig;
    rig.go();
    for (const auto kind :
         {CommandKind::gear_in, CommandKind::gear_in_pos, CommandKind::cam_in, CommandKind::combine, CommandKind::external,
          CommandKind::position_profile, CommandKind::velocity_profile, CommandKind::acceleration_profile, CommandKind::torque})
        EXPECT_NE(rig.submit(kind, 0, 10).error, ErrorId::none) << static_cast<int>(kind);
    EXPECT_EQ(rig.submit(CommandKind::gear_in, 0, 10).error, ErrorId::not_supported);
    EXPECT_EQ(rig.submit(CommandKind::external, 0, 10).error, ErrorId::not_supported);
}

// Homing by the host (9 of the manual has none): home switch at DI6 from -30 mm down; the edge is taken at 2 mm/s, so a look at the switch
// each 60 ms or so leaves about 0.2 mm.
TEST(Xp200Axis, HomesOnASwitchAtItsInput) {
    AxisRig rig{{{97, 33}, {108, 9}, {136, 1}, {164, 1}, {63, 200}, {105, 0}}, {}, HomingKind::home_switch};
    rig.go();
    ASSERT_EQ(rig.submit(CommandKind::home, 0, 0).error, ErrorId::none);
    const bool done = rig.until(
        [&] {
            rig.drive.servo().inputs().contact(5, rig.millimetres() < -30);
            return rig.axis.view().homed && rig.axis.view().state == AxisState::Standstill;
        },
        30s);
    ASSERT_TRUE(done);
    rig.run(500ms);
    EXPECT_NEAR(rig.millimetres() - rig.axis.view().actual_position, -30, 0.3) << "the switch is coordinate 0";
}

// 6.1: alarm 12 clears by 43h. The axis stops in error, resets, and is enabled again only on request.
TEST(Xp200Axis, AlarmStopsTheAxisAndResetClearsIt) {
    AxisRig rig;
    rig.go();
    ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, 50).error, ErrorId::none);
    rig.run(1s);
    rig.drive.servo().raise(12);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::ErrorStop; }, 500ms));
    EXPECT_EQ(rig.axis.view().drive_error, 12);
    rig.run(2s);
    rig.power(false);
    rig.run(100ms);
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::Disabled; }, 3s));
    EXPECT_EQ(rig.drive.servo().alarm(), 0);
    EXPECT_FALSE(rig.drive.servo().energised());
    EXPECT_EQ(rig.drive.servo().parameters()[122], 0);
    rig.power();
    EXPECT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::Standstill; }, 3s));
}

// 6.1: undervoltage (3) is one of the eleven that only a restart clears: MC_Reset ends in an error at once.
TEST(Xp200Axis, ResetOfALastingAlarmFails) {
    AxisRig rig;
    rig.go();
    rig.drive.servo().undervoltage();
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::ErrorStop; }, 500ms));
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return !rig.axis.view().resetting; }, 3s));
    EXPECT_EQ(rig.axis.view().reset_error, ErrorId::reset_failed);
}

// --- the line falls silent --------------------------------------------------------------------------------------------------------

TEST(Xp200Axis, OneLostAnswerIsNoMatter) {
    AxisRig rig;
    rig.go();
    ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, 50).error, ErrorId::none);
    rig.run(1s);
    rig.line.lose_answers(1);
    rig.run(1s);
    rig.line.damage_answers(1);
    rig.run(1s);
    EXPECT_EQ(rig.axis.view().state, AxisState::ContinuousMotion);
    EXPECT_NEAR(rig.rpm(), 300, 3);
}

// The drive knows no silence (chapter 9): the motor goes on. The axis is in ErrorStop within half a second, and supervised() says no:
// what holds the watchdog output.
TEST(Xp200Axis, SilenceIsErrorStopAndNotSupervised) {
    AxisRig rig;
    rig.go();
    ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, 50).error, ErrorId::none);
    rig.run(1s);
    ASSERT_TRUE(rig.port.supervised(rig.now));
    rig.line.cut(true);
    const auto cut = rig.now;
    ASSERT_TRUE(rig.until([&] { return !rig.port.supervised(rig.now); }, 1s));
    EXPECT_LE(rig.now - cut, 310ms);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::ErrorStop; }, 1s));
    EXPECT_LE(rig.now - cut, 500ms);
    EXPECT_NEAR(rig.rpm(), 300, 10) << "nothing in the drive stops it";

    // The line comes back: first of all the drive is stopped and disabled, and its zero is not trusted any more.
    rig.line.cut(false);
    ASSERT_TRUE(rig.until([&] { return rig.drive.servo().parameters()[122] == 0 && std::abs(rig.rpm()) < 1; }, 3s));
    EXPECT_FALSE(rig.axis.view().homed);
    EXPECT_EQ(rig.axis.view().state, AxisState::ErrorStop);
    rig.power(false);
    rig.run(2s);
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::none);
    EXPECT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::Disabled; }, 3s));
    EXPECT_TRUE(rig.port.supervised(rig.now));
}

/// Cut until the axis is in ErrorStop, with MC_Power's Enable still there, then whole again.
void fall_silent(AxisRig& rig) {
    rig.go();
    ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, 50).error, ErrorId::none);
    rig.run(1s);
    rig.line.cut(true);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::ErrorStop; }, 1s));
    rig.run(300ms);
    rig.line.cut(false);
}

// 300 r/min take 300 ms by Pr063 = 1000, and Pr166 holds the brake 500 ms more: so long after the line is back the drive still has its power.
// A reset meanwhile waits for that to end, succeeds then, and nothing follows it.
TEST(Xp200Axis, AResetAfterSilenceWaitsUntilTheDriveIsDisabled) {
    AxisRig rig{{{97, 33}, {108, 9}, {136, 1}, {164, 1}, {63, 1000}}};
    fall_silent(rig);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().online; }, 3s));
    ASSERT_TRUE(rig.drive.servo().energised()) << "else there is nothing to wait for";
    EXPECT_FALSE(rig.port.supervised(rig.now)) << "the watchdog output stays off meanwhile";
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return !rig.axis.view().resetting; }, 5s));
    EXPECT_EQ(rig.axis.view().reset_error, ErrorId::none);
    EXPECT_EQ(rig.axis.view().state, AxisState::Disabled);
    EXPECT_FALSE(rig.drive.servo().energised());
    EXPECT_EQ(rig.drive.servo().parameters()[122], 0);
    // MC_Power still asks: the axis comes back, once.
    EXPECT_FALSE(rig.until([&] { return rig.axis.view().state == AxisState::ErrorStop; }, 5s)) << rig.axis.view().error;
    EXPECT_EQ(rig.axis.view().state, AxisState::Standstill);
    EXPECT_EQ(rig.drive.servo().enabled_in_motion(), 0u);
}

// The wish for power from before the silence is still there when the line is back, and the drive, its motor at rest, would take it (Pr166 = 0:
// no brake to wait for). It does not switch the motor on again: that takes a reset.
TEST(Xp200Axis, AfterSilenceNothingIsEnabledBeforeAReset) {
    AxisRig rig{{{97, 33}, {108, 9}, {136, 1}, {164, 1}, {63, 100}, {166, 0}}};
    fall_silent(rig);
    ASSERT_TRUE(rig.until([&] { return !rig.drive.servo().energised(); }, 3s));
    EXPECT_FALSE(rig.until([&] { return rig.drive.servo().energised(); }, 5s));
    EXPECT_EQ(rig.axis.view().state, AxisState::ErrorStop);
}

// SON wired on: whether it wins over 42h is not stated (9.6.7), and in the model either enables. The reset ends, and says why.
TEST(Xp200Axis, ADriveThatKeepsItsPowerFailsTheReset) {
    AxisRig rig;
    rig.go();
    rig.drive.servo().inputs().contact(0, true);
    rig.line.cut(true);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::ErrorStop; }, 1s));
    rig.run(300ms);
    rig.line.cut(false);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().online; }, 3s));
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return !rig.axis.view().resetting; }, 10s));
    EXPECT_EQ(rig.axis.view().reset_error, ErrorId::reset_failed);
    EXPECT_EQ(rig.axis.view().state, AxisState::ErrorStop);
    EXPECT_FALSE(rig.port.supervised(rig.now));
    ASSERT_EQ(rig.port.setup_problems().size(), 1u);
    EXPECT_NE(rig.port.setup_problems()[0].find("SON"), std::string::npos);

    // Opened, the next one succeeds.
    rig.drive.servo().inputs().contact(0, false);
    rig.run(1s);
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return !rig.axis.view().resetting; }, 5s));
    EXPECT_EQ(rig.axis.view().reset_error, ErrorId::none);
}

// A drive that was told to stop comes to rest behind its set-point, and holds no place of ours. A reset that came while it still turned must not
// let the position loop pull it back to where the set-point ended: nothing moves without a command.
TEST(Xp200Axis, AResetInTheRampMovesNothing) {
    AxisRig rig;
    rig.go();
    ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, 80).error, ErrorId::none);
    rig.run(2s);
    rig.axis.stop_for_error(AlarmId{4711}, false);
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::Standstill; }, 3s)) << "it still has its power";
    EXPECT_NEAR(rig.rpm(), 0, 1);
    const double at = rig.millimetres();
    rig.run(3s);
    EXPECT_NEAR(rig.millimetres(), at, 0.06);
}

// --- settings with which it must not be enabled --------------------------------------------------------------------------------------

TEST(Xp200Axis, WrongSettingsRefuseEnabling) {
    AxisRig rig;
    rig.drive.servo().parameters().commission(4, 0);  // position mode: only a restart changes it (3.6.4)
    rig.drive.servo().parameters().commission(82, 1000);
    rig.drive.servo().power_on(rig.now);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().online; }, 5s));
    const auto problems = rig.port.setup_problems();
    ASSERT_EQ(problems.size(), 2u);
    EXPECT_NE(problems[0].find("Pr004 is 0"), std::string::npos) << problems[0];
    EXPECT_NE(problems[1].find("4000 counts a turn"), std::string::npos) << problems[1];
    rig.power();
    rig.run(3s);
    EXPECT_FALSE(rig.drive.servo().energised());
}

TEST(Xp200Axis, AWatchdogOutputNeedsItsInput) {
    AxisRig rig;
    rig.drive.servo().power_on(rig.now);
    DriveConfig config{.name = "v", .station = 1, .profile = rig.profile, .parameters = {{97, 33}, {108, 9}}, .has_watchdog_output = true};
    Xp200Drive port{config, AxisRig::fast};
    DriveLine lines{rig.line};
    lines.add(port);
    const auto open = [&](Xp200Drive& drive, DriveLine& line) {
        for (int i = 0; i < 5000 && !drive.decode(rig.now).online; ++i) line.step(rig.now += 1ms);
    };
    open(port, lines);
    ASSERT_EQ(port.setup_problems().size(), 1u);
    EXPECT_NE(port.setup_problems()[0].find("-15"), std::string::npos);
    config.parameters.push_back({105, -15});
    Xp200Drive wired{config, AxisRig::fast};
    DriveLine again{rig.line};
    again.add(wired);
    open(wired, again);
    EXPECT_TRUE(wired.setup_problems().empty());
}

// 3.4: the panel works beside the line. Somebody turns Pr025 to analog while the axis moves.
TEST(Xp200Axis, AChangeAtThePanelIsNoticed) {
    AxisRig rig;
    rig.go();
    rig.run(1s);
    (void)rig.drive.servo().parameters().write(25, 0);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::ErrorStop; }, 10s));
    ASSERT_FALSE(rig.port.setup_problems().empty());
    EXPECT_NE(rig.port.setup_problems()[0].find("Pr025"), std::string::npos);
    EXPECT_EQ(rig.axis.view().error, id(AxisAlarm::drive_setup_refused));

    // A reset reads the settings again and writes what counts at once.
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return !rig.axis.view().resetting; }, 5s));
    EXPECT_EQ(rig.axis.view().reset_error, ErrorId::none);
    EXPECT_EQ(rig.drive.servo().parameters()[25], 1);
    EXPECT_TRUE(rig.port.setup_problems().empty());
}

// --- parameters and saving -----------------------------------------------------------------------------------------------------------

TEST(Xp200Axis, ParametersAreReadAndWrittenBesideThePoll) {
    AxisRig rig;
    rig.go();
    const auto wait = [&](ServiceTicket ticket) {
        std::optional<Result<ServiceAnswer>> answer;
        (void)rig.until([&] { return (answer = rig.port.service_answer(ticket)).has_value(); }, 3s);
        return answer;
    };
    const auto write = wait(rig.port.write_parameter({5, 0}, {std::byte{80}, std::byte{0}}));
    ASSERT_TRUE(write && write->ok());
    EXPECT_EQ(rig.drive.servo().parameters()[5], 80);
    const auto read = wait(rig.port.read_parameter({66, 0}));
    ASSERT_TRUE(read && read->ok());
    EXPECT_EQ(read->value(), (ServiceAnswer{std::byte{0xD4}, std::byte{0xFE}}));  // -300 (5.1.1)
    const auto refused = wait(rig.port.write_parameter({5, 0}, {std::byte{0xFF}, std::byte{0xFF}}));
    ASSERT_TRUE(refused && !refused->ok());
    EXPECT_NE(refused->error().text().find("illegal data value"), std::string::npos);
    EXPECT_EQ(rig.port.write_parameter({122, 0}, {std::byte{1}, std::byte{0}}), 0u) << "the schedule's own";
    EXPECT_EQ(rig.port.write_parameter({13, 0}, {std::byte{1}, std::byte{0}}), 0u) << "reserved (9.4)";
    EXPECT_EQ(rig.port.start_service(DriveService::save_parameters), 0u) << "enabled";
}

// Parameters asked for one behind the other take their turns with the questions of the poll, and none of either waits for ever.
TEST(Xp200Axis, ManyParametersLeaveTheOthersTheirTurn) {
    for (auto phase = 0ms; phase < 70ms; phase += 11ms) {
        AxisRig rig;
        rig.go();
        rig.run(phase);
        std::vector<ServiceTicket> tickets;
        for (std::uint16_t i = 0; i < 12; ++i) tickets.push_back(rig.port.read_parameter({60, 0}));
        rig.run(20ms);
        rig.drive.servo().raise(12);
        EXPECT_TRUE(rig.until([&] { return rig.axis.view().drive_error == 12; }, 150ms)) << phase.count();
        rig.run(2s);
        for (const auto ticket : tickets) EXPECT_TRUE(rig.port.service_answer(ticket).has_value()) << phase.count();
    }
}

// 9.6.6: the drive is silent for 5 s; that is no loss of the line, and the axis is still there afterwards.
TEST(Xp200Axis, SavingIsNoSilence) {
    AxisRig rig;
    rig.drive.servo().power_on(rig.now);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().online; }, 5s));
    rig.run(200ms);
    const auto ticket = rig.port.start_service(DriveService::save_parameters);
    ASSERT_NE(ticket, 0u);
    ASSERT_TRUE(rig.until([&] { return rig.port.service_answer(ticket).has_value(); }, 3s));
    const auto epoch = rig.port.decode(rig.now).position_epoch;
    rig.run(4900ms);
    EXPECT_TRUE(rig.port.decode(rig.now).online);
    rig.run(1s);
    EXPECT_TRUE(rig.axis.view().online);
    EXPECT_EQ(rig.port.decode(rig.now).position_epoch, epoch);
    rig.drive.servo().power_off();
    rig.drive.servo().power_on(rig.now);
    EXPECT_EQ(rig.drive.servo().parameters()[136], 1) << "it was saved";
}

}  // namespace
}  // namespace taktwerk::axes::xp200
