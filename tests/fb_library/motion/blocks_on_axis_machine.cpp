// Motion blocks and the real axis together, where the figures of the standard say nothing: jogging, faults, homing, coordinates.
#include <gtest/gtest.h>

#include "fb_library/all_blocks.hpp"
#include "tests/fb_library/motion/plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::AxisState;

axes::AxisConfig gentle_axis() {
    auto config = Plc::roomy_axis();
    config.limits = {.velocity = 100, .acceleration = 1000, .deceleration = 1000, .jerk = 20000};
    config.manual = {.slow = 5, .fast = 25};
    config.patience.jog_lease = 200ms;
    return config;
}

struct JogOnAxis : testing::Test {
    JogOnAxis() {
        jog.Axis = Plc::x;
        plc.program = [this](const MotionContext& ctx) { jog(ctx); };
    }
    Plc plc{gentle_axis()};
    MC_Jog jog;
};

TEST_F(JogOnAxis, MovesWhilePressedAndStopsOnRelease) {
    jog.Mode = mcJogStandardFast;
    jog.JogBackwards = true;
    plc.run_for(500ms);
    EXPECT_NEAR(plc.velocity(), -25, 1e-9);
    EXPECT_TRUE(jog.Active);

    jog.JogBackwards = false;
    plc.run_until([this] { return jog.Done; }, 1s);
    EXPECT_TRUE(jog.Done);
    EXPECT_EQ(plc.velocity(), 0);
    EXPECT_EQ(plc.state(), AxisState::Standstill);
    EXPECT_GT(plc.oracle.compared(), 500) << "the rig's oracle did not look";
}

TEST_F(JogOnAxis, ContinuousFollowsVelocityWhileMoving) {
    jog.Mode = mcJogContinuous;
    jog.Velocity = 10;
    jog.JogForward = true;
    plc.run_for(300ms);
    EXPECT_NEAR(plc.velocity(), 10, 1e-9);
    jog.Velocity = 40;
    plc.run_for(300ms);
    EXPECT_NEAR(plc.velocity(), 40, 1e-9);
    EXPECT_TRUE(jog.Busy);
}

TEST_F(JogOnAxis, StopsWhenTheProgramIsNoLongerCalled) {
    jog.JogForward = true;
    plc.run_for(300ms);
    ASSERT_NEAR(plc.velocity(), 5, 1e-9);
    plc.calls_blocks = false;
    plc.run_for(gentle_axis().patience.jog_lease + 100ms);
    EXPECT_EQ(plc.velocity(), 0);

    plc.calls_blocks = true;
    plc.run_for(100ms);
    EXPECT_EQ(plc.velocity(), 0) << "still pressed, but it must be released first";
    EXPECT_FALSE(jog.Busy);
}

TEST_F(JogOnAxis, InchingMovesExactlyTheDistance) {
    jog.Mode = mcJogInching;
    jog.Position = 2.5;
    jog.Velocity = 20;
    jog.JogForward = true;
    plc.run_until([this] { return jog.Done; }, 2s);
    EXPECT_DOUBLE_EQ(plc.position(), 2.5);
}

// The drive fails in motion: the move shows Error, MC_Reset fails while the cause is there and succeeds after.
TEST(FaultOnAxis, ResetLeadsBackToMotion) {
    Plc plc{gentle_axis()};
    MC_MoveAbsolute move;
    MC_Reset reset;
    MC_ReadStatus status;
    MC_ReadAxisError axis_error;
    move.Axis = reset.Axis = status.Axis = axis_error.Axis = Plc::x;
    status.Enable = axis_error.Enable = true;
    move.Position = 50, move.Velocity = 50;
    plc.program = [&](const MotionContext& ctx) {
        move(ctx);
        reset(ctx);
        status(ctx);
        axis_error(ctx);
    };
    move.Execute = true;
    plc.run_for(300ms);
    ASSERT_TRUE(move.Active);

    plc.drive.fault_code = 0x8611;
    plc.run_until([&] { return move.Error; }, 1s);
    plc.scan();
    EXPECT_TRUE(status.ErrorStop);
    EXPECT_NE(axis_error.AxisErrorID, 0);
    EXPECT_FALSE(plc.power.Status);

    reset.Execute = true;
    plc.run_until([&] { return reset.Done || reset.Error; }, 20s);
    EXPECT_EQ(reset.ErrorID, ErrorId::reset_failed);
    EXPECT_TRUE(move.Error) << "P1-232: a reset touches no other instance";

    plc.drive.fault_code = 0;
    reset.Execute = move.Execute = false;
    plc.scan();
    reset.Execute = true;
    plc.run_until([&] { return reset.Done || reset.Error; }, 20s);
    EXPECT_TRUE(reset.Done);
    plc.run_until([&] { return plc.power.Status; }, 5s);
    plc.scan();
    EXPECT_TRUE(status.Standstill);
    EXPECT_EQ(axis_error.AxisErrorID, 0);

    move.Execute = true;
    plc.run_until([&] { return move.Done; }, 10s);
    EXPECT_DOUBLE_EQ(plc.position(), 50);
}

TEST(PowerOnAxis, OffInMotionAbortsAndEndsInDisabled) {  // P1-023
    Plc plc{gentle_axis()};
    MC_MoveVelocity move;
    move.Axis = Plc::x;
    move.Velocity = 50;
    plc.program = [&](const MotionContext& ctx) { move(ctx); };
    move.Execute = true;
    plc.run_for(500ms);
    plc.power.Enable = false;
    plc.run_until([&] { return !plc.power.Status; }, 2s);
    EXPECT_TRUE(move.CommandAborted);
    EXPECT_EQ(plc.state(), AxisState::Disabled);
}

TEST(PowerOnAxis, ASecondMcPowerIsAConflict) {  // P1-120
    Plc plc{gentle_axis()};
    MC_Power second;
    second.Axis = Plc::x;
    second.Enable = true;
    plc.program = [&](const MotionContext& ctx) { second(ctx); };
    plc.run_for(5ms);
    EXPECT_EQ(second.ErrorID, ErrorId::power_conflict);
    EXPECT_TRUE(plc.power.Status);
}

TEST(HomeOnAxis, PositionBecomesTheReferencesCoordinate) {  // P1-121, P1-122
    auto config = gentle_axis();
    config.homing = {.kind = axes::HomingKind::set_here};
    Plc plc{config};
    MC_Home home;
    home.Axis = Plc::x;
    home.Position = 123.5;
    home.Execute = true;
    plc.program = [&](const MotionContext& ctx) { home(ctx); };
    plc.run_until([&] { return home.Done || home.Error; }, 5s);
    EXPECT_TRUE(home.Done);
    EXPECT_EQ(plc.state(), AxisState::Standstill);
    EXPECT_TRUE(plc.axis.view().homed);
    EXPECT_NEAR(plc.axis.view().actual_position, 123.5, 0.001);
}

TEST(SetPositionOnAxis, ShiftsWithoutMotion) {  // P1-198, P1-199
    Plc plc{gentle_axis()};
    MC_SetPosition set;
    MC_ReadActualPosition read;
    set.Axis = read.Axis = Plc::x;
    set.Position = 7;
    set.Execute = read.Enable = true;
    plc.program = [&](const MotionContext& ctx) {
        set(ctx);
        read(ctx);
    };
    const double before = plc.drive.position;
    plc.run_until([&] { return set.Done; }, 100ms);
    EXPECT_NEAR(read.Position, 7, 0.001) << "with Done, not later";
    plc.run_for(20ms);
    EXPECT_EQ(plc.drive.position, before);
}

}  // namespace
}  // namespace taktwerk::fb
