// More timing figures of PLCopen Part 1 v2.0, replayed by the blocks on a real axis (fake drive, virtual time, infinite jerk): additive,
// superimposed and continuous moves, ContinuousUpdate, override, the drilling example. Times are derived by hand from trapezoids.
#include <gtest/gtest.h>

#include "fb_library/all_blocks.hpp"
#include "tests/fb_library/motion/plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::AxisState;

// --- ContinuousUpdate ----------------------------------------------------------------------------------------------------

/// a = d = 100 u/s2.
struct UpdatedMove : testing::Test {
    UpdatedMove() {
        move.Axis = Plc::x;
        move.Distance = 100, move.Velocity = 10, move.Acceleration = move.Deceleration = 100;
        move.Execute = true;
        plc.program = [this](const MotionContext& ctx) {
            move(ctx);
            fastest = std::max(fastest, plc.velocity());
        };
    }
    void run_to(double position) {
        plc.run_until([&] { return plc.position() >= position; }, 60s);
    }
    Plc plc;
    MC_MoveRelative move;
    double fastest = 0;
};

// The worked example: at 50 the distance becomes 130 and the velocity 20. 0.1 s up, 4.95 s at 10, 0.1 s up, 3.825 s at 20, 0.2 s down.
// P1-108, P1-110, P1-105
TEST_F(UpdatedMove, ARelativeMoveIsProlongedOnTheWay) {
    move.ContinuousUpdate = true;
    Duration time = plc.run_until([&] { return plc.position() >= 50; }, 60s);
    move.Distance = 130, move.Velocity = 20;
    plc.scan();
    EXPECT_EQ(plc.state(), AxisState::DiscreteMotion);
    EXPECT_TRUE(move.Active);
    time += plc.run_until([&] { return move.Done; }, 60s) + Plc::period;
    EXPECT_NEAR(to_seconds(time), 9.175, 0.006);
    EXPECT_NEAR(plc.position(), 130, 1e-9);
    EXPECT_NEAR(fastest, 20, 1e-9);

    move.Distance = 200;  // after Done: nothing
    plc.run_for(100ms);
    EXPECT_NEAR(plc.position(), 130, 1e-9);
    EXPECT_EQ(plc.state(), AxisState::Standstill);
}

TEST_F(UpdatedMove, WithoutItChangedInputsDoNothing) {  // P1-052, P1-103
    run_to(50);
    move.ContinuousUpdate = true;
    move.Distance = 130, move.Velocity = 20;
    plc.run_until([&] { return move.Done; }, 60s);
    EXPECT_NEAR(plc.position(), 100, 1e-9);
    EXPECT_NEAR(fastest, 10, 1e-9);
}

TEST_F(UpdatedMove, OnceFalseTheFollowingEnds) {  // P1-104
    move.ContinuousUpdate = true;
    run_to(20);
    move.ContinuousUpdate = false;
    plc.scan();
    move.ContinuousUpdate = true;
    move.Distance = 130, move.Velocity = 20;
    plc.run_until([&] { return move.Done; }, 60s);
    EXPECT_NEAR(plc.position(), 100, 1e-9);
}

TEST_F(UpdatedMove, AnAbortedCommandIsNotUpdatedBackIntoMotion) {  // P1-106
    MC_Halt halt;
    halt.Axis = Plc::x;
    plc.program = [&](const MotionContext& ctx) {
        move(ctx);
        halt(ctx);
    };
    move.ContinuousUpdate = true;
    run_to(50);
    halt.Execute = true;
    plc.run_until([&] { return halt.Done; }, 10s);
    const double rest = plc.position();
    move.Distance = 130, move.Velocity = 20;
    plc.run_for(1s);
    EXPECT_TRUE(move.CommandAborted);
    EXPECT_EQ(plc.position(), rest);
}

// Ours: the buffer mode has done its work when the command runs.
TEST_F(UpdatedMove, AnotherBufferModeOnTheWayIsNoFault) {  // P1-109
    move.ContinuousUpdate = true;
    run_to(50);
    move.BufferMode = mcBuffered;
    plc.run_until([&] { return move.Done || move.Error; }, 60s);
    EXPECT_TRUE(move.Done);
    EXPECT_NEAR(plc.position(), 100, 1e-9);
}

// Bad values on the way are not taken: the command goes on with the last good ones and stays the block's, until its Done; good ones are taken again.
// (An Error would exclude Busy, beside an axis that this block moves.)
TEST_F(UpdatedMove, ValuesThatCannotBeUsedAreNotTakenAndTheBlockStaysAtItsCommand) {  // P1-058, P1-107
    move.ContinuousUpdate = true;
    run_to(50);
    move.Velocity = -1;
    move.Distance = 140;
    for (int i = 0; i < 100; ++i) {
        plc.scan();
        ASSERT_TRUE(move.Busy && move.Active && !move.Error) << i;
        ASSERT_EQ(move.ErrorID, ErrorId::none);
    }
    EXPECT_NEAR(fastest, 10, 1e-9);
    move.Velocity = 20;
    plc.run_until([&] { return move.Done; }, 60s);
    EXPECT_TRUE(move.Done);
    EXPECT_NEAR(plc.position(), 140, 1e-9);
    EXPECT_NEAR(fastest, 20, 1e-9);
}

// A wrong input at the edge is an error of the instance, and none of the axis.
TEST_F(UpdatedMove, AnEdgeWithAValueThatCannotBeUsedIsAnErrorOfTheInstance) {  // P1-055, P1-047
    move.Velocity = -1;
    move.Execute = true;
    plc.scan();
    EXPECT_TRUE(move.Error);
    EXPECT_EQ(move.ErrorID, ErrorId::invalid_velocity);
    EXPECT_EQ(plc.state(), AxisState::Standstill);
}

// --- MC_MoveAdditive -----------------------------------------------------------------------------------------------------

// Figure 20: First MC_MoveAbsolute 6000 at 3000, Second MC_MoveAdditive 4000 at 2000; a = d = 3000.
struct AdditiveFigure : testing::Test {
    AdditiveFigure() {
        first.Axis = second.Axis = Plc::x;
        first.Position = 6000, first.Velocity = 3000;
        second.Distance = 4000, second.Velocity = 2000;
        first.Acceleration = first.Deceleration = second.Acceleration = second.Deceleration = 3000;
        plc.program = [this](const MotionContext& ctx) {
            first.Execute = go;
            first(ctx);
            second.Execute = first.Done || test;
            second(ctx);
        };
    }
    Plc plc;
    MC_MoveAbsolute first;
    MC_MoveAdditive second;
    bool go = false, test = false;
};

TEST_F(AdditiveFigure, Figure20LeftSecondStartsOnDoneOfFirst) {  // P1-149
    go = true;
    expect_time(plc.run_until([&] { return first.Done; }, 10s), 3s);
    expect_time(plc.run_until([&] { return second.Done; }, 10s), 2667ms);
    EXPECT_NEAR(plc.position(), 10000, 1e-6);
    EXPECT_TRUE(first.Done);
    go = false;
    plc.scan();
    EXPECT_FALSE(first.Done);
    EXPECT_FALSE(second.Done);
}

// Interrupted at 3250 and 3000: 833 u while slowing to 2000, 667 u to stop; the rest at 2000.
TEST_F(AdditiveFigure, Figure20RightSecondInterruptsFirstAndEndsAtTheSamePlace) {  // P1-149, P1-147
    go = true;
    plc.run_until([&] { return plc.position() >= 3250; }, 10s);
    EXPECT_DOUBLE_EQ(plc.velocity(), 3000);
    test = true;
    plc.scan();
    plc.scan();
    EXPECT_TRUE(first.CommandAborted);
    EXPECT_TRUE(second.Active);
    expect_time(2 * Plc::period + plc.run_until([&] { return second.Done; }, 10s), 3625ms);
    EXPECT_NEAR(plc.position(), 10000, 1e-6);
    EXPECT_FALSE(first.Done);
    EXPECT_TRUE(first.CommandAborted) << "while Go";
    go = false;
    plc.scan();
    EXPECT_FALSE(first.CommandAborted);
}

// --- MC_MoveSuperimposed -------------------------------------------------------------------------------------------------

// Figure 21, with 10000 for 5000 as the additions would outlast it: underlying at 300, a = d = 100; 1000 on top at 100, a = d = 50, one
// instance triggered three times, the third time before the second has finished.
TEST(SuperimposedFigure, Figure21OneInstanceThreeTimes) {  // P1-158, P1-150, P1-064
    Plc plc;
    MC_MoveRelative base;
    MC_MoveSuperimposed added;
    base.Axis = added.Axis = Plc::x;
    base.Distance = 10000, base.Velocity = 300, base.Acceleration = base.Deceleration = 100;
    added.Distance = 1000, added.VelocityDiff = 100, added.Acceleration = added.Deceleration = 50;
    bool aborted = false;
    plc.program = [&](const MotionContext& ctx) {
        base(ctx);
        added(ctx);
        aborted = aborted || added.CommandAborted || base.CommandAborted;
    };
    base.Execute = true;
    Duration time = plc.run_until([&] { return plc.velocity() > 299.999; }, 10s);
    expect_time(time, 3s);

    added.Execute = true;  // 1st
    time += plc.run_until([&] { return plc.velocity() > 399.999; }, 10s);
    EXPECT_NEAR(plc.velocity(), 400, 1e-6);
    EXPECT_TRUE(base.Active);
    EXPECT_TRUE(added.Busy);
    time += plc.run_until([&] { return added.Done; }, 20s);
    EXPECT_NEAR(to_seconds(time), 3 + 12, 0.01) << "2 s up, 8 s at 100, 2 s down";
    EXPECT_NEAR(plc.velocity(), 300, 1e-6);
    EXPECT_NEAR(added.CoveredDistance, 1000, 1e-6);
    added.Execute = false;
    plc.scan();
    EXPECT_FALSE(added.Done);

    added.Execute = true;  // 2nd, a pulse
    plc.scan();
    added.Execute = false;
    plc.run_for(4s);
    EXPECT_NEAR(plc.velocity(), 400, 1e-6);
    added.Execute = true;  // 3rd
    plc.run_for(2s);
    EXPECT_NEAR(plc.velocity(), 400, 1e-6) << "stays";
    EXPECT_TRUE(added.Busy);
    plc.run_until([&] { return added.Done; }, 20s);
    EXPECT_TRUE(added.Done);
    EXPECT_NEAR(plc.velocity(), 300, 1e-6);
    added.Execute = false;

    plc.run_until([&] { return base.Done; }, 60s);
    EXPECT_EQ(plc.velocity(), 0);
    EXPECT_FALSE(aborted);
    // The 2nd had its ramp of 100 u and about 2 s at 100 before the 3rd began with another 1000.
    EXPECT_GT(plc.position(), 12000);
    EXPECT_LT(plc.position(), 13000);
}

// Figure 23: 5000 at 300 (a = d = 100: 19.667 s); from 10 s on 1000 on top at 50 (a = d = 50: 21 s): it goes on alone, and ends at 6000.
TEST(SuperimposedFigure, Figure23TheAdditionOutlastsTheUnderlyingMotion) {  // P1-160, P1-155
    Plc plc;
    MC_MoveAbsolute base;
    MC_MoveSuperimposed added;
    base.Axis = added.Axis = Plc::x;
    base.Position = 5000, base.Velocity = 300, base.Acceleration = base.Deceleration = 100;
    added.Distance = 1000, added.VelocityDiff = 50, added.Acceleration = added.Deceleration = 50;
    plc.program = [&](const MotionContext& ctx) {
        base(ctx);
        added(ctx);
    };
    base.Execute = true;
    plc.run_for(10s);
    added.Execute = true;
    Duration time = 10s + plc.run_until([&] { return base.Done; }, 60s);
    expect_time(time, 19667ms);
    EXPECT_TRUE(added.Busy);
    EXPECT_NEAR(plc.velocity(), 50, 1e-6);
    EXPECT_EQ(plc.state(), AxisState::DiscreteMotion) << "ours: it still moves";
    time += plc.run_until([&] { return added.Done; }, 60s);
    expect_time(time, 31s);
    EXPECT_NEAR(plc.position(), 6000, 1e-6);
    EXPECT_EQ(plc.state(), AxisState::Standstill);
}

TEST(SuperimposedFigure, HaltSuperimposedEndsTheAdditionAlone) {  // P1-161
    Plc plc;
    MC_MoveVelocity base;
    MC_MoveSuperimposed added;
    MC_HaltSuperimposed halt;
    base.Axis = added.Axis = halt.Axis = Plc::x;
    base.Velocity = 300, base.Acceleration = 100;
    added.Distance = 1000, added.VelocityDiff = 100, added.Acceleration = added.Deceleration = 50;
    halt.Deceleration = 200;
    plc.program = [&](const MotionContext& ctx) {
        base(ctx);
        added(ctx);
        halt(ctx);
    };
    base.Execute = true;
    plc.run_until([&] { return base.InVelocity; }, 10s);
    added.Execute = true;
    plc.run_until([&] { return plc.velocity() > 399.999; }, 10s);
    EXPECT_TRUE(base.InVelocity) << "P1-166: its own part of the velocity";
    halt.Execute = true;
    expect_time(plc.run_until([&] { return halt.Done; }, 10s), 500ms);
    EXPECT_TRUE(added.CommandAborted);
    EXPECT_NEAR(plc.velocity(), 300, 1e-6);
    EXPECT_TRUE(base.Active);
    EXPECT_FALSE(base.CommandAborted);
}

// --- MC_MoveContinuous... ------------------------------------------------------------------------------------------------

// Figures 25 and 26: cut from 100 to 50 at -100, coming from 0; fast 500, a = d = 4000. Turning point 101.25; at 100 with -100 after 0.3525 s
// (0.125 s up, 0.0775 s at 500, 0.125 s down, 0.025 s back to 100); 0.5 s of cut; the way back peaks at -452.8.
TEST(ContinuousFigure, Figure26LaserCutter) {  // P1-173, P1-169, P1-170, P1-171
    Plc plc;
    MC_MoveContinuousAbsolute to_cut;
    MC_MoveAbsolute back;
    to_cut.Axis = back.Axis = Plc::x;
    to_cut.Position = 100, to_cut.EndVelocity = -100, to_cut.Velocity = 500;
    back.Position = 0, back.Velocity = 500;
    to_cut.Acceleration = to_cut.Deceleration = back.Acceleration = back.Deceleration = 4000;
    bool laser = false;
    double highest = 0, slowest_cut = -100, fastest_cut = -100, fastest_back = 0;
    plc.program = [&](const MotionContext& ctx) {
        to_cut(ctx);
        laser = to_cut.InEndVelocity && plc.position() > 50;
        if (laser) {
            slowest_cut = std::max(slowest_cut, plc.velocity());
            fastest_cut = std::min(fastest_cut, plc.velocity());
            EXPECT_LE(plc.position(), 100 + 1e-6);
            EXPECT_EQ(plc.state(), AxisState::ContinuousMotion);
        }
        back.Execute = to_cut.InEndVelocity && plc.position() <= 50 ? true : back.Execute;
        back(ctx);
        highest = std::max(highest, plc.position());
        fastest_back = std::min(fastest_back, plc.velocity());
    };
    to_cut.Execute = true;
    expect_time(plc.run_until([&] { return to_cut.InEndVelocity; }, 10s), 353ms);
    EXPECT_NEAR(highest, 101.25, 0.01);
    const Duration cut = plc.run_until([&] { return !laser; }, 10s);
    expect_time(cut, 500ms);
    EXPECT_NEAR(slowest_cut, -100, 1e-6);
    EXPECT_NEAR(fastest_cut, -100, 1e-6) << "no ramp inside the cut";
    plc.run_until([&] { return back.Done; }, 10s);
    EXPECT_TRUE(to_cut.CommandAborted);
    EXPECT_NEAR(fastest_back, -452.8, 4) << "4 u/s: one cycle of the ramp";
    EXPECT_NEAR(plc.position(), 0, 1e-9);
}

// Figure 29: 1000 at 50 arriving with 20; then 500 at 20 with 10; then 700 at 20. Each starts in the scan in which it sees the one before.
TEST(ContinuousFigure, Figure29AChainWithoutAStop) {  // P1-177, P1-174, P1-175
    Plc plc;
    MC_MoveContinuousRelative first, second;
    MC_MoveRelative third;
    first.Axis = second.Axis = third.Axis = Plc::x;
    first.Distance = 1000, first.EndVelocity = 20, first.Velocity = 50;
    second.Distance = 500, second.EndVelocity = 10, second.Velocity = 20;
    third.Distance = 700, third.Velocity = 20;
    first.Acceleration = first.Deceleration = second.Acceleration = second.Deceleration = third.Acceleration = third.Deceleration = 100;
    bool start = false;
    int second_in_end_velocity = 0;
    double slowest = 50;
    plc.program = [&](const MotionContext& ctx) {
        first.Execute = start;
        first(ctx);
        second.Execute = first.InEndVelocity;
        second(ctx);
        second_in_end_velocity += second.InEndVelocity;
        third.Execute = second.InEndVelocity || (third.Execute && !third.Done);
        third(ctx);
    };
    start = true;
    plc.run_until([&] { return first.InEndVelocity; }, 60s);
    EXPECT_NEAR(plc.position(), 1000, 0.05);
    EXPECT_NEAR(plc.velocity(), 20, 0.2);
    plc.scan();
    EXPECT_FALSE(first.InEndVelocity);
    EXPECT_TRUE(first.CommandAborted) << "until Start falls";
    plc.run_until(
        [&] {
            slowest = std::min(slowest, plc.velocity());
            return second.InEndVelocity;
        },
        60s);
    EXPECT_NEAR(plc.position(), 1500, 0.1);
    EXPECT_NEAR(slowest, 10, 0.2) << "no stop between";
    EXPECT_TRUE(first.CommandAborted);
    start = false;
    plc.scan();
    EXPECT_FALSE(first.CommandAborted);
    plc.run_until([&] { return third.Done; }, 60s);
    EXPECT_EQ(second_in_end_velocity, 1) << "its Execute had fallen";
    EXPECT_NEAR(plc.position(), 2200, 0.1);
    EXPECT_EQ(plc.velocity(), 0);
}

// --- MC_SetOverride ------------------------------------------------------------------------------------------------------

// Figure 36, with 100 u/s for 1.0 and a = d = 100.
TEST(OverrideFigure, Figure36FactorsWhileEnabled) {  // P1-212, P1-202, P1-203, P1-206, P1-207
    Plc plc;
    MC_MoveVelocity move;
    MC_SetOverride factors;
    move.Axis = factors.Axis = Plc::x;
    move.Velocity = 100, move.Acceleration = move.Deceleration = 100;
    move.Execute = true;
    plc.program = [&](const MotionContext& ctx) {
        move(ctx);
        factors(ctx);
    };
    plc.run_until([&] { return move.InVelocity; }, 10s);

    factors.VelFactor = 0.5;
    plc.run_for(100ms);
    EXPECT_EQ(plc.velocity(), 100) << "not enabled";
    EXPECT_FALSE(factors.Enabled);

    factors.Enable = true;  // 1: with full deceleration
    plc.scan();
    EXPECT_TRUE(factors.Enabled);
    expect_time(plc.run_until([&] { return plc.velocity() <= 50; }, 10s), 500ms);
    plc.run_for(10ms);
    EXPECT_NEAR(plc.velocity(), 50, 1e-9);
    EXPECT_TRUE(move.InVelocity) << "at the reduced velocity";
    factors.Enable = false;
    plc.run_for(100ms);
    EXPECT_NEAR(plc.velocity(), 50, 1e-9) << "kept";

    factors.Enable = true;
    factors.AccFactor = 0.5;
    plc.run_for(10ms);
    factors.VelFactor = 1;  // 2: with half the acceleration
    plc.run_for(500ms);
    EXPECT_NEAR(plc.velocity(), 75, 0.2);
    factors.Enable = false;  // in the ramp
    plc.run_for(600ms);
    EXPECT_NEAR(plc.velocity(), 100, 1e-9) << "the ramp went on";

    factors.VelFactor = 0, factors.AccFactor = 1;
    plc.run_for(100ms);
    EXPECT_NEAR(plc.velocity(), 100, 1e-9);
    factors.Enable = true;  // 3
    expect_time(plc.run_until([&] { return plc.velocity() <= 0; }, 10s), 1s);
    EXPECT_EQ(plc.state(), AxisState::ContinuousMotion) << "no Standstill";
    factors.Enable = false;
    plc.run_for(100ms);
    EXPECT_EQ(plc.velocity(), 0);

    factors.Enable = true;  // 4
    factors.VelFactor = 1, factors.AccFactor = 0;
    plc.run_for(100ms);
    EXPECT_FALSE(factors.Enabled);
    EXPECT_EQ(factors.ErrorID, ErrorId::invalid_override);
    EXPECT_EQ(plc.velocity(), 0) << "nothing taken over";
    factors.Enable = false;
    plc.scan();
    EXPECT_FALSE(factors.Error);
}

// --- settings in the queue -----------------------------------------------------------------------------------------------

TEST(QueuedSetting, SetPositionActsWhenTheMoveBeforeItIsDone) {  // P1-201
    Plc plc;
    MC_MoveAbsolute move;
    MC_SetPosition set;
    move.Axis = set.Axis = Plc::x;
    move.Position = 100, move.Velocity = 1000, move.Acceleration = move.Deceleration = 10000;
    set.Position = 7, set.ExecutionMode = mcQueued;
    double highest = 0;
    plc.program = [&](const MotionContext& ctx) {
        move(ctx);
        set(ctx);
        highest = std::max(highest, plc.position());
    };
    move.Execute = set.Execute = true;
    plc.run_until([&] { return move.Done; }, 10s);
    plc.run_until([&] { return set.Done; }, 10s);
    EXPECT_TRUE(set.Done);
    // Its turn comes in the cycle in which the move ends; a cycle before that it was 10000 * 0.001^2 / 2 away.
    EXPECT_NEAR(highest, 100 - 0.005, 1e-9) << "not before the end of the move";
    EXPECT_NEAR(plc.axis.view().actual_position, 7, 0.1) << "the drive was some cycles behind";
}

// --- the drilling example ------------------------------------------------------------------------------------------------

struct Drilling : testing::Test {
    /// From 30 fast to 0, on with feed to -10, 500 ms there, back to 30. Fast 100, feed 25, a = d = 1000.
    Drilling() {
        fast.Axis = feed.Axis = back.Axis = Plc::x;
        fast.Position = 0, fast.Velocity = 100;
        feed.Distance = -10, feed.Velocity = 25;
        back.Position = 30, back.Velocity = 100;
        for (MC_MoveAbsolute* move : {&fast, &back}) move->Acceleration = move->Deceleration = 1000;
        feed.Acceleration = feed.Deceleration = 1000;
        dwell.PT = 500ms;
        plc.program = [this](const MotionContext& ctx) {
            fast.Execute = start;
            fast(ctx);
            feed.Execute = start && (feed.BufferMode == mcAborting ? fast.Done : fast.Busy || feed.Execute);
            feed(ctx);
            dwell.IN = feed.Done;
            dwell(ctx);
            back.Execute = dwell.Q;
            back(ctx);
            if (feed.Done && !back.Busy) at_the_bottom += Plc::period;
            if (start && !feed.Done && plc.position() < 29) {
                const bool stands = plc.velocity() == 0;
                stops_on_the_way += stands && moved;
                moved = !stands;
            }
            if (velocity_at_zero == 0 && plc.position() <= 0 && start) velocity_at_zero = plc.velocity();
            lowest = std::min(lowest, plc.position());
        };
        MC_MoveAbsolute to_start = back;
        auto body = plc.program;
        plc.program = [&](const MotionContext& ctx) { to_start(ctx); };
        to_start.Execute = true;
        plc.run_until([&] { return to_start.Done; }, 10s);
        plc.program = body;
    }
    Plc plc;
    MC_MoveAbsolute fast, back;
    MC_MoveRelative feed;
    TON dwell;
    bool start = false, moved = false;
    int stops_on_the_way = 0;
    double lowest = 0, velocity_at_zero = 0;
    Duration at_the_bottom{};
};

TEST_F(Drilling, Figure54WithoutBlendingItStopsBetweenFastAndFeed) {  // P1-304, P1-305
    start = true;
    plc.run_until([&] { return back.Done; }, 20s);
    EXPECT_EQ(stops_on_the_way, 1);
    EXPECT_NEAR(lowest, -10, 1e-9);
    EXPECT_GE(at_the_bottom, 500ms);
    EXPECT_NEAR(plc.position(), 30, 1e-9);
}

TEST_F(Drilling, Figure54WithBlendingLowItGoesThroughZeroWithTheFeed) {  // P1-304, P1-305, P1-088
    feed.BufferMode = mcBlendingLow;
    start = true;
    plc.run_until([&] { return back.Done; }, 20s);
    EXPECT_EQ(stops_on_the_way, 0);
    EXPECT_NEAR(velocity_at_zero, -25, 1e-6);
    EXPECT_NEAR(lowest, -10, 1e-9);
    EXPECT_GE(at_the_bottom, 500ms);
    EXPECT_NEAR(plc.position(), 30, 1e-9);
}

}  // namespace
}  // namespace taktwerk::fb
