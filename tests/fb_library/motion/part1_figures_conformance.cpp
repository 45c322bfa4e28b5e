// The timing figures of PLCopen Part 1 v2.0, replayed by the blocks on a real axis (fake drive, virtual time, infinite jerk). Expected
// outputs are the figures'; times are derived by hand from trapezoids: v / a for a ramp, s / v + v / a for a move with a = d.
#include <gtest/gtest.h>

#include "fb_library/iec/edges.hpp"
#include "fb_library/motion/endless_moves.hpp"
#include "fb_library/motion/moves.hpp"
#include "fb_library/motion/reading.hpp"
#include "fb_library/motion/stops.hpp"
#include "tests/fb_library/motion/plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::AxisState;

struct StopFigure : testing::Test {
    StopFigure() {
        move.Axis = stop.Axis = halt.Axis = Plc::x;
        move.Velocity = 50, move.Acceleration = 10, move.Deceleration = 10;
        stop.Deceleration = 20;
        halt.Deceleration = 5;
        plc.program = [this](const MotionContext& ctx) {
            move(ctx);
            stop(ctx);
            halt(ctx);
        };
    }
    Plc plc;
    MC_MoveVelocity move;
    MC_Stop stop;
    MC_Halt halt;
};

// Figure 16 (P1-132): FB1 MC_MoveVelocity, V 50, a 10, d 10; FB2 MC_Stop, d 20. 5 s up, 2.5 s down.
TEST_F(StopFigure, Figure16StopLocksTheAxis) {
    move.Execute = true;
    expect_time(plc.run_until([&] { return move.InVelocity; }, 10s), 5s);
    EXPECT_DOUBLE_EQ(plc.velocity(), 50);

    stop.Execute = true;
    plc.scan();
    EXPECT_EQ(plc.state(), AxisState::Stopping);
    plc.scan();
    EXPECT_TRUE(move.CommandAborted);
    EXPECT_FALSE(move.InVelocity);
    expect_time(plc.run_until([&] { return stop.Done; }, 10s), 2500ms);
    EXPECT_EQ(plc.velocity(), 0);
    EXPECT_EQ(plc.state(), AxisState::Stopping);

    move.Execute = false;
    plc.scan();
    EXPECT_FALSE(move.CommandAborted);
    move.Execute = true;
    plc.scan();
    EXPECT_TRUE(move.Error) << "at once: MC_Stop is held";
    EXPECT_EQ(move.ErrorID, ErrorId::state_forbids);
    EXPECT_TRUE(stop.Done);

    stop.Execute = false;
    plc.scan();
    EXPECT_FALSE(stop.Done);
    EXPECT_EQ(plc.state(), AxisState::Standstill);
    EXPECT_TRUE(move.Error) << "until its own Execute falls";
    move.Execute = false;
    plc.scan();
    EXPECT_FALSE(move.Error);

    move.Execute = true;
    expect_time(plc.run_until([&] { return move.InVelocity; }, 10s), 5s);
}

// Figure 15 (P1-131), case "short": Execute falls in the ramp; Done for one call at standstill, and Standstill with it.
TEST_F(StopFigure, Figure15ReleasedDuringTheRamp) {
    move.Execute = true;
    plc.run_until([&] { return move.InVelocity; }, 10s);
    stop.Execute = true;
    plc.run_for(100ms);
    stop.Execute = false;
    plc.scan();
    EXPECT_EQ(plc.state(), AxisState::Stopping);
    plc.run_until([&] { return stop.Done; }, 10s);
    EXPECT_EQ(plc.state(), AxisState::Standstill);
    plc.scan();
    EXPECT_FALSE(stop.Done);
}

TEST_F(StopFigure, StopFromStandstillIsDoneAndHolds) {  // P1-029
    stop.Execute = true;
    plc.run_for(5ms);
    EXPECT_TRUE(stop.Done);
    EXPECT_EQ(plc.state(), AxisState::Stopping);
    stop.Execute = false;
    plc.run_for(2ms);
    EXPECT_EQ(plc.state(), AxisState::Standstill);
}

// P1-129: only power off makes MC_Stop CommandAborted.
TEST_F(StopFigure, PowerOffAbortsStop) {
    move.Execute = true;
    plc.run_until([&] { return move.InVelocity; }, 10s);
    stop.Execute = true;
    plc.run_for(100ms);
    EXPECT_TRUE(stop.Busy);
    plc.power.Enable = false;
    plc.run_until([&] { return stop.CommandAborted; }, 10s);
    EXPECT_TRUE(stop.CommandAborted);
}

// Figure 17 (P1-135): FB1 as above; FB2 MC_Halt, d 5. 10 s down, DiscreteMotion meanwhile.
TEST_F(StopFigure, Figure17HaltGivesWay) {
    move.Execute = true;
    plc.run_until([&] { return move.InVelocity; }, 10s);
    halt.Execute = true;
    plc.scan();
    plc.scan();
    EXPECT_TRUE(move.CommandAborted);
    EXPECT_EQ(plc.state(), AxisState::DiscreteMotion);
    move.Execute = false;
    expect_time(plc.run_until([&] { return halt.Done; }, 20s), 10s);
    EXPECT_EQ(plc.velocity(), 0);
    EXPECT_EQ(plc.state(), AxisState::Standstill);
    halt.Execute = false;
    plc.scan();

    move.Execute = true;
    plc.scan();
    move.Execute = false;
    plc.run_until([&] { return move.InVelocity; }, 10s);
    halt.Execute = true;
    plc.scan();
    plc.scan();
    EXPECT_TRUE(move.CommandAborted) << "one call, as Execute is FALSE";
    plc.scan();
    EXPECT_FALSE(move.CommandAborted);
    plc.run_for(1s);

    move.Execute = true;
    plc.scan();
    plc.scan();
    EXPECT_TRUE(halt.CommandAborted);
    double slowest = 50;
    plc.run_until(
        [&] {
            slowest = std::min(slowest, plc.velocity());
            return move.InVelocity;
        },
        10s);
    EXPECT_GT(slowest, 44) << "5 u/s for about one second, no stop";
    EXPECT_TRUE(halt.CommandAborted);
    halt.Execute = false;
    plc.scan();
    EXPECT_FALSE(halt.CommandAborted);
}

// Figure 18: First 6000 at 3000, Second 10000 at 2000, a = d = 3000. 3 s and 2.667 s.
struct AbsoluteFigure : testing::Test {
    AbsoluteFigure() {
        first.Axis = second.Axis = Plc::x;
        first.Position = 6000, first.Velocity = 3000;
        second.Position = 10000, second.Velocity = 2000;
        first.Acceleration = first.Deceleration = second.Acceleration = second.Deceleration = 3000;
        plc.program = [this](const MotionContext& ctx) {
            first.Execute = go;
            first(ctx);
            second.Execute = first.Done || test;
            second(ctx);
        };
    }
    Plc plc;
    MC_MoveAbsolute first, second;
    bool go = false, test = false;
};

// P1-143, P1-066
TEST_F(AbsoluteFigure, Figure18LeftSecondStartsOnDoneOfFirst) {
    go = true;
    expect_time(plc.run_until([&] { return first.Done; }, 10s), 3s);
    EXPECT_NEAR(plc.position(), 6000, 0.0016) << "Second has made its first step in this very cycle: 3000 * 0.001^2 / 2";
    expect_time(plc.run_until([&] { return second.Done; }, 10s), 2667ms);
    EXPECT_EQ(plc.position(), 10000);
    EXPECT_TRUE(first.Done);
    go = false;
    plc.scan();
    EXPECT_FALSE(first.Done);
    EXPECT_FALSE(second.Done);
}

// P1-143, P1-067
TEST_F(AbsoluteFigure, Figure18RightSecondInterruptsFirst) {
    go = true;
    plc.run_until([&] { return plc.velocity() >= 3000; }, 10s);
    test = true;
    double slowest = 3000;
    plc.scan();
    plc.scan();
    EXPECT_TRUE(first.CommandAborted);
    EXPECT_FALSE(first.Done);
    plc.run_until(
        [&] {
            slowest = std::min(slowest, plc.velocity());
            return plc.position() >= 6000;
        },
        10s);
    EXPECT_NEAR(slowest, 2000, 1e-6) << "no stop on the way";
    go = false;
    plc.scan();
    EXPECT_FALSE(first.CommandAborted);
    plc.run_until([&] { return second.Done; }, 10s);
    EXPECT_EQ(plc.position(), 10000);
    EXPECT_FALSE(first.Done);
}

// Figure 19 (P1-146), right part: Second (+4000) interrupts First; the distance counts from the set position at that moment.
TEST(RelativeFigure, Figure19DistanceCountsFromTheSetPosition) {
    Plc plc;
    plc.drive.dead_cycles = 20;  // the actual position is far behind: 60 u at 3000 u/s
    MC_MoveRelative first, second;
    first.Axis = second.Axis = Plc::x;
    first.Distance = 6000, first.Velocity = 3000;
    second.Distance = 4000, second.Velocity = 2000;
    first.Acceleration = first.Deceleration = second.Acceleration = second.Deceleration = 3000;
    plc.program = [&](const MotionContext& ctx) {
        first(ctx);
        second(ctx);
    };
    first.Execute = true;
    plc.run_until([&] { return plc.position() >= 3250; }, 10s);
    const double begin = plc.position();

    second.Execute = true;
    plc.run_until([&] { return second.Done; }, 10s);

    EXPECT_TRUE(first.CommandAborted);
    EXPECT_NEAR(plc.position(), begin + 4000, 1e-6);
}

// Figure 9 (P1-102): a chain on Done; the third ends in an error.
TEST(ChainFigure, Figure9AnErrorEndsTheChain) {
    Plc plc;
    MC_MoveAbsolute first, second, third;
    first.Axis = second.Axis = third.Axis = Plc::x;
    first.Position = 10, second.Position = 20, third.Position = 1000;
    first.Velocity = second.Velocity = third.Velocity = 100;
    bool start = false, in13 = false;
    plc.program = [&](const MotionContext& ctx) {
        first.Execute = start;
        first(ctx);
        second.Execute = first.Done;
        second(ctx);
        third.Execute = second.Done && in13;
        third(ctx);
    };
    start = true;
    plc.run_until([&] { return second.Done; }, 10s);
    EXPECT_TRUE(first.Done);
    plc.run_for(50ms);
    EXPECT_FALSE(third.Busy);

    in13 = true;
    plc.run_until([&] { return third.Active; }, 1s);
    plc.drive.fault_code = 0x8611;
    plc.run_until([&] { return third.Error; }, 1s);
    EXPECT_TRUE(third.Error);
    EXPECT_FALSE(third.Done);
    EXPECT_TRUE(first.Done && second.Done);

    start = false;
    plc.scan();
    EXPECT_FALSE(first.Done || second.Done || third.Error);
}

// Figures 12 to 14 (P1-113, P1-034, P1-163): three MC_MoveVelocity; FB2 starts on FB1.InVelocity AND L and therefore shows for one cycle only.
TEST(VelocityFigure, Figure14ThreeInstancesTakeOver) {
    Plc plc;
    MC_MoveVelocity fb1, fb2, fb3;
    fb1.Axis = fb2.Axis = fb3.Axis = Plc::x;
    fb1.Velocity = 10, fb2.Velocity = 20, fb3.Velocity = 0;
    fb1.Acceleration = fb2.Acceleration = fb3.Acceleration = fb1.Deceleration = fb2.Deceleration = fb3.Deceleration = 100;
    bool k = false, l = false, m = false;
    int fb2_executes = 0;
    plc.program = [&](const MotionContext& ctx) {
        fb1.Execute = k;
        fb1(ctx);
        fb2.Execute = fb1.InVelocity && l;
        fb2_executes += fb2.Execute;
        fb2(ctx);
        fb3.Execute = m;
        fb3(ctx);
    };
    k = true;
    plc.run_until([&] { return fb1.InVelocity; }, 1s);
    EXPECT_EQ(plc.velocity(), 10);
    l = true;
    plc.run_until([&] { return fb2.InVelocity; }, 1s);
    EXPECT_EQ(plc.velocity(), 20);
    EXPECT_EQ(fb2_executes, 1);
    EXPECT_FALSE(fb1.InVelocity);
    EXPECT_TRUE(fb1.CommandAborted);
    m = true;
    plc.run_until([&] { return fb3.InVelocity; }, 1s);
    EXPECT_EQ(plc.velocity(), 0);
    EXPECT_FALSE(fb2.InVelocity);
    EXPECT_EQ(plc.state(), AxisState::ContinuousMotion) << "velocity 0 is no standstill";
}

// Appendix A: FB1 1000 at 100, FB2 2000 at 50.
struct BufferExample : testing::Test {
    BufferExample() {
        fb1.Axis = fb2.Axis = Plc::x;
        fb1.Position = 1000, fb1.Velocity = 100, fb1.Acceleration = fb1.Deceleration = 100;
        fb2.Position = 2000, fb2.Velocity = 50, fb2.Acceleration = fb2.Deceleration = 200;
        plc.program = [this](const MotionContext& ctx) {
            fb1(ctx);
            fb2(ctx);
        };
    }
    Plc plc;
    MC_MoveAbsolute fb1, fb2;
};

// Example 2, figure 58 (P1-308): aborting.
TEST_F(BufferExample, Figure58Aborting) {
    fb1.Execute = true;
    plc.run_until([&] { return plc.position() > 500; }, 20s);
    fb1.Execute = false;
    plc.scan();
    fb2.Execute = true;
    plc.scan();
    plc.scan();
    EXPECT_TRUE(fb1.CommandAborted);
    EXPECT_FALSE(fb1.Busy || fb1.Active);
    EXPECT_TRUE(fb2.Active);
    plc.scan();
    EXPECT_FALSE(fb1.CommandAborted) << "one cycle";
    plc.run_for(248ms);
    EXPECT_NEAR(plc.velocity(), 50, 0.5) << "100 to 50 at 200 u/s2 in 0.25 s";
    plc.run_until([&] { return fb2.Done; }, 60s);
    EXPECT_EQ(plc.position(), 2000);
}

// Example 3, figure 59 (P1-309): buffered; 11 s + 20.25 s; FB2 takes over in the cycle of Done_1, without a pause.
TEST_F(BufferExample, Figure59Buffered) {
    fb2.BufferMode = mcBuffered;
    fb1.Execute = true;
    plc.scan();
    fb2.Execute = true;
    plc.run_for(3s);
    EXPECT_TRUE(fb2.Busy);
    EXPECT_FALSE(fb2.Active);
    const Duration first = 3s + 1ms + plc.run_until([&] { return fb1.Done; }, 20s);
    expect_time(first, 11s);
    EXPECT_TRUE(fb2.Active) << "in the cycle of Done_1 (P1-314)";
    expect_time(plc.run_until([&] { return fb2.Done; }, 60s), 20250ms);
    EXPECT_EQ(plc.position(), 2000);
}

}  // namespace
}  // namespace taktwerk::fb
