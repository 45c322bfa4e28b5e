// Sections 2.1, 2.4.2, 3.2, 3.5, 3.8 and 4.2 of PLCopen Part 1 v2.0 by blocks on real axes: each clause whole, with what must not happen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fb_library/all_blocks.hpp"
#include "tests/fb_library/motion/coupled_plc.hpp"
#include "tests/fb_library/motion/plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::AxisState;

// P1-136: Velocity is a maximum: a short move never gets there, and still ends on its target. With a = d = 1000 and 10 u the peak is
// sqrt(10 * 1000) = 100, half of what is allowed.
TEST(ShortMove, HasATrianglesPeak) {
    Plc plc;
    MC_MoveAbsolute move;
    move.Axis = Plc::x;
    move.Position = 10, move.Velocity = 200, move.Acceleration = move.Deceleration = 1000, move.Execute = true;
    plc.program = [&](const MotionContext& ctx) { move(ctx); };
    double fastest = 0;
    int constant = 0;
    plc.run_until(
        [&] {
            fastest = std::max(fastest, plc.velocity());
            constant += plc.velocity() > 1 && plc.axis.view().set_acceleration == 0;
            return move.Done;
        },
        5s);
    EXPECT_NEAR(fastest, 100, 1);
    EXPECT_LE(constant, 1) << "no stretch of constant velocity";
    EXPECT_EQ(plc.position(), 10);
}

// P1-124: Homing in every cycle from the take-over until Done, and in no other.
TEST(HomingOnAnAxis, IsTheStateFromTakeOverToDone) {
    auto config = Plc::roomy_axis();
    config.homing = {.kind = axes::HomingKind::drive, .method = 21};
    Plc plc{config};
    MC_Home home;
    MC_ReadStatus status;
    home.Axis = status.Axis = Plc::x;
    status.Enable = true;
    plc.program = [&](const MotionContext& ctx) { home(ctx), status(ctx); };
    plc.run_for(5ms);
    home.Execute = true;
    int homing = 0;
    for (int i = 0; i < 10000 && !home.Done; ++i) {
        plc.scan();
        ASSERT_FALSE(home.Error);
        ASSERT_EQ(status.Homing, home.Active && !home.Done) << "scan " << i;
        homing += status.Homing;
    }
    EXPECT_TRUE(home.Done);
    EXPECT_GT(homing, 100);
}

// P1-086: an aborting command acts at once and clears the buffer: the running one and the waiting one are aborted, and neither moves anything again.
TEST(Aborting, ClearsTheBuffer) {
    Plc plc;
    MC_MoveAbsolute running, waiting, now;
    running.Axis = waiting.Axis = now.Axis = Plc::x;
    running.Position = 100, waiting.Position = 300, now.Position = 20;
    running.Velocity = waiting.Velocity = now.Velocity = 100;
    waiting.BufferMode = mcBuffered;
    plc.program = [&](const MotionContext& ctx) { running(ctx), waiting(ctx), now(ctx); };
    running.Execute = waiting.Execute = true;
    plc.run_for(500ms);
    ASSERT_TRUE(running.Active);
    ASSERT_TRUE(waiting.Busy && !waiting.Active);
    now.Execute = true;
    plc.run_for(2ms);
    EXPECT_TRUE(running.CommandAborted && waiting.CommandAborted);
    EXPECT_TRUE(now.Active);
    plc.run_until([&] { return now.Done; }, 10s);
    plc.run_for(1s);
    EXPECT_EQ(plc.position(), 20);
}

/// A base motion, and what MC_MoveSuperimposed adds to it.
struct Superimposing : testing::Test {
    Superimposing() {
        lead.Axis = CoupledPlc::master, gear.Master = CoupledPlc::master;
        run.Axis = move.Axis = add.Axis = gear.Slave = CoupledPlc::slave;
        lead.Velocity = run.Velocity = move.Velocity = 100;
        move.Position = 1000;
        gear.Acceleration = gear.Deceleration = 1000;
        add.Distance = 40, add.VelocityDiff = 20, add.Acceleration = add.Deceleration = 1000;
        plc.program = [this](const MotionContext& ctx) { lead(ctx), gear(ctx), run(ctx), move(ctx), add(ctx); };
    }
    [[nodiscard]] const axes::AxisView& axis() const { return plc.view(CoupledPlc::slave); }
    /// In full swing at 100 u/s in `state`: 20 u/s more for 2 s, 40 u more in the end, and the state stays.
    void expect_added(AxisState state) {
        ASSERT_EQ(axis().state, state);
        ASSERT_NEAR(axis().set_velocity, 100, 1e-9);
        const double from = axis().set_position;
        add.Execute = true;
        double fastest = 0;
        int cycles = 0;
        for (; cycles < 5000 && !add.Done; ++cycles) {
            plc.scan();
            fastest = std::max(fastest, axis().set_velocity);
            ASSERT_EQ(axis().state, state);
        }
        ASSERT_TRUE(add.Done);
        EXPECT_NEAR(fastest, 120, 1e-6);
        // The block sees the views of the scan's begin: up to two cycles of 0.1 u.
        EXPECT_NEAR(axis().set_position - from, 0.1 * cycles + 40, 0.21);
    }
    CoupledPlc plc;
    MC_MoveVelocity lead, run;
    MC_MoveAbsolute move;
    MC_GearIn gear;
    MC_MoveSuperimposed add;
};

// P1-153: velocity and, where there is one, the target change in discrete, continuous and synchronized motion.
TEST_F(Superimposing, ADiscreteMotionEndsFartherByIt) {
    move.Execute = true;
    plc.run_for(1s);
    expect_added(AxisState::DiscreteMotion);
    plc.run_until([&] { return move.Done; }, 20s);
    EXPECT_NEAR(axis().set_position, 1040, 1e-9);
}
TEST_F(Superimposing, AContinuousMotionGoesFasterForAWhile) {  // P1-153
    run.Execute = true;
    plc.run_for(1s);
    expect_added(AxisState::ContinuousMotion);
}
TEST_F(Superimposing, ASynchronizedMotionIsShifted) {  // P1-153
    lead.Execute = gear.Execute = true;
    plc.run_for(2s);
    expect_added(AxisState::SynchronizedMotion);
}

struct RunningCam : testing::Test {
    static axes::MotionTables two_cams() {
        axes::MotionTables tables;
        low = tables.add_cam(
            std::vector<axes::CamPoint>{{.master = 0, .slave = 0}, {.master = 100, .slave = 10}, {.master = 200, .slave = 0}});
        high = tables.add_cam(
            std::vector<axes::CamPoint>{{.master = 0, .slave = 0}, {.master = 100, .slave = 30}, {.master = 200, .slave = 0}});
        return tables;
    }
    RunningCam() : plc(2, two_cams()) {
        lead.Axis = select.Master = other.Master = cam.Master = CoupledPlc::master;
        select.Slave = other.Slave = cam.Slave = CoupledPlc::slave;
        lead.Velocity = 100;
        select.CamTable = low, other.CamTable = high;
        select.Periodic = other.Periodic = true;
        select.MasterAbsolute = other.MasterAbsolute = select.SlaveAbsolute = other.SlaveAbsolute = true;
        plc.program = [this](const MotionContext& ctx) { lead(ctx), select(ctx), other(ctx), cam(ctx); };
        select.Execute = true;
        plc.run_for(5ms);
        cam.CamTableID = select.CamTableID;
        cam.Execute = lead.Execute = true;
        plc.run_until([&] { return cam.InSync && lead.InVelocity; }, 10s);
    }
    double highest(int cycles) {
        double most = -1e9;
        for (int i = 0; i < cycles; ++i) plc.scan(), most = std::max(most, plc.position(CoupledPlc::slave));
        return most;
    }
    static inline CamRef low{}, high{};
    CoupledPlc plc;
    MC_MoveVelocity lead;
    MC_CamTableSelect select, other;
    MC_CamIn cam;
};

// P1-261: a table selected while a cam runs changes neither the state nor (our choice, P1-257) the motion, at once or queued; mcImmediately answers at
// once, mcQueued waits behind what runs; the next MC_CamIn takes the new one.
TEST_F(RunningCam, SelectingAnotherTableWhileOneRuns) {
    ASSERT_TRUE(cam.InSync);
    ASSERT_NEAR(highest(4000), 10, 0.2);
    other.Execute = true;
    plc.run_for(5ms);
    EXPECT_TRUE(other.Done);
    EXPECT_EQ(plc.view(CoupledPlc::slave).state, AxisState::SynchronizedMotion);
    EXPECT_NEAR(highest(4000), 10, 0.2) << "the running cam keeps its copy";

    other.Execute = false;
    plc.scan();
    other.ExecutionMode = mcQueued, other.Execute = true;
    plc.run_for(100ms);
    EXPECT_TRUE(other.Busy || other.Error || other.Done);
    EXPECT_EQ(plc.view(CoupledPlc::slave).state, AxisState::SynchronizedMotion);
    EXPECT_NEAR(highest(2000), 10, 0.2);

    other.Execute = false, other.ExecutionMode = mcImmediately;
    plc.scan();
    other.Execute = true;
    plc.run_for(5ms);
    ASSERT_TRUE(other.Done);
    cam.Execute = false;
    plc.scan();
    cam.CamTableID = other.CamTableID;
    cam.Execute = true;
    plc.run_for(4s);
    EXPECT_NEAR(highest(4000), 30, 0.6) << "the next MC_CamIn takes it";
}

// P1-032: in SynchronizedMotion and in Homing too, the administrative blocks never change the state.
TEST(AdministrativeBlocks, LeaveSynchronizedMotionAndHomingAlone) {
    CoupledPlc plc;
    MC_MoveVelocity lead;
    MC_GearIn gear;
    MC_WriteParameter write;
    MC_SetPosition set;
    MC_SetOverride override_block;
    MC_ReadMotionState motion;
    MC_PhasingRelative phase;
    MC_HaltSuperimposed halt;
    MC_AbortTrigger abort;
    lead.Axis = gear.Master = phase.Master = CoupledPlc::master;
    gear.Slave = phase.Slave = write.Axis = set.Axis = override_block.Axis = motion.Axis = halt.Axis = abort.Axis = CoupledPlc::slave;
    lead.Velocity = 100, gear.Acceleration = gear.Deceleration = 1000;
    write.ParameterNumber = axes::velocity_of_application, write.Value = 5000;
    set.Relative = true, set.Position = 3;
    override_block.VelFactor = 0.5, override_block.AccFactor = override_block.JerkFactor = 1;
    phase.PhaseShift = 5, phase.Velocity = 10;
    halt.Deceleration = 100;
    plc.program = [&](const MotionContext& ctx) {
        lead(ctx), gear(ctx);
        write(ctx), set(ctx), override_block(ctx), motion(ctx), phase(ctx), halt(ctx), abort(ctx);
    };
    lead.Execute = gear.Execute = true;
    plc.run_for(2s);
    ASSERT_EQ(plc.view(CoupledPlc::slave).state, AxisState::SynchronizedMotion);
    write.Execute = set.Execute = phase.Execute = halt.Execute = abort.Execute = true;
    override_block.Enable = motion.Enable = true;
    for (int i = 0; i < 1500; ++i) {
        plc.scan();
        ASSERT_EQ(plc.view(CoupledPlc::slave).state, AxisState::SynchronizedMotion) << "scan " << i;
    }
    EXPECT_TRUE(phase.Done) << "they did something: " << static_cast<int>(phase.ErrorID);
    EXPECT_TRUE(set.Done);
}

}  // namespace
}  // namespace taktwerk::fb
