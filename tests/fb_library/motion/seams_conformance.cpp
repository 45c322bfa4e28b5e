// Where one motion takes over from another: every cycle of the seam is tried. PLCopen Part 1 v2.0, 3.3, 3.4, 4.5; docs/motion/decisions.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fb_library/all_blocks.hpp"
#include "tests/fb_library/motion/coupled_plc.hpp"
#include "tests/fb_library/motion/plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::AxisState;

axes::AxisConfig with_limits(double velocity, double acceleration, double deceleration, double jerk) {
    auto config = Plc::roomy_axis();
    config.limits = {.velocity = velocity, .acceleration = acceleration, .deceleration = deceleration, .jerk = jerk};
    return config;
}

struct ReversingMaster {
    explicit ReversingMaster(const axes::AxisConfig& config, double forth, double back) : plc(2, {}, config) {
        lead.Axis = gear.Master = CoupledPlc::master;
        gear.Slave = halt.Axis = stop.Axis = CoupledPlc::slave;
        plc.program = [this](const MotionContext& ctx) { lead(ctx), gear(ctx), halt(ctx), stop(ctx); };
        lead.Velocity = forth;
        lead.Execute = gear.Execute = true;
        plc.run_for(1s);
        lead.Execute = false;
        plc.scan();
        lead.Velocity = back;
        lead.Execute = true;
    }
    double slave() const { return plc.velocity(CoupledPlc::slave); }
    CoupledPlc plc;
    MC_MoveVelocity lead;
    MC_GearIn gear;
    MC_Halt halt;
    MC_Stop stop;
};

// A slave's jerk is not limited, so a stop may find it with its whole acceleration: it must not run on by a^2 / (2 j), 125 u/s here, or backwards.
TEST(StopOfASlave, NeverMakesItFasterWhateverItsAcceleration) {
    for (const double jerk : {4000.0, 20000.0})
        for (const bool hold : {false, true})
            for (int after = 0; after < 240; after += 3) {
                ReversingMaster cell(with_limits(100, 1000, 1000, jerk), 80, -80);
                for (int i = 0; i < after; ++i) cell.plc.scan();
                const double begin = cell.slave();
                (hold ? cell.stop.Execute : cell.halt.Execute) = true;
                double fastest = 0;
                for (int i = 0; i < 700; ++i) cell.plc.scan(), fastest = std::max(fastest, std::abs(cell.slave()));
                ASSERT_LE(fastest, std::abs(begin) + 2 + 1e-6)
                    << "jerk " << jerk << ", " << after << " cycles after the turn, from " << begin;
                ASSERT_EQ(cell.slave(), 0);
            }
}

// README: a slave keeps its limits. Through a reversal it first brakes, with its deceleration.
TEST(Slave, BrakesWithItsDecelerationWhenItsMasterTurns) {
    ReversingMaster cell(with_limits(400, 10000, 5000, std::numeric_limits<double>::infinity()), 320, -395);
    double before = cell.slave(), hardest = 0;
    for (int i = 0; i < 400; ++i) {
        cell.plc.scan();
        const double now = cell.slave();
        if (before * now > 0) hardest = std::max(hardest, (std::abs(before) - std::abs(now)) * 1000);
        before = now;
    }
    EXPECT_LE(hardest, 5000 * (1 + 1e-9));
    EXPECT_GT(hardest, 4000) << "it did brake";
}

// Power off in any scan round the beginning of a buffered motion: a drive without power is never told to move (README, power off in motion).
TEST(PowerOff, RoundTheBeginningOfABufferedMotionLeavesNothingMoving) {
    int moved = 0;
    for (int at = 20; at < 60; ++at) {
        Plc plc{with_limits(100, 1000, 1000, std::numeric_limits<double>::infinity())};
        MC_MoveRelative first, second;
        MC_Stop stop;
        first.Axis = second.Axis = stop.Axis = Plc::x;
        first.Distance = 1, second.Distance = 20, first.Velocity = second.Velocity = 50;
        second.BufferMode = mcBuffered;
        int scan = 0;
        plc.program = [&](const MotionContext& ctx) {
            ++scan;
            first.Execute = scan > 1;
            stop.Execute = scan >= 20 && scan < 22;
            second.Execute = scan >= 23;
            first(ctx), stop(ctx), second(ctx);
        };
        for (int i = 0; i < 200; ++i) {
            if (i == at) plc.power.Enable = false;
            plc.scan();
            moved += i >= at && plc.velocity() != 0;
            ASSERT_FALSE(plc.state() == AxisState::Disabled && plc.velocity() != 0) << "off in scan " << at << ", scan " << i;
        }
    }
    EXPECT_GT(moved, 0) << "in some of them it was in motion, and ramped";
}

// Numbers that are finite and no motion of this axis are the caller's error, and the axis goes on.
TEST(Absurd, NumbersAreRefusedAndStopNothing) {
    Plc plc;
    MC_MoveVelocity run;
    MC_MoveAbsolute far, slow;
    run.Axis = far.Axis = slow.Axis = Plc::x;
    run.Velocity = 100;
    far.Position = 1e100, far.Velocity = 100;
    slow.Position = 10, slow.Velocity = 1e-300;
    plc.program = [&](const MotionContext& ctx) { run(ctx), far(ctx), slow(ctx); };
    run.Execute = true;
    plc.run_for(500ms);
    far.Execute = slow.Execute = true;
    plc.scan();
    EXPECT_EQ(far.ErrorID, ErrorId::invalid_position);
    EXPECT_EQ(slow.ErrorID, ErrorId::invalid_velocity);
    plc.run_for(10ms);
    EXPECT_TRUE(run.InVelocity);
    EXPECT_EQ(plc.velocity(), 100);
}

}  // namespace
}  // namespace taktwerk::fb
