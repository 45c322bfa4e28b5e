// The rules of outputs (PLCopen Part 1 v2.0, 2.4.1) by blocks on a real axis, which decides for itself what becomes of a command.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "fb_library/all_blocks.hpp"
#include "tests/fb_library/motion/plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::AxisState;

/// Outputs of one call; what a block has not is FALSE.
struct Outputs {
    bool done = false, in_target = false, busy = false, active = false, aborted = false, error = false, number = false;
};

template <class Block>
Outputs outputs_of(const Block& block) {
    Outputs out;
    if constexpr (requires { block.Done; }) out.done = block.Done;
    if constexpr (requires { block.InVelocity; }) out.in_target = block.InVelocity;
    if constexpr (requires { block.InEndVelocity; }) out.in_target = block.InEndVelocity;
    out.busy = block.Busy;
    if constexpr (requires { block.Active; }) out.active = block.Active;
    if constexpr (requires { block.CommandAborted; }) out.aborted = block.CommandAborted;
    out.error = block.Error;
    out.number = block.ErrorID != ErrorId::none;
    return out;
}

/// One block under random hands, and what must hold of its outputs in every call.
template <class Block>
struct Watched {
    Block block{};
    Outputs before{};
    bool executed = false;
    int dones = 0, aborts = 0, errors = 0, late = 0;

    void call(const MotionContext& ctx) {
        block(ctx);
        const auto now = outputs_of(block);
        const int outcomes = now.done + now.aborted + now.error;
        ASSERT_LE(outcomes, 1) << "P1-045, P1-058";
        ASSERT_FALSE(now.busy && outcomes > 0) << "P1-058, P1-068, P1-078";
        if (block.Execute) {
            ASSERT_EQ(now.busy + outcomes, 1) << "P1-058, P1-068: exactly one while Execute is TRUE";
        }
        ASSERT_EQ(now.error, now.number) << "P1-044";
        ASSERT_FALSE(now.active && !now.busy) << "P1-059, P1-078";
        ASSERT_FALSE(now.in_target && !(now.busy && now.active)) << "P1-045, P1-078";
        // An outcome without Execute is one of a command that was still running, and shows for one call.
        if (!block.Execute && outcomes > 0) {
            ASSERT_TRUE(executed || before.busy) << "P1-061, P1-063";
            ASSERT_FALSE(executed && !before.busy) << "P1-061: falls in the call in which Execute falls";
            ++late;
        }
        dones += now.done && !before.done, aborts += now.aborted && !before.aborted, errors += now.error && !before.error;
        before = now, executed = block.Execute;
    }
};

// P1-044, P1-045, P1-058, P1-059, P1-061, P1-063, P1-068, P1-078, P1-107: 20,000 calls of seven blocks on one axis, with ContinuousUpdate and
// without, refused inputs and faults of the axis. What each rule says is asserted after every call; every outcome of every block has to occur.
TEST(OutputsOnAnAxis, ExcludeEachOtherUnderRandomHands) {
    Plc plc;
    Watched<MC_MoveAbsolute> absolute;
    Watched<MC_MoveRelative> relative;
    Watched<MC_MoveAdditive> additive;
    Watched<MC_MoveVelocity> velocity;
    Watched<MC_MoveContinuousAbsolute> continuous;
    Watched<MC_Halt> halt;
    Watched<MC_Stop> stop;
    MC_Reset reset;
    reset.Axis = Plc::x;
    std::mt19937 hands(2026);
    const auto chance = [&](int one_in) { return hands() % static_cast<unsigned>(one_in) == 0; };
    const auto number = [&](double from, double to) { return from + (to - from) * static_cast<double>(hands() % 1000) / 999; };
    const auto turn = [&](auto& watched, int one_in) {
        auto& block = watched.block;
        block.Axis = Plc::x;
        if (chance(one_in)) {
            block.Execute = !block.Execute;
            if constexpr (requires { block.Velocity; }) block.Velocity = chance(10) ? 0 : number(20, 400);
            if constexpr (requires { block.EndVelocity; }) block.EndVelocity = number(5, 50);
            if constexpr (requires { block.Acceleration; }) block.Acceleration = chance(10) ? -1 : number(1000, 9000);
            if constexpr (requires { block.Deceleration; }) block.Deceleration = number(1000, 9000);
            if constexpr (requires { block.BufferMode; }) block.BufferMode = static_cast<MC_BufferMode>(chance(2) ? 0 : hands() % 6);
            if constexpr (requires { block.ContinuousUpdate; }) block.ContinuousUpdate = chance(2);
        }
        if constexpr (requires { block.Position; }) block.Position = chance(20) ? number(-20, 20) : block.Position;
        if constexpr (requires { block.Distance; }) block.Distance = chance(20) ? number(-20, 20) : block.Distance;
    };
    plc.program = [&](const MotionContext& ctx) {
        absolute.call(ctx), relative.call(ctx), additive.call(ctx), velocity.call(ctx), continuous.call(ctx), halt.call(ctx),
            stop.call(ctx);
        reset(ctx);
    };
    for (int i = 0; i < 20000 && !testing::Test::HasFatalFailure(); ++i) {
        SCOPED_TRACE("scan " + std::to_string(i));
        turn(absolute, 60), turn(relative, 60), turn(additive, 80), turn(velocity, 120), turn(continuous, 120), turn(halt, 200);
        turn(stop, stop.block.Execute ? 40 : 600);
        if (chance(800)) plc.axis.stop_for_error(0x3001, false);
        reset.Execute = plc.state() == AxisState::ErrorStop && chance(3);
        plc.scan();
    }
    const auto occurred = [](const char* name, const auto& watched, bool has_done) {
        EXPECT_TRUE(!has_done || watched.dones > 0) << name << " was never Done";
        EXPECT_GT(watched.aborts, 0) << name;
        EXPECT_GT(watched.errors, 0) << name;
        EXPECT_GT(watched.late, 0) << name << ": no outcome after Execute fell";
    };
    occurred("MC_MoveAbsolute", absolute, true);
    occurred("MC_MoveRelative", relative, true);
    occurred("MC_MoveAdditive", additive, true);
    occurred("MC_MoveVelocity", velocity, false);
    occurred("MC_MoveContinuousAbsolute", continuous, false);
    occurred("MC_Halt", halt, true);
    EXPECT_GT(stop.dones, 0);
    EXPECT_GT(stop.errors, 0);
}

// P1-062: Execute held or dropped in the middle: the same trajectory to the last bit.
TEST(ExecuteOnAnAxis, FallingInTheMiddleChangesNoBitOfTheMotion) {
    std::vector<std::vector<double>> ways(2);
    for (const bool drops : {false, true}) {
        Plc plc;
        MC_MoveAbsolute move;
        move.Axis = Plc::x;
        move.Position = 100, move.Velocity = 100, move.Acceleration = move.Deceleration = 500, move.Jerk = 5000, move.Execute = true;
        plc.program = [&](const MotionContext& ctx) { move(ctx); };
        for (int i = 0; i < 1600; ++i) {
            if (drops && i == 300) move.Execute = false;
            plc.scan();
            ways[drops].push_back(plc.position());
        }
        EXPECT_EQ(plc.position(), 100);
    }
    EXPECT_EQ(ways[0], ways[1]);
}

struct TwoBlocks : testing::Test {
    TwoBlocks() {
        move.Axis = next.Axis = run.Axis = Plc::x;
        move.Position = 100, next.Position = 200, move.Velocity = next.Velocity = run.Velocity = 100;
        plc.program = [this](const MotionContext& ctx) { move(ctx), next(ctx), run(ctx); };
    }
    Plc plc;
    MC_MoveAbsolute move, next;
    MC_MoveVelocity run;
};

// P1-074, P1-083 (figure 7): buffered, Busy at once, Active when the one before is Done; Done of a pulse lasts one call, with Execute held it stays.
TEST_F(TwoBlocks, ABufferedOneIsActiveFromTheTakeOverOn) {
    move.Execute = next.Execute = true;
    next.BufferMode = mcBuffered;
    plc.run_for(100ms);
    EXPECT_TRUE(move.Busy && move.Active);
    EXPECT_TRUE(next.Busy);
    next.Execute = false;  // case 3: a pulse
    int together = 0, waiting = 0;
    plc.run_until(
        [&] {
            together += move.Active && next.Active;
            waiting += next.Busy && !next.Active;
            return move.Done;
        },
        10s);
    ASSERT_TRUE(move.Done);
    EXPECT_EQ(together, 0);
    EXPECT_GT(waiting, 100);
    plc.run_for(3ms);
    EXPECT_TRUE(next.Busy && next.Active);
    int shown = 0;
    plc.run_until([&] { return shown += next.Done, !next.Busy && shown > 0 && !next.Done; }, 10s);
    EXPECT_EQ(shown, 1);
    EXPECT_EQ(plc.position(), 200);
    EXPECT_TRUE(move.Done) << "its Execute is still TRUE";
    move.Execute = false;
    plc.scan();
    EXPECT_FALSE(move.Done);
}

// P1-085: without BufferMode a block interrupts the running one at once.
TEST_F(TwoBlocks, WithoutABufferModeTheRunningOneIsAborted) {
    move.Execute = true;
    plc.run_for(200ms);
    ASSERT_TRUE(move.Active);
    next.Position = -50;
    next.Execute = true;
    plc.run_for(3ms);
    EXPECT_TRUE(move.CommandAborted);
    EXPECT_FALSE(move.Busy || move.Active || move.Done);
    EXPECT_TRUE(next.Active);
    plc.run_until([&] { return next.Done; }, 10s);
    EXPECT_EQ(plc.position(), -50);
}

// P1-071, P1-084 (figure 8, case 3): Execute falls while the velocity is still to come: InVelocity comes all the same, Busy stays.
TEST_F(TwoBlocks, InVelocityComesAfterExecuteFell) {
    run.Execute = true;
    plc.scan();
    run.Execute = false;
    plc.scan();
    EXPECT_TRUE(run.Busy);
    EXPECT_FALSE(run.InVelocity);
    plc.run_until([&] { return run.InVelocity; }, 5s);
    EXPECT_TRUE(run.InVelocity && run.Busy && run.Active);
    EXPECT_EQ(plc.velocity(), 100);
}

// P1-084 (figure 8, cases 1 and 2): interrupted, or a fault of the axis: InVelocity, Busy and Active fall with the call that shows it.
TEST_F(TwoBlocks, InVelocityFallsWithTheInterruption) {
    for (const bool fault : {false, true}) {
        run.Execute = true;
        plc.run_until([&] { return run.InVelocity; }, 5s);
        ASSERT_TRUE(run.InVelocity);
        if (fault) plc.axis.stop_for_error(0x3001, false);
        else next.Execute = true;
        plc.run_until([&] { return !run.Busy; }, 10ms);
        EXPECT_EQ(run.CommandAborted, !fault);
        EXPECT_EQ(run.Error, fault);
        EXPECT_FALSE(run.InVelocity || run.Busy || run.Active);
        run.Execute = next.Execute = false;
        plc.scan();
        EXPECT_FALSE(run.CommandAborted || run.Error);
    }
}

// P1-112, our choice: a new edge with the velocity already reached takes InVelocity back for the call of the edge.
TEST_F(TwoBlocks, ANewEdgeTakesInVelocityBackForACall) {
    run.Execute = true;
    plc.run_until([&] { return run.InVelocity; }, 5s);
    run.Execute = false;
    plc.run_for(5ms);
    EXPECT_TRUE(run.InVelocity);
    run.Execute = true;
    plc.scan();
    EXPECT_FALSE(run.InVelocity);
    EXPECT_EQ(plc.velocity(), 100);
    plc.run_for(3ms);
    EXPECT_TRUE(run.InVelocity);
    EXPECT_EQ(plc.velocity(), 100);
}

/// A motion in full swing.
template <class Block>
void prepare(Block& block) {
    block.Axis = Plc::x;
    if constexpr (requires { block.Position; }) block.Position = 1000;
    if constexpr (requires { block.Distance; }) block.Distance = 1000;
    if constexpr (requires { block.Velocity; }) block.Velocity = 100;
    if constexpr (requires { block.EndVelocity; }) block.EndVelocity = 10;
    if constexpr (requires { block.Deceleration; }) block.Deceleration = 50;
}

template <class First, class Second>
void expect_aborted() {
    Plc plc;
    MC_MoveVelocity before;
    First first{};
    Second second{};
    prepare(before), prepare(first), prepare(second);
    plc.program = [&](const MotionContext& ctx) { before(ctx), first(ctx), second(ctx); };
    before.Execute = true;
    plc.run_for(100ms);
    first.Execute = true;
    plc.run_for(100ms);
    ASSERT_TRUE(first.Active) << "before the interruption";
    second.Execute = true;
    plc.run_for(3ms);
    EXPECT_TRUE(first.CommandAborted);
    EXPECT_FALSE(first.Busy || first.Active || first.Error);
    EXPECT_TRUE(second.Busy && !second.Error);
}

template <class First, class... Second>
void expect_aborted_by_each() {
    (expect_aborted<First, Second>(), ...);
}

template <class Block>
struct AbortedOnAnAxis : testing::Test {};
using Motions = testing::Types<MC_MoveAbsolute, MC_MoveRelative, MC_MoveAdditive, MC_MoveVelocity, MC_MoveContinuousAbsolute,
                               MC_MoveContinuousRelative, MC_Halt>;
TYPED_TEST_SUITE(AbortedOnAnAxis, Motions);

// P1-077: each motion aborted by each other one, and by another instance of its own kind.
TYPED_TEST(AbortedOnAnAxis, ByEachOther) {
    expect_aborted_by_each<TypeParam, MC_MoveAbsolute, MC_MoveRelative, MC_MoveAdditive, MC_MoveVelocity, MC_MoveContinuousAbsolute,
                           MC_MoveContinuousRelative, MC_Halt, MC_Stop>();
}

// P1-114: Status is the power stage's, not Enable's: a drive that does not switch on, and one that loses its power.
TEST(PowerOnAnAxis, StatusIsThePowerStages) {
    Plc plc;
    EXPECT_TRUE(plc.power.Status);
    plc.drive.refuses_power = true;
    plc.run_until([&] { return !plc.power.Status; }, 100ms);
    EXPECT_TRUE(plc.power.Enable);
    EXPECT_FALSE(plc.power.Status);
    EXPECT_NE(plc.drive.power, axes::PowerState::enabled);
}

}  // namespace
}  // namespace taktwerk::fb
