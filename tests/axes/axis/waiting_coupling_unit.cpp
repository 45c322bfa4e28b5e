// Between the command that couples and the begin of the coupling, and after its end: the axis goes on as it moved, and what waits gets its turn.

#include "tests/axes/axis/coupling_rig.hpp"
#include "tests/patience.hpp"

namespace taktwerk::axes::test {
namespace {

AxisCommand cam_from(CamId table, double distance, double sync) {
    auto command = cam_in(0, table);
    auto& cam = std::get<CamDetails>(command.details);
    cam.master_start_distance = distance;
    cam.master_sync_position = sync;
    return command;
}

AxisCommand buffered(AxisCommand command) {
    command.buffer_mode = mcBuffered;
    return command;
}

CamId select(CouplingRig& rig, std::size_t axis, CamRef table, bool periodic, bool absolute = true) {
    EXPECT_EQ(rig.axes[axis].set(SelectCam{table, periodic, absolute, absolute}, Owner::program), ErrorId::none);
    return rig.view(axis).selected_cam;
}

const std::vector<CamPoint> hump{{.master = 0, .slave = 0}, {.master = 10, .slave = 4}, {.master = 20, .slave = 0}};

// Until the master comes, the slave goes on at its velocity; the addition has been given up in motion, or is long over. 80 u/s leave 20 for it.
// P1-281, P1-151
TEST(WaitingCoupling, TheMotionBeforeGoesOnWhateverWasSuperimposed) {
    for (const int later : {30, 2000})
        for (const bool cam : {false, true}) {
            CouplingRig rig(2);
            const auto table = rig.tables.add_cam(hump);
            rig.start();
            const auto selected = select(rig, 1, table, true);
            rig.accept(1, at_velocity(50));
            rig.run(200);
            const auto addition = rig.accept(1, on_top(5, 30));
            rig.run(later);
            EXPECT_EQ(rig.status(1, addition), later < 100 ? CommandStatus::active : CommandStatus::done);
            rig.accept(1, cam ? cam_from(selected, 5, 15) : gear_in_pos(0, 100, 0, 30));
            EXPECT_EQ(rig.status(1, addition), later < 100 ? CommandStatus::aborted : CommandStatus::done);
            rig.run(100);
            double counts = static_cast<double>(rig.axes[1].drive_command().position);
            for (int i = 0; i < 300; ++i) {
                rig.step();
                ASSERT_NEAR(rig.view(1).set_velocity, 50, 1e-9) << i;
                const double told = static_cast<double>(rig.axes[1].drive_command().position);
                ASSERT_NEAR(told - counts, 50, 1.01) << i;  // 1000 counts per u, 1 ms
                counts = told;
            }
            ASSERT_EQ(rig.view(1).state, AxisState::SynchronizedMotion);
            rig.accept(1, stop());
            ASSERT_TRUE(rig.run_until([&] { return rig.view(1).set_velocity == 0; }, 1000));
            rig.run(5);
            rig.expect_no_jump();
        }
}

// The same with a cam as the motion before: the slave stays beside it by what was superimposed.
TEST(WaitingCoupling, ACamGoesOnBesideTheWayThatWasSuperimposed) {
    CouplingRig rig(2);
    const auto table = rig.tables.add_cam(hump);
    rig.start();
    const auto cam = select(rig, 1, table, true);
    rig.accept(0, at_velocity(15));
    ASSERT_TRUE(rig.run_to_sync(1, rig.accept(1, cam_in(0, cam))));
    auto gentle = on_top(7, 20);
    gentle.acceleration = gentle.deceleration = 200;
    const auto addition = rig.accept(1, gentle);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(1, addition) == CommandStatus::done; }));
    rig.accept(1, gear_in_pos(0, 500, 0, 30));
    for (int i = 0; i < 2000; ++i) {
        rig.step();
        const double at = std::fmod(rig.view(0).set_position, 20);
        ASSERT_NEAR(rig.view(1).set_position, rig.tables.prepared(cam)->at(at).position + 7, 1e-9) << i;
    }
    rig.expect_no_jump();
}

// An override acts on the motion before, as it did (P1-202, P1-203); on the slave that follows it does not (P1-208).
TEST(WaitingCoupling, TheOverrideActsOnTheMotionBefore) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(1, at_velocity(40));
    rig.run(200);
    rig.accept(1, gear_in_pos(0, 50, 100, 30));
    EXPECT_EQ(rig.axes[1].set(Override{.velocity = 0.5}, Owner::program), ErrorId::none);
    rig.run(200);
    EXPECT_NEAR(rig.view(1).set_velocity, 20, 1e-9);
    const auto gear = rig.accept(1, gear_in(0));
    rig.accept(0, at_velocity(30));
    ASSERT_TRUE(rig.run_to_sync(1, gear));
    rig.run(100);
    EXPECT_NEAR(rig.view(1).set_velocity, 30, 1e-9);
    rig.expect_no_jump();
}

// A start that a linear master has left behind: it waits, and says so; once the master has come back and crosses it the word goes.
// P1-281
TEST(WaitingCoupling, SaysThatItsMasterIsPastTheStart) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, absolute(40));
    rig.run(1500);
    rig.accept(1, gear_in_pos(0, 100, 0, 30));  // 70 lies ahead
    rig.run(5);
    EXPECT_FALSE(rig.raised(1, AxisAlarm::coupling_start_passed));
    const auto gear = rig.accept(1, gear_in_pos(0, 50, 0, 30));  // 20 is behind
    rig.run(5);
    EXPECT_TRUE(rig.raised(1, AxisAlarm::coupling_start_passed));
    EXPECT_TRUE(rig.axes[1].active_alarms().size() == 1);
    EXPECT_EQ(rig.status(1, gear), CommandStatus::active);
    rig.accept(0, absolute(0));
    rig.run(2000);
    EXPECT_EQ(rig.axes[1].active_alarms().size(), 1u);
    rig.accept(0, absolute(100, 20));
    ASSERT_TRUE(rig.run_to_sync(1, gear));
    EXPECT_TRUE(rig.axes[1].active_alarms().empty());
    EXPECT_NEAR(rig.view(0).set_position, 50, 0.03);
}

// A start that lies a hair ahead when its command begins in the last part of a cycle is crossed in the next one.
TEST(WaitingCoupling, AStartCrossedInTheCycleAfterItsCommandIsNotMissed) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(20));
    rig.run(100);
    const double master = rig.view(0).set_position;
    const auto gear = rig.accept(1, gear_in_pos(0, master + 10.01, 0, 10));  // 0.01 ahead, half a cycle
    rig.run(3);
    EXPECT_TRUE(rig.view(1).sync_started);
    ASSERT_TRUE(rig.run_to_sync(1, gear));
}

// MasterSyncPosition is a place of the profile: with the cam shifted by 60 its 10 is the master's 70; a relative one begins at the master.
// P1-266
TEST(WaitingCoupling, TheSyncPositionOfACamIsInItsProfile) {
    CouplingRig rig(2);
    const auto table = rig.tables.add_cam(hump);
    rig.start();
    auto shifted = cam_from(select(rig, 1, table, false), 20, 10);
    std::get<CamDetails>(shifted.details).master_offset = 60;
    const auto cam = rig.accept(1, shifted);
    rig.accept(0, at_velocity(20));
    for (Patience patience; patience.lasts(rig.view(0).set_position < 79);) {
        rig.step();
        const double master = rig.view(0).set_position;
        ASSERT_EQ(rig.status(1, cam) == CommandStatus::in_target, master >= 70) << master;
        ASSERT_EQ(rig.view(1).sync_started, master >= 50 && master < 70) << master;
        if (master >= 70) {
            ASSERT_NEAR(rig.view(1).set_position, rig.tables.prepared(rig.view(1).selected_cam)->at(master - 60).position, 1e-9);
        }
    }
    rig.expect_no_jump();

    CouplingRig relative(2);
    const auto other = relative.tables.add_cam(hump);
    relative.start();
    relative.accept(0, absolute(50));
    relative.accept(1, absolute(8));
    relative.run(1500);
    const auto follow = relative.accept(1, cam_from(select(relative, 1, other, false, false), 5, 10));
    relative.accept(0, at_velocity(5));
    const auto& curve = *relative.tables.prepared(relative.view(1).selected_cam);
    for (Patience patience; patience.lasts(relative.view(0).set_position < 69);) {
        relative.step();
        const double master = relative.view(0).set_position;
        ASSERT_EQ(relative.status(1, follow) == CommandStatus::in_target, master >= 60) << master;
        // The slave's 8 is the table's value where it starts, at 5 of the profile.
        if (master >= 60) {
            ASSERT_NEAR(relative.view(1).set_position, 8 + curve.at(master - 50).position - curve.at(5).position, 1e-9) << master;
        }
    }
    EXPECT_EQ(relative.refuse(1, cam_from(relative.view(1).selected_cam, 5, 20.5)), ErrorId::invalid_position);
    relative.expect_no_jump();
}

// Without MasterSyncPosition it is the first point of the profile, also where that is not 0.
// P1-266
TEST(WaitingCoupling, WithoutSyncPositionACamIsInSyncAtItsFirstPoint) {
    CouplingRig rig(2);
    const auto table = rig.tables.add_cam(std::vector<CamPoint>{{.master = 30, .slave = 2}, {.master = 40, .slave = 6}});
    rig.start();
    const auto cam = rig.accept(1, cam_from(select(rig, 1, table, false), 10, 0));
    rig.accept(0, at_velocity(20));
    ASSERT_TRUE(rig.run_to_sync(1, cam));
    EXPECT_NEAR(rig.view(0).set_position, 30, 0.021);
    EXPECT_NEAR(rig.view(1).set_position, 2, 0.01);
    rig.expect_no_jump();
}

// Table 4: Done of MC_GearOut starts what is buffered behind it in the same call of the program, in its order.
// P1-092
TEST(WaitingCoupling, WhatIsBufferedBehindGearOutBeginsWithItsDone) {
    for (const auto& out : {gear_out(), cam_out()}) {
        CouplingRig rig(2);
        rig.start();
        rig.accept(0, at_velocity(20));
        ASSERT_TRUE(rig.run_to_sync(1, rig.accept(1, gear_in(0))));
        const auto end = rig.accept(1, out);
        const auto first = rig.accept(1, absolute(30, 40, mcBuffered));
        const auto second = rig.accept(1, absolute(10, 40, mcBuffered));
        rig.step();
        EXPECT_EQ(rig.status(1, end), CommandStatus::done);
        EXPECT_EQ(rig.status(1, first), CommandStatus::active);
        EXPECT_EQ(rig.status(1, second), CommandStatus::queued);
        ASSERT_TRUE(rig.run_until([&] { return rig.status(1, first) == CommandStatus::done; }));
        EXPECT_EQ(rig.status(1, second), CommandStatus::active);
        EXPECT_NEAR(rig.view(1).set_position, 30, 0.05);
        ASSERT_TRUE(rig.run_until([&] { return rig.status(1, second) == CommandStatus::done; }));
        rig.expect_no_jump();
    }
}

// Behind a cam that repeats nothing gets its turn, also while that cam waits itself (P1-092). What could become one by an update does not.
TEST(WaitingCoupling, NothingIsTakenBehindAPeriodicCamThatWaits) {
    CouplingRig rig(2);
    const auto table = rig.tables.add_cam(hump);
    rig.start();
    const auto once = select(rig, 1, table, false), again = select(rig, 1, table, true);
    rig.accept(1, absolute(10, 10));
    const auto cam = rig.accept(1, buffered(cam_in(0, once)));
    const auto after = rig.accept(1, absolute(20, 10, mcBuffered));
    EXPECT_EQ(rig.axes[1].update(cam, buffered(cam_in(0, again)), Owner::program), ErrorId::buffer_mode_not_supported);
    EXPECT_EQ(rig.status(1, after), CommandStatus::queued);
    rig.accept(1, absolute(12, 10));
    rig.accept(1, buffered(cam_in(0, again)));
    EXPECT_EQ(rig.refuse(1, absolute(20, 10, mcBuffered)), ErrorId::buffer_mode_not_supported);
}

// The slave keeps its last velocity whatever the override is; a change of it counts again, of that velocity.
// P1-271, P1-208
TEST(WaitingCoupling, AfterGearOutTheVelocityStaysUnderAnOverride) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(40));
    ASSERT_TRUE(rig.run_to_sync(1, rig.accept(1, gear_in(0))));
    const Override half{.velocity = 0.5};
    EXPECT_EQ(rig.axes[1].set(half, Owner::program), ErrorId::none);
    rig.run(100);
    rig.accept(1, gear_out());
    for (int i = 0; i < 1000; ++i) {
        EXPECT_EQ(rig.axes[1].set(half, Owner::program), ErrorId::none);
        rig.step();
        ASSERT_NEAR(rig.view(1).set_velocity, 40, 1e-9) << i;
        ASSERT_EQ(rig.view(1).state, AxisState::ContinuousMotion);
    }
    EXPECT_EQ(rig.axes[1].set(Override{.velocity = 0.25}, Owner::program), ErrorId::none);
    rig.run(200);
    EXPECT_NEAR(rig.view(1).set_velocity, 10, 1e-9);
    rig.expect_no_jump();
}

// Table 4: a phasing can be buffered; the signal is that of the coupling before it, which may wait itself. Behind a phasing nothing is buffered.
// P1-092, P1-297
TEST(WaitingCoupling, ABufferedPhasingWaitsForItsCoupling) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(20));
    rig.run(100);
    auto slow = gear_in(0, 2);
    slow.acceleration = 100;  // 0.4 s
    const auto gear = rig.accept(1, slow);
    const auto shift = rig.accept(1, phasing(CommandKind::phasing_absolute, 3, 10, mcBuffered));
    for (Patience patience; patience.lasts(rig.status(1, gear) != CommandStatus::in_target);) {
        ASSERT_EQ(rig.status(1, shift), CommandStatus::queued);
        ASSERT_EQ(rig.view(1).phase_shift, 0);
        rig.step();
    }
    rig.run(2);
    EXPECT_EQ(rig.status(1, shift), CommandStatus::active);
    EXPECT_EQ(rig.refuse(1, phasing(CommandKind::phasing_absolute, 1, 10, mcBuffered)), ErrorId::buffer_mode_not_supported);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(1, shift) == CommandStatus::done; }));
    EXPECT_NEAR(rig.view(1).phase_shift, 3, 1e-9);

    // Behind a gear that waits behind a move; when that is taken away the phasing goes with it.
    rig.accept(1, absolute(rig.view(1).set_position + 20, 80));
    const auto other = rig.accept(1, buffered(gear_in(0)));
    const auto later = rig.accept(1, phasing(CommandKind::phasing_relative, 2, 10, mcBuffered));
    EXPECT_EQ(rig.refuse(1, phasing(CommandKind::phasing_absolute, 1, 10, mcBuffered)), ErrorId::buffer_mode_not_supported);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(1, other) == CommandStatus::in_target; }));
    rig.run(2);
    EXPECT_EQ(rig.status(1, later), CommandStatus::active);
    rig.accept(1, absolute(rig.view(1).set_position + 20, 80));
    rig.accept(1, buffered(gear_in(0)));
    const auto lost = rig.accept(1, phasing(CommandKind::phasing_relative, 2, 10, mcBuffered));
    rig.accept(1, halt());
    rig.step();
    EXPECT_EQ(rig.status(1, lost), CommandStatus::aborted);
    EXPECT_EQ(rig.refuse(1, phasing(CommandKind::phasing_absolute, 1, 10, mcBuffered)), ErrorId::not_coupled);
    rig.expect_no_jump();
}

// Master of the phasing blocks names whose shift it is; a waiting gear has its master already, so a buffered phasing of another one is refused
// as an aborting one is.
TEST(WaitingCoupling, APhasingOfAnotherMasterIsRefusedWhetherItWaitsOrNot) {
    CouplingRig rig(3);
    rig.start();
    rig.accept(0, at_velocity(20));
    rig.accept(2, gear_in(0));
    rig.accept(2, buffered(gear_in(1)));
    const auto of = [](std::size_t master, MC_BufferMode mode) {
        auto command = phasing(CommandKind::phasing_absolute, 3, 10, mode);
        command.details = GearDetails{.master = CouplingRig::ref(master), .ratio = {}};
        return command;
    };
    EXPECT_EQ(rig.refuse(2, of(1, mcAborting)), ErrorId::invalid_master);
    EXPECT_EQ(rig.refuse(2, of(0, mcBuffered)), ErrorId::invalid_master);
    rig.accept(2, of(0, mcAborting));
    rig.accept(2, of(1, mcBuffered));
}

// Of a cam the signal is EndOfProfile; one that repeats has no end that would hand over.
TEST(WaitingCoupling, APhasingBehindACamWaitsForTheEndOfItsProfile) {
    CouplingRig rig(2);
    const auto table = rig.tables.add_cam(hump);
    rig.start();
    rig.accept(0, at_velocity(20));
    const auto cam = rig.accept(1, cam_in(0, select(rig, 1, table, false)));
    const auto shift = rig.accept(1, phasing(CommandKind::phasing_absolute, 3, 10, mcBuffered));
    ASSERT_TRUE(rig.run_until([&] { return rig.view(0).set_position > 19.9; }));
    EXPECT_EQ(rig.status(1, cam), CommandStatus::in_target);
    EXPECT_EQ(rig.status(1, shift), CommandStatus::queued);
    rig.run(10);
    EXPECT_EQ(rig.status(1, shift), CommandStatus::active);
    rig.accept(1, cam_in(0, select(rig, 1, table, true)));
    EXPECT_EQ(rig.refuse(1, phasing(CommandKind::phasing_absolute, 1, 10, mcBuffered)), ErrorId::buffer_mode_not_supported);
}

// Table 4, row Power: what is buffered while power comes up begins with Status. Taken back, or failed, it is not carried out.
// P1-092
TEST(BufferedBehindPower, BeginsWithStatus) {
    Rig rig;
    EXPECT_EQ(rig.refuse(absolute(5, 50, mcBuffered)), ErrorId::not_powered);  // nobody switches it on
    rig.enable = true;
    rig.step();
    ASSERT_EQ(rig.view().state, AxisState::Disabled);
    EXPECT_EQ(rig.refuse(absolute(5)), ErrorId::not_powered);
    const auto first = rig.accept(absolute(5, 50, mcBuffered));
    const auto second = rig.accept(relative(3, 50, mcBuffered));
    EXPECT_EQ(rig.status(first), CommandStatus::queued);
    for (Patience patience; patience.lasts(!rig.view().powered);) {
        ASSERT_EQ(rig.status(first), CommandStatus::queued);
        ASSERT_EQ(rig.view().set_velocity, 0);
        rig.step();
    }
    ASSERT_TRUE(rig.run_until([&] { return rig.status(first) == CommandStatus::done; }, 1000));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(second) == CommandStatus::done; }, 1000));
    EXPECT_EQ(rig.view().set_position, 8);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    rig.expect_no_jump();
}

TEST(BufferedBehindPower, IsAbortedWhenPowerIsTakenBack) {
    Rig rig;
    rig.enable = true;
    rig.step();
    const auto move = rig.accept(absolute(5, 50, mcBuffered));
    rig.enable = false;
    rig.step();
    EXPECT_EQ(rig.status(move), CommandStatus::aborted);
    rig.enable = true;
    rig.run(500);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    EXPECT_EQ(rig.view().set_position, 0);
}

TEST(BufferedBehindPower, IsAbortedWhenAnotherPartyTakesTheAxis) {
    Rig rig;
    rig.enable = true;
    rig.step();
    const auto move = rig.accept(absolute(5, 50, mcBuffered));
    rig.axis.take_control(Owner::commissioning);
    EXPECT_EQ(rig.status(move), CommandStatus::aborted);
    rig.run(500);
    EXPECT_EQ(rig.view().set_position, 0);
}

// Homing is one of the things that may come before: what needs it is judged when it is over.
TEST(BufferedBehindPower, AnAbsoluteMoveBehindMcHomeNeedsNoReferenceBefore) {
    auto config = plain_axis();
    config.require_homed = true;
    config.homing.kind = HomingKind::set_here;
    Rig rig(config);
    rig.enable = true;
    rig.step();
    EXPECT_EQ(rig.refuse(absolute(5, 50, mcBuffered)), ErrorId::not_homed);
    auto first = home(2);
    first.buffer_mode = mcBuffered;
    rig.accept(first);
    const auto move = rig.accept(absolute(5, 50, mcBuffered));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(move) == CommandStatus::done; }, 2000));
    EXPECT_EQ(rig.view().set_position, 5);
}

// The scan that sees its Done sees the axis where it made it be.
TEST(BufferedBehindPower, AHomingThatIsDoneWithStatusShowsItsCoordinatesAtOnce) {
    auto config = plain_axis();
    config.homing.kind = HomingKind::set_here;
    Rig rig(config, [](FakeDrive& drive) { drive.position = 7000; });
    rig.enable = true;
    rig.step();
    auto first = home(2);
    first.buffer_mode = mcBuffered;
    const auto homing = rig.accept(first);
    bool seen = false;
    rig.program = [&] {
        if (seen || rig.status(homing) != CommandStatus::done) return;
        seen = true;
        EXPECT_TRUE(rig.view().homed);
        EXPECT_NEAR(rig.view().actual_position, 2, 1e-9);
        EXPECT_NEAR(rig.view().set_position, 2, 1e-9);
    };
    rig.run(500);
    EXPECT_TRUE(seen);
}

}  // namespace
}  // namespace taktwerk::axes::test
