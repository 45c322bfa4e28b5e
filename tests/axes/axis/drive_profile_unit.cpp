// Profiles that the drive makes (PP, PV, PT): into its mode from rest, set-points one by one and ahead, limits by what it reports, and back into
// the axis' own mode by whatever takes the axis. 1000 counts are 1 u.

#include "tests/axes/axis/axis_rig.hpp"
#include "tests/patience.hpp"

namespace taktwerk::axes::test {
namespace {

AxisCommand drive_to(double position, double velocity = 50, MC_BufferMode mode = mcAborting) {
    return {.kind = CommandKind::drive_move_absolute, .buffer_mode = mode, .position = position, .velocity = velocity};
}
AxisCommand drive_by(double distance, double velocity = 50, MC_BufferMode mode = mcAborting) {
    return {.kind = CommandKind::drive_move_relative, .buffer_mode = mode, .position = distance, .velocity = velocity};
}
AxisCommand drive_at(double velocity, MC_BufferMode mode = mcAborting) {
    return {.kind = CommandKind::drive_move_velocity, .buffer_mode = mode, .velocity = velocity};
}
AxisCommand drive_torque(double torque, double ramp = 0, double velocity = 0) {
    return {.kind = CommandKind::drive_torque, .velocity = velocity, .details = TorqueDetails{torque, ramp}};
}

struct ProfileRig : Rig {
    explicit ProfileRig(const std::function<void(FakeDrive&)>& prepare = {}, const AxisConfig& config = plain_axis())
        : Rig(config, [&](FakeDrive& made) {
              made.caps.profile_buffer = 1;
              made.caps.velocity_limit = true;
              if (prepare) prepare(made);
          }) {
        power_on();
    }
    [[nodiscard]] double at() const { return view().actual_position; }
    [[nodiscard]] double speed() const { return view().actual_velocity; }
    bool run_to_speed(double velocity, int most = 2000) {
        return run_until([&] { return std::abs(speed() - velocity) < 1e-6; }, most);
    }
    /// The largest change of the motor's velocity in a cycle, u/s.
    double largest_kick(int cycles) {
        double most = 0, before = speed();
        for (int i = 0; i < cycles; ++i) {
            step();
            most = std::max(most, std::abs(speed() - before));
            before = speed();
        }
        return most;
    }
};

// The drive's own motion begins from rest: wherever a move that turns round is when it comes, the axis stops for it and turns round no more, also
// where that takes less than a cycle: 15.3 u/s, at -1000 u/s2, become 0.3.
TEST(DriveMove, TheStopInFrontOfItNeverTurnsTheAxisRound) {
    for (int later = 60; later < 70; ++later) {
        ProfileRig rig;
        rig.accept(at_velocity(40.3));
        rig.run(150);
        rig.accept(absolute(-20));
        rig.run(later);
        const double before = rig.view().set_velocity;
        rig.accept(drive_at(-20));
        for (int i = 0; i < 200 && rig.view().set_velocity != 0; ++i) {
            rig.step();
            EXPECT_GE(before * rig.view().set_velocity, 0) << later;
        }
        EXPECT_EQ(rig.view().set_velocity, 0) << later;
        EXPECT_TRUE(rig.run_to_speed(-20)) << later;
    }
}

// The motor is 30 counts behind what it is told: until the drive has the mode, it is told the same.
TEST(DriveMove, ADriveThatHasNotTheModeYetIsToldTheSamePlace) {
    ProfileRig rig([](FakeDrive& made) { made.mode_delay = 5; });
    rig.drive.lag = 30;
    rig.accept(absolute(5));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.run(20);
    ASSERT_DOUBLE_EQ(rig.at(), 4.97);
    rig.accept(drive_at(20));
    int cycles = 0;
    for (rig.step(); rig.view().drive_mode == DriveMode::cyclic_position && cycles < 50; rig.step(), ++cycles)
        EXPECT_EQ(rig.view().set_position, 5) << cycles;
    EXPECT_GE(cycles, 4);
    ASSERT_TRUE(rig.run_to_speed(20));
    EXPECT_TRUE(rig.alarms.empty());
}

// CiA 402-2 PP: mode 1, target, speed and ramps, then the handshake; Done is the drive's "target reached", and the axis has its own mode again.
TEST(DriveMove, EndsAtItsTargetByTheDrivesWord) {
    auto config = plain_axis();
    config.limits.position_min = -100;
    config.limits.position_max = 100;
    ProfileRig rig({}, config);
    auto command = drive_to(20);
    command.acceleration = 300;
    command.deceleration = 200;
    const auto id = rig.accept(command);
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);
    ASSERT_TRUE(rig.run_until([&] { return rig.speed() != 0; }, 50));
    ASSERT_EQ(rig.drive.profile.taken.size(), 1u);
    const auto& given = rig.drive.profile.taken[0];
    EXPECT_EQ(given.mode, DriveMode::profile_position);
    EXPECT_EQ(given.position, 20000);
    EXPECT_EQ(given.velocity, 50000);
    EXPECT_EQ(given.acceleration, 300000);
    EXPECT_EQ(given.deceleration, 200000);
    EXPECT_FALSE(given.profile.relative);
    EXPECT_FALSE(given.profile.immediately);
    rig.run(100);
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    EXPECT_NEAR(rig.view().set_velocity, 50, 1e-6) << "the set-point follows the motor";
    EXPECT_EQ(rig.view().target_position, 20);
    EXPECT_EQ(rig.view().following_error, 0);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 1000));
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_EQ(rig.at(), 20);
    rig.run(20);
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_position);
    EXPECT_EQ(rig.drive.last.profile.sequence, 0u);
    EXPECT_TRUE(rig.alarms.empty());
}

// From standstill every drive means the same by a distance (bit 6). An inverted gearing turns it round.
TEST(DriveMove, ARelativeMoveFromStandstillIsADistance) {
    auto config = plain_axis();
    config.gearing.inverted = true;
    ProfileRig rig({}, config);
    rig.accept(drive_by(3));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 1000));
    ASSERT_EQ(rig.drive.profile.taken.size(), 1u);
    EXPECT_TRUE(rig.drive.profile.taken[0].profile.relative);
    EXPECT_EQ(rig.drive.profile.taken[0].position, -3000);
    EXPECT_EQ(rig.at(), 3);
}

// An endless axis' absolute target may lie beyond where the drive's position wraps: it goes as a distance, too.
TEST(DriveMove, OnAnEndlessAxisATargetIsADistance) {
    auto config = plain_axis();
    config.modulo = 360;
    config.gearing.feed = 360;
    config.gearing.counts_per_revolution = 360000;
    ProfileRig rig({}, config);
    rig.accept({.kind = CommandKind::drive_move_absolute, .direction = mcShortestWay, .position = 350, .velocity = 100});
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 1000));
    ASSERT_EQ(rig.drive.profile.taken.size(), 1u);
    EXPECT_TRUE(rig.drive.profile.taken[0].profile.relative);
    EXPECT_EQ(rig.drive.profile.taken[0].position, -10000);
    EXPECT_NEAR(rig.at(), 350, 1e-9);
}

// Velocity above the limit is clamped and the view says so, as for other commands.
TEST(DriveMove, VelocityIsClampedToTheLimit) {
    ProfileRig rig;
    rig.accept(drive_to(50, 400));
    ASSERT_TRUE(rig.run_to_speed(100));
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::axis_limit);
}

// A moving axis stops along the command's ramp in its own mode first; the drive is asked at standstill.
TEST(DriveMove, FromAMotionOfTheAxisItBeginsAtStandstill) {
    ProfileRig rig([](FakeDrive& drive) { drive.dead_cycles = 10; });  // the motor stands that much later than its set-point
    rig.accept(at_velocity(50));
    rig.run(300);
    const auto id = rig.accept(drive_to(0, 50));
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    bool asked = false;
    for (Patience patience; patience.lasts(!asked);) {
        rig.step();
        asked = rig.drive.last.mode == DriveMode::profile_position;
        if (asked) {
            EXPECT_LE(std::abs(rig.speed()), 0.1) << "windows.standstill_velocity";
        }
    }
    rig.expect_no_jump();
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 2000));
    EXPECT_EQ(rig.at(), 0);
    EXPECT_EQ(rig.status(id), CommandStatus::done);
}

// mcAborting on a drive that replaces (CiA 402-2 bit 5): the new set-point takes over in the drive, absolute.
TEST(DriveMove, AnotherOneTakesOverAtOnce) {
    ProfileRig rig;
    const auto first = rig.accept(drive_to(50));
    ASSERT_TRUE(rig.run_to_speed(50));
    rig.run(100);
    const auto second = rig.accept(drive_by(-1, 30));
    EXPECT_EQ(rig.status(first), CommandStatus::aborted);
    rig.run(20);
    ASSERT_EQ(rig.drive.profile.taken.size(), 2u);
    EXPECT_TRUE(rig.drive.profile.taken[1].profile.immediately);
    EXPECT_FALSE(rig.drive.profile.taken[1].profile.relative) << "from a moving axis drives differ (SV-DA200 3.2.7 does not say)";
    EXPECT_EQ(rig.view().drive_mode, DriveMode::profile_position);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 3000));
    EXPECT_EQ(rig.status(second), CommandStatus::done);
}

// SE-808X 3.2.4: bit 5 goes on behind the running one. There the drive is brought to rest in the axis' mode and begins anew.
TEST(DriveMove, WhereTheDriveCannotReplaceItStopsFirst) {
    ProfileRig rig([](FakeDrive& drive) { drive.caps.profile_replaces = false; });
    rig.accept(drive_to(50));
    ASSERT_TRUE(rig.run_to_speed(50));
    const auto second = rig.accept(drive_to(2, 30));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 5000));
    EXPECT_EQ(rig.status(second), CommandStatus::done);
    EXPECT_EQ(rig.at(), 2);
    ASSERT_EQ(rig.drive.profile.taken.size(), 2u);
    EXPECT_FALSE(rig.drive.profile.taken[1].profile.immediately);
    EXPECT_TRUE(rig.alarms.empty());
}

// With a buffer of one the second set-point is in the drive before the first is over; a third waits here until there is room.
TEST(DriveMove, BufferedSetPointsAreHandedAhead) {
    ProfileRig rig;
    const auto first = rig.accept(drive_to(10));
    const auto second = rig.accept(drive_by(5, 50, mcBuffered));
    const auto third = rig.accept(drive_to(0, 50, mcBuffered));
    ASSERT_TRUE(rig.run_to_speed(50));
    rig.run(30);
    ASSERT_EQ(rig.drive.profile.taken.size(), 2u);
    EXPECT_EQ(rig.drive.profile.taken[1].position, 15000) << "from the target before it";
    EXPECT_FALSE(rig.drive.profile.taken[1].profile.immediately);
    EXPECT_EQ(rig.status(first), CommandStatus::active);
    EXPECT_EQ(rig.status(second), CommandStatus::queued);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(first) == CommandStatus::done; }, 400));
    EXPECT_NEAR(rig.at(), 10, 0.11);
    EXPECT_EQ(rig.status(second), CommandStatus::active);
    rig.run(20);
    EXPECT_EQ(rig.drive.profile.taken.size(), 3u);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 2000));
    EXPECT_EQ(rig.status(second), CommandStatus::done);
    EXPECT_EQ(rig.status(third), CommandStatus::done);
    EXPECT_EQ(rig.at(), 0);
    EXPECT_EQ(rig.drive.profile.taken.size(), 3u);
}

// SV-DA200 3.2.7: eight levels. All that wait are in the drive.
TEST(DriveMove, AsManyAheadAsTheDriveTakes) {
    ProfileRig rig([](FakeDrive& drive) { drive.caps.profile_buffer = 8; });
    CommandId last = 0;
    for (int i = 1; i <= 5; ++i) last = rig.accept(drive_to(2 * i, 50, mcBuffered));
    ASSERT_TRUE(rig.run_to_speed(50));
    rig.run(20);
    EXPECT_EQ(rig.drive.profile.taken.size(), 5u);
    EXPECT_EQ(rig.status(last), CommandStatus::queued);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 2000));
    EXPECT_EQ(rig.status(last), CommandStatus::done);
    EXPECT_EQ(rig.at(), 10);
}

// Only moves are handed ahead: what else waits begins in the axis' own mode, and a move behind the axis' own one in the drive's.
TEST(DriveMove, OwnAndDrivesMovesFollowEachOther) {
    ProfileRig rig;
    const auto first = rig.accept(absolute(5));
    const auto second = rig.accept(drive_to(10, 50, mcBuffered));
    const auto third = rig.accept(absolute(3, 100, mcBuffered));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(second) == CommandStatus::active; }, 1000));
    EXPECT_EQ(rig.status(first), CommandStatus::done);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(third) == CommandStatus::active; }, 1000));
    EXPECT_NEAR(rig.at(), 10, 1e-9);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 1000));
    EXPECT_EQ(rig.at(), 3);
    EXPECT_TRUE(rig.alarms.empty());
    EXPECT_LE(rig.drive.largest_step, 101) << "counts a cycle at 100 u/s";
}

// --- refusals -------------------------------------------------------------------------------------------------------------------

// Virtual axes and slow lines have no such modes: said at once, even without power.
TEST(DriveProfile, WithoutTheModeItIsNotSupported) {
    const auto without = [](DriveMode mode) {
        return [mode](FakeDrive& drive) {
            drive.caps.modes = static_cast<std::uint16_t>(drive.caps.modes & ~(1u << static_cast<unsigned>(mode)));
        };
    };
    EXPECT_EQ(ProfileRig(without(DriveMode::profile_position)).refuse(drive_to(1)), ErrorId::not_supported);
    EXPECT_EQ(ProfileRig(without(DriveMode::profile_position)).refuse(drive_by(1)), ErrorId::not_supported);
    EXPECT_EQ(ProfileRig(without(DriveMode::profile_velocity)).refuse(drive_at(1)), ErrorId::not_supported);
    EXPECT_EQ(ProfileRig(without(DriveMode::profile_torque)).refuse(drive_torque(0.1)), ErrorId::not_supported);
    EXPECT_EQ(ProfileRig([](FakeDrive& drive) { drive.caps.profile_buffer = 0; }).refuse(drive_to(1)), ErrorId::not_supported);
    EXPECT_EQ(ProfileRig([](FakeDrive& drive) { drive.caps.velocity_limit = false; }).refuse(drive_torque(0.1)), ErrorId::not_supported);
    Rig slow(plain_axis(), [](FakeDrive& drive) { drive.caps.setpoints = SetpointClass::low_dynamics; });
    EXPECT_EQ(slow.refuse(drive_at(1)), ErrorId::not_supported);
}

TEST(DriveProfile, BadNumbersAndBlendingAreRefused) {
    ProfileRig rig;
    EXPECT_EQ(rig.refuse(drive_to(1, 0)), ErrorId::invalid_velocity);
    EXPECT_EQ(rig.refuse(drive_to(std::nan(""))), ErrorId::invalid_position);
    EXPECT_EQ(rig.refuse(drive_at(HUGE_VAL)), ErrorId::invalid_velocity);
    EXPECT_EQ(rig.refuse(drive_torque(0.1, -1)), ErrorId::invalid_parameter);
    for (const auto mode : {mcBlendingLow, mcBlendingPrevious, mcBlendingNext, mcBlendingHigh}) {
        EXPECT_EQ(rig.refuse(drive_to(1, 50, mode)), ErrorId::buffer_mode_not_supported);
        EXPECT_EQ(rig.refuse(drive_at(1, mode)), ErrorId::buffer_mode_not_supported);
    }
}

TEST(DriveProfile, TargetsBeyondTheSoftwareLimitsAreRefused) {
    auto config = plain_axis();
    config.limits.position_min = -10;
    config.limits.position_max = 10;
    config.homing.kind = HomingKind::set_here;
    ProfileRig rig({}, config);
    rig.accept(home(0));
    rig.run(5);
    EXPECT_EQ(rig.refuse(drive_to(11)), ErrorId::beyond_software_limit);
    EXPECT_EQ(rig.refuse(drive_by(-11)), ErrorId::beyond_software_limit);
    // Behind another it is found where it begins; the one before ends well.
    const auto first = rig.accept(drive_to(8));
    const auto second = rig.accept(drive_by(5, 50, mcBuffered));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 2000));
    EXPECT_EQ(rig.status(first), CommandStatus::done);
    EXPECT_EQ(rig.error_of(second), ErrorId::beyond_software_limit);
    EXPECT_EQ(rig.drive.profile.taken.size(), 1u);
}

TEST(DriveProfile, ADirectionThatIsNotPermittedIsRefused) {
    ProfileRig rig;
    rig.program = [&] { (void)rig.axis.power(true, false, true, Owner::program); };
    rig.run(3);
    rig.enable = true;
    rig.drive.switches = true;
    rig.drive.positive_end = 0;
    rig.run(3);
    EXPECT_EQ(rig.refuse(drive_to(5)), ErrorId::interlocked);
    EXPECT_EQ(rig.refuse(drive_at(5)), ErrorId::interlocked);
    EXPECT_EQ(rig.refuse(drive_torque(0.1)), ErrorId::interlocked);
    rig.accept(drive_to(-1));
}

// TSVM 5.4.1: the mode is changed at standstill only.
TEST(DriveProfile, ADriveThatChangesItsModeAtStandstillIsNotAskedInMotion) {
    ProfileRig rig([](FakeDrive& drive) { drive.caps.mode_change_at_standstill = true; });
    rig.accept(at_velocity(20));
    rig.run(100);
    EXPECT_EQ(rig.refuse(drive_at(30)), ErrorId::not_at_standstill);
    EXPECT_EQ(rig.refuse(drive_to(30)), ErrorId::not_at_standstill);
}

TEST(DriveProfile, AModeThatIsNotTakenEndsTheCommand) {
    ProfileRig rig([](FakeDrive& drive) { drive.refuses_profile_modes = true; });
    const auto id = rig.accept(drive_to(5));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::error; }, 700));
    EXPECT_EQ(rig.error_of(id), ErrorId::drive_mode_refused);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 100));
    EXPECT_TRUE(rig.alarms.empty());
    rig.accept(absolute(1));
    ASSERT_TRUE(rig.run_until([&] { return rig.at() == 1; }, 1000));
}

// A drive that never acknowledges: after 2 s (DriveProfileRun::patience) the command ends with its own error; the set-point is withdrawn.
TEST(DriveProfile, ASetPointThatIsNeverTakenWasRefused) {
    ProfileRig rig([](FakeDrive& drive) { drive.profile.takes_setpoints = false; });
    const auto id = rig.accept(drive_to(5));
    rig.run(1990);
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    rig.run(40);
    EXPECT_EQ(rig.error_of(id), ErrorId::drive_setpoint_refused);
    EXPECT_EQ(rig.drive.last.profile.sequence, 0u);
    rig.drive.profile.takes_setpoints = true;
    rig.run(50);
    EXPECT_EQ(rig.at(), 0);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    rig.accept(drive_to(5));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 1000));
    EXPECT_EQ(rig.at(), 5);
}

// One that is refused ahead of its time gets another chance when its turn comes; what runs is not disturbed.
TEST(DriveProfile, ARefusedSetPointAheadIsTriedAgainAtItsTurn) {
    ProfileRig rig;
    const auto first = rig.accept(drive_to(50, 10));
    ASSERT_TRUE(rig.run_to_speed(10));
    rig.drive.profile.takes_setpoints = false;
    const auto second = rig.accept(drive_to(52, 10, mcBuffered));
    rig.run(2100);
    EXPECT_EQ(rig.status(first), CommandStatus::active);
    EXPECT_EQ(rig.drive.last.profile.sequence, 0u) << "withdrawn";
    rig.drive.profile.takes_setpoints = true;
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 5000));
    EXPECT_EQ(rig.status(first), CommandStatus::done);
    EXPECT_EQ(rig.status(second), CommandStatus::done);
    EXPECT_EQ(rig.at(), 52);
}

// --- velocity and torque ----------------------------------------------------------------------------------------------------------

// A drive that changes its mode at standstill only takes no torque over a move that was just handed to it, whether the motor turns already or not:
// else the axis would wait for a standstill, on and on at the velocity at which it left the move.
TEST(DriveProfile, NoTorqueOverAMoveThatIsInTheDrivesHands) {
    int refused = 0, taken = 0;
    for (int later = 0; later < 40; ++later) {
        auto config = plain_axis();
        config.control.rated_acceleration = 2000;
        ProfileRig rig([](FakeDrive& drive) { drive.caps.mode_change_at_standstill = true, drive.mode_delay = 20; }, config);
        const auto move = rig.accept(drive_to(20, 30));
        rig.run(later);
        const auto answer =
            rig.axis.submit({.kind = CommandKind::torque, .velocity = 40, .details = TorqueDetails{0.1, 0}}, Owner::program);
        if (answer.error == ErrorId::none) {
            ++taken;
            bool moved = false;
            ASSERT_TRUE(rig.run_until(
                [&] {
                    moved = moved || rig.speed() != 0;
                    return rig.view().drive_mode == DriveMode::cyclic_torque;
                },
                1500))
                << later;
            EXPECT_FALSE(moved) << "the move began all the same, " << later << " cycles after it was asked for";
            continue;
        }
        ++refused;
        EXPECT_EQ(answer.error, ErrorId::not_at_standstill) << later;
        ASSERT_TRUE(rig.run_to(AxisState::Standstill, 5000)) << later;
        EXPECT_EQ(rig.status(move), CommandStatus::done) << later;
        EXPECT_EQ(rig.at(), 20) << later;
    }
    EXPECT_GT(refused, 10);
    EXPECT_GT(taken, 10) << "before the drive has anything";
}

// PV: the drive ramps; InVelocity is its "target reached", and not that of the velocity before.
TEST(DriveVelocity, InVelocityIsTheDrivesWord) {
    ProfileRig rig;
    const auto id = rig.accept(drive_at(-40));
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::in_target; }, 200));
    EXPECT_NEAR(rig.speed(), -40, 1e-6);
    EXPECT_EQ(rig.view().drive_mode, DriveMode::profile_velocity);
    const auto faster = rig.accept(drive_at(-60));
    for (Patience patience; patience.lasts(rig.status(faster) != CommandStatus::in_target);) {
        rig.step();
        ASSERT_EQ(rig.view().drive_mode, DriveMode::profile_velocity) << "changed in the drive";
        if (rig.status(faster) == CommandStatus::in_target) {
            EXPECT_NEAR(rig.speed(), -60, 1e-6);
        }
    }
    // What waits begins once the velocity was there; the drive's velocity counts as aborted by it.
    const auto move = rig.accept(absolute(0, 100, mcBuffered));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 3000));
    EXPECT_EQ(rig.status(faster), CommandStatus::aborted);
    EXPECT_EQ(rig.status(move), CommandStatus::done);
    EXPECT_EQ(rig.at(), 0);
}

// MC_MoveAbsolute in the middle: the axis goes on from where the motor is and as fast as it is. 1000 u/s2 are 1 u/s in a cycle, the rest is what a
// count more or less makes of a velocity.
TEST(DriveVelocity, AMoveTakesOverWithoutAJump) {
    ProfileRig rig;
    const auto id = rig.accept(drive_at(40));
    ASSERT_TRUE(rig.run_to_speed(40));
    const auto move = rig.accept(absolute(60, 50));
    EXPECT_EQ(rig.status(id), CommandStatus::aborted);
    EXPECT_LE(rig.largest_kick(60), 1.0 + 2.1);
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_position);
    EXPECT_GT(rig.speed(), 38);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(move), CommandStatus::done);
    EXPECT_EQ(rig.at(), 60);
    EXPECT_TRUE(rig.alarms.empty());
}

// PT: torque, slope and speed limit are the drive's. Rated torque gives 2000 u/s2; friction holds the motor.
TEST(DriveTorque, InTorqueIsTheDrivesWord) {
    ProfileRig rig([](FakeDrive& drive) { drive.friction = 0.5; });
    const auto id = rig.accept(drive_torque(0.25, 0.5, 30));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::in_target; }, 200));
    ASSERT_EQ(rig.drive.profile.taken.size(), 1u);
    const auto& given = rig.drive.profile.taken[0];
    EXPECT_EQ(given.mode, DriveMode::profile_torque);
    EXPECT_EQ(given.torque, 0.25);
    EXPECT_EQ(given.torque_slope, 0.5);
    EXPECT_EQ(given.velocity_limit, 30000);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    const auto stopping = rig.accept(stop());
    ASSERT_TRUE(rig.run_until([&] { return rig.status(stopping) == CommandStatus::done; }, 500));
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_position);
    EXPECT_EQ(rig.status(id), CommandStatus::aborted);
}

// MC_TorqueControl out of PV goes through the axis' own mode, with the set-point at the motor all the way.
TEST(DriveTorque, TheAxisOwnTorqueTakesOverFromAVelocityOfTheDrive) {
    auto config = plain_axis();
    config.control.rated_acceleration = 2000;
    ProfileRig rig([](FakeDrive& drive) { drive.mode_delay = 20; }, config);
    rig.accept(drive_at(40));
    ASSERT_TRUE(rig.run_to_speed(40));
    AxisCommand push{.kind = CommandKind::torque, .velocity = 40, .details = TorqueDetails{0.2, 0}};
    rig.accept(push);
    bool own_mode = false;
    for (int i = 0; i < 100; ++i) {
        rig.step();
        own_mode = own_mode || rig.view().drive_mode == DriveMode::cyclic_position;
        ASSERT_NEAR(rig.view().set_position, rig.at(), 0.3) << i;
    }
    EXPECT_TRUE(own_mode);
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_torque);
    EXPECT_NEAR(rig.speed(), 40, 0.5);
    EXPECT_TRUE(rig.alarms.empty());
}

// --- what ends it -----------------------------------------------------------------------------------------------------------------

// MC_Stop and MC_Halt brake with their own Deceleration once the drive is back in the axis' mode: 50 u/s by 250 u/s2 take 0.2 s.
TEST(DriveProfileEnd, StopAndHaltBrakeWithTheirOwnDeceleration) {
    for (auto command : {stop(), halt()}) {
        ProfileRig rig;
        const auto id = rig.accept(drive_to(90));
        ASSERT_TRUE(rig.run_to_speed(50));
        command.deceleration = 250;
        command.jerk = 1e5;
        const auto ending = rig.accept(command);
        int cycles = 0;
        while (rig.status(ending) != CommandStatus::done && cycles < 1000) {
            rig.step();
            ++cycles;
        }
        EXPECT_EQ(rig.status(id), CommandStatus::aborted);
        EXPECT_NEAR(cycles, 200, 20) << "and a few cycles for the change of mode";
        EXPECT_FALSE(rig.drive.last.halt);
        EXPECT_LT(rig.at(), 90);
        EXPECT_TRUE(rig.alarms.empty());
    }
}

// At drives that change their mode at standstill: a halt in the drive's mode first, by the command's Deceleration (6084h), then the mode.
TEST(DriveProfileEnd, AHaltInTheDrivesModeWhereTheModeChangesAtStandstill) {
    ProfileRig rig([](FakeDrive& drive) { drive.caps.mode_change_at_standstill = true; });
    rig.accept(drive_at(50));
    ASSERT_TRUE(rig.run_to_speed(50));
    auto move = absolute(0);
    move.deceleration = 500;  // 50 u/s in 0.1 s
    const auto id = rig.accept(move);
    rig.step();
    EXPECT_TRUE(rig.drive.last.halt);
    EXPECT_EQ(rig.drive.last.deceleration, 500000);
    for (int i = 0; i < 90; ++i) {
        rig.step();
        ASSERT_EQ(rig.drive.last.mode, DriveMode::profile_velocity);
    }
    ASSERT_TRUE(rig.run_until([&] { return rig.view().drive_mode == DriveMode::cyclic_position; }, 50));
    EXPECT_EQ(rig.speed(), 0);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_EQ(rig.at(), 0);
    EXPECT_FALSE(rig.drive.last.halt);
}

// SV33-E 3.4.3 (7): out of PV the drive stops along its ramp first. Here 50 u/s by 100 u/s2 take half a second; the axis waits, following it.
TEST(DriveProfileEnd, ADriveThatRampsDownBeforeItChangesIsWaitedFor) {
    ProfileRig rig([](FakeDrive& drive) { drive.profile.ramps_first = true; });
    auto slow = drive_at(50);
    slow.deceleration = 50;
    rig.accept(slow);
    ASSERT_TRUE(rig.run_to_speed(50));
    const auto stopping = rig.accept(stop());
    ASSERT_TRUE(rig.run_until([&] { return rig.status(stopping) == CommandStatus::done; }, 1500));
    EXPECT_TRUE(rig.alarms.empty());
    EXPECT_EQ(rig.view().state, AxisState::Stopping);
    rig.expect_no_jump();
}

// A drive that keeps its mode and runs on is halted, and in the end an error whose reaction is power off.
TEST(DriveProfileEnd, ADriveThatDoesNotComeBackIsAnError) {
    ProfileRig rig;
    rig.accept(drive_at(50));
    ASSERT_TRUE(rig.run_to_speed(50));
    rig.drive.profile.stuck = true;
    rig.accept(stop());
    rig.run(60);
    EXPECT_TRUE(rig.drive.last.halt);
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 3000));
    EXPECT_TRUE(rig.raised(AxisAlarm::drive_mode_mismatch));
    ASSERT_TRUE(rig.run_until([&] { return rig.drive.power == PowerState::disabled; }, 100));
}

// A mode that changes by itself while the drive makes the profile is the same error.
TEST(DriveProfileEnd, AModeThatChangesByItselfIsNoticed) {
    ProfileRig rig;
    rig.accept(drive_at(50));
    ASSERT_TRUE(rig.run_to_speed(50));
    rig.drive.forced_mode = DriveMode::profile_torque;
    rig.run(3);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_TRUE(rig.raised(AxisAlarm::drive_mode_mismatch));
}

TEST(DriveProfileEnd, ADriveFaultEndsItAndAResetBeginsInTheOwnMode) {
    ProfileRig rig;
    const auto id = rig.accept(drive_to(90));
    ASSERT_TRUE(rig.run_to_speed(50));
    rig.drive.fault_code = 0x2310;
    rig.run(5);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_EQ(rig.status(id), CommandStatus::error);
    rig.drive.fault_code = 0;
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 1000));
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_position);
    const double at = rig.at();
    rig.run(200);
    EXPECT_EQ(rig.at(), at) << "the old set-point is forgotten";
}

TEST(DriveProfileEnd, PowerOffStopsFirst) {
    ProfileRig rig;
    rig.accept(drive_at(50));
    ASSERT_TRUE(rig.run_to_speed(50));
    rig.enable = false;
    EXPECT_LE(rig.largest_kick(60), 1.0 + 2.1);
    ASSERT_TRUE(rig.run_to(AxisState::Disabled, 500));
    EXPECT_TRUE(rig.alarms.empty());
    rig.power_on();
    EXPECT_EQ(rig.view().drive_mode, DriveMode::cyclic_position);
}

TEST(DriveProfileEnd, TheEmergencyStopBrakesWithTheStopDeceleration) {
    ProfileRig rig;
    rig.accept(drive_at(50));
    ASSERT_TRUE(rig.run_to_speed(50));
    const double from = rig.at();
    rig.axis.demand_emergency_stop(EmergencyStop::stop);
    ASSERT_TRUE(rig.run_until([&] { return rig.speed() == 0; }, 200));
    // v^2 / 2a = 1.25 u, with the jerk's share v * a / 2j = 1.25, and some cycles of 0.05 u until the mode has changed
    EXPECT_NEAR(rig.at() - from, 2.5, 0.5);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
}

// --- limits, by what the drive reports --------------------------------------------------------------------------------------------

TEST(DriveProfileLimits, ALimitSwitchStopsTheAxis) {
    ProfileRig rig([](FakeDrive& drive) {
        drive.switches = true;
        drive.positive_end = 8000;
    });
    const auto id = rig.accept(drive_to(90));
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 1000));
    EXPECT_TRUE(rig.raised(AxisAlarm::positive_limit_switch));
    EXPECT_EQ(rig.status(id), CommandStatus::error);
    ASSERT_TRUE(rig.run_until([&] { return rig.speed() == 0; }, 300));
    EXPECT_LT(rig.at(), 12);
}

// PV has no target: it ends so that the axis stands inside, although the change of mode takes its time.
TEST(DriveProfileLimits, AVelocityEndsInsideTheSoftwareLimits) {
    auto config = plain_axis();
    config.limits.position_min = -20;
    config.limits.position_max = 20;
    config.homing.kind = HomingKind::set_here;
    ProfileRig rig({}, config);
    rig.accept(home(0));
    rig.run(5);
    const auto id = rig.accept(drive_at(80));
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 2000));
    EXPECT_TRUE(rig.raised(AxisAlarm::software_limit_reached));
    EXPECT_EQ(rig.status(id), CommandStatus::error);
    ASSERT_TRUE(rig.run_until([&] { return rig.speed() == 0; }, 300));
    EXPECT_LE(rig.at(), 20);
    EXPECT_GT(rig.at(), 15);
}

// The drive's ramp goes on until the axis has its own mode again, and counts.
TEST(DriveProfileLimits, AVelocityThatStillRisesEndsInsideTheSoftwareLimits) {
    for (const double limit : {2.0, 4.0}) {
        auto config = plain_axis();
        config.limits.position_max = limit;
        config.homing.kind = HomingKind::set_here;
        ProfileRig rig({}, config);
        rig.accept(home(0));
        rig.run(5);
        rig.accept(drive_at(100));
        ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 2000));
        ASSERT_TRUE(rig.run_until([&] { return rig.speed() == 0; }, 300));
        EXPECT_LE(rig.at(), limit);
        EXPECT_GT(rig.at(), limit - 1);
    }
}

// What the axis knows of a move of the drive is its target: a limit is not moved in between (docs/motion/decisions.md, written parameters).
TEST(DriveProfileLimits, ALimitIsNotMovedIntoTheWayOfAMove) {
    auto config = plain_axis();
    config.limits.position_min = -100;
    config.limits.position_max = 100;
    config.homing.kind = HomingKind::set_here;
    ProfileRig rig([](FakeDrive& drive) { drive.caps.profile_buffer = 2; }, config);
    rig.accept(home(0));
    rig.run(5);
    rig.accept(drive_to(40));
    const auto last = rig.accept(drive_to(60, 50, mcBuffered));
    ASSERT_TRUE(rig.run_to_speed(50));
    const auto limit = [&](double value) { return rig.axis.set(WriteParameter{software_limit_positive, value}, Owner::program); };
    EXPECT_EQ(limit(30), ErrorId::beyond_software_limit);
    EXPECT_EQ(limit(50), ErrorId::beyond_software_limit) << "the one that the drive has ahead";
    EXPECT_EQ(limit(60), ErrorId::none);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(last) == CommandStatus::done; }, 5000));
    EXPECT_EQ(rig.at(), 60);
    EXPECT_EQ(limit(60), ErrorId::none);
}

// A move to the very limit is allowed, however hard the drive brakes there.
TEST(DriveProfileLimits, AMoveMayEndOnTheSoftwareLimit) {
    auto config = plain_axis();
    config.limits.position_min = -20;
    config.limits.position_max = 20;
    config.homing.kind = HomingKind::set_here;
    ProfileRig rig({}, config);
    rig.accept(home(0));
    rig.run(5);
    const auto id = rig.accept(drive_to(20, 100));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 2000));
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_EQ(rig.at(), 20);
}

// 1.2 times the axis' limit is more than a loop overshoots: the drive does not keep the speed it was given.
TEST(DriveProfileLimits, ADriveThatRunsTooFastIsStopped) {
    ProfileRig rig([](FakeDrive& drive) { drive.profile.overshoot = 1.3; });
    rig.accept(drive_at(90));
    rig.run(100);
    EXPECT_TRUE(rig.alarms.empty());
    ASSERT_TRUE(rig.run_until([&] { return rig.speed() > 116; }, 500)) << rig.speed();
    EXPECT_TRUE(rig.alarms.empty()) << "117 of 120";
    rig.accept(drive_at(100));
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 500));
    EXPECT_TRUE(rig.raised(AxisAlarm::drive_too_fast));
}

// A load that pulls makes the motor faster than its limit while the drive should halt, or leaves its mode: that is said, and no motion begins.
TEST(DriveProfileLimits, ADriveThatRunsAwayOnItsWayOutIsStopped) {
    for (const bool halts : {true, false}) {
        ProfileRig rig([&](FakeDrive& drive) {
            drive.caps.mode_change_at_standstill = halts;
            drive.profile.stuck = true;  // knows no halt
            drive.load = -0.1;
        });
        rig.accept(drive_torque(0.1));
        ASSERT_TRUE(rig.run_until([&] { return rig.speed() > 50; }, 3000)) << halts;
        EXPECT_TRUE(rig.alarms.empty());
        rig.drive.mode_delay = 10'000;
        rig.accept(at_velocity(20));
        for (int i = 0; rig.speed() < 119 && i < 1000; ++i) rig.step();
        EXPECT_FALSE(rig.raised(AxisAlarm::drive_too_fast)) << halts << " at " << rig.speed();
        EXPECT_EQ(rig.drive.last.torque, 0) << halts;
        ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 100)) << halts << " at " << rig.speed();
        EXPECT_TRUE(rig.raised(AxisAlarm::drive_too_fast)) << halts;
    }
}

}  // namespace
}  // namespace taktwerk::axes::test
