// What PLCopen Part 1 v2.0 says of the blocks that are no motion, and of MC_Home and MC_Reset, by blocks on a real axis.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "fb_library/all_blocks.hpp"
#include "fb_library/block_types.hpp"
#include "tests/fb_library/motion/plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::AxisState;

// P1-012: the base types of Appendix B 2 (BOOL, INT, WORD, REAL, ENUM, UINT, with DWORD and TIME) and what stands for them here: LREAL for REAL,
// UINT for ErrorIDs, wider integers where the standard's are too small. Nothing else is a type of an elementary pin.
TEST(BaseTypes, AreTheStandardsOrTheirSubstitutes) {
    const std::set<std::string_view> ours{"BOOL", "INT", "DINT", "UINT", "UDINT", "WORD", "DWORD", "LREAL", "TIME"};
    for (const BlockType& type : axis_block_types())
        for (const Pin& pin : type.pins)
            if (pin.type.kind < PinKind::AXIS_REF) {
                EXPECT_EQ(ours.count(pin.type.name), 1u) << type.name << '.' << pin.name << ' ' << pin.type.name;
            }
    EXPECT_EQ(sizeof(MC_MoveAbsolute::Position), 8u);
}

template <class Block>
struct NoMotion : testing::Test {};
/// The blocks of section 2.1 that never change the state, as far as they need no table, probe or output of a drive; those at the end.
using StateKeepers =
    testing::Types<MC_ReadStatus, MC_ReadAxisError, MC_ReadParameter, MC_ReadBoolParameter, MC_WriteParameter, MC_WriteBoolParameter,
                   MC_ReadDigitalInput, MC_ReadDigitalOutput, MC_WriteDigitalOutput, MC_ReadActualPosition, MC_ReadActualVelocity,
                   MC_ReadActualTorque, MC_ReadMotionState, MC_SetPosition, MC_SetOverride, MC_AbortTrigger, MC_TouchProbe,
                   MC_DigitalCamSwitch, MC_CamTableSelect, MC_ReadAxisInfo, MC_PhasingRelative, MC_PhasingAbsolute, MC_HaltSuperimposed>;
TYPED_TEST_SUITE(NoMotion, StateKeepers);

// P1-032: called with valid or with empty references, in each state that an axis without master has; accepted or refused, the state stays.
TYPED_TEST(NoMotion, NeverChangesTheState) {
    for (const auto state : {AxisState::Disabled, AxisState::Standstill, AxisState::DiscreteMotion, AxisState::ContinuousMotion,
                             AxisState::Stopping, AxisState::ErrorStop}) {
        Plc plc;
        MC_MoveAbsolute move;
        MC_MoveVelocity run;
        MC_Stop stop;
        TypeParam block{};
        move.Axis = run.Axis = stop.Axis = Plc::x;
        move.Position = 5000, move.Velocity = run.Velocity = 100;
        if constexpr (requires { block.Axis; }) block.Axis = Plc::x;
        if constexpr (requires { block.Slave; }) block.Slave = Plc::x;
        if constexpr (requires { block.ParameterNumber; }) block.ParameterNumber = 9;
        if constexpr (requires { block.Deceleration; }) block.Deceleration = 100;
        plc.program = [&](const MotionContext& ctx) {
            move(ctx);
            run(ctx);
            stop(ctx);
            block(ctx);
        };
        move.Execute = state == AxisState::DiscreteMotion;
        run.Execute = state == AxisState::ContinuousMotion;
        stop.Execute = state == AxisState::Stopping;
        if (state == AxisState::Disabled) plc.power.Enable = false;
        if (state == AxisState::ErrorStop) plc.axis.stop_for_error(0x3001, false);
        plc.run_for(100ms);
        ASSERT_EQ(plc.state(), state) << axes::name(state);

        if constexpr (requires { block.Execute; }) block.Execute = true;
        if constexpr (requires { block.Enable; }) block.Enable = true;
        for (int i = 0; i < 50; ++i) {
            plc.scan();
            ASSERT_EQ(plc.state(), state) << axes::name(state) << ", scan " << i;
        }
    }
}

// P1-054, P1-079: the inputs of an Enable block count while it is enabled: another number, another value, without a new edge.
TEST(EnableInputs, MayChangeWhileEnabled) {
    Plc plc;
    MC_ReadParameter read;
    read.Axis = Plc::x;
    read.Enable = true;
    read.ParameterNumber = 9;
    plc.program = [&](const MotionContext& ctx) { read(ctx); };
    plc.run_for(5ms);
    ASSERT_TRUE(read.Valid);
    EXPECT_EQ(read.Value, 10000) << "MaxVelocityAppl";
    read.ParameterNumber = 1;
    plc.run_for(5ms);
    EXPECT_TRUE(read.Valid);
    EXPECT_EQ(read.Value, 0) << "CommandedPosition";
}

// P1-075, our choice: unbuffered, Active rises with Busy or in the call after it.
TEST(ActiveOutput, RisesAtTheLatestOneCallAfterBusy) {
    Plc plc;
    MC_MoveAbsolute move;
    move.Axis = Plc::x;
    move.Position = 10, move.Velocity = 100, move.Execute = true;
    plc.program = [&](const MotionContext& ctx) { move(ctx); };
    plc.scan();
    EXPECT_TRUE(move.Busy);
    plc.scan();
    EXPECT_TRUE(move.Busy && move.Active);
}

// P1-145: a relative move ends standing; its Velocity is to be given.
TEST(RelativeMove, EndsStandingAndNeedsAVelocity) {
    Plc plc;
    MC_MoveRelative move;
    move.Axis = Plc::x;
    move.Distance = 10, move.Execute = true;
    plc.program = [&](const MotionContext& ctx) { move(ctx); };
    plc.scan();
    EXPECT_TRUE(move.Error);
    EXPECT_EQ(move.ErrorID, ErrorId::invalid_velocity);
    move.Execute = false;
    plc.scan();
    move.Velocity = 100, move.Execute = true;
    plc.run_until([&] { return move.Done; }, 5s);
    EXPECT_TRUE(move.Done);
    EXPECT_EQ(plc.velocity(), 0);
    EXPECT_EQ(plc.position(), 10);
    EXPECT_EQ(plc.state(), AxisState::Standstill);
}

// P1-232: another instance keeps its Error over a reset, until its own Execute falls.
TEST(Reset, LeavesTheOutputsOfOthersAlone) {
    Plc plc;
    MC_MoveAbsolute move;
    MC_Reset reset;
    move.Axis = reset.Axis = Plc::x;
    move.Position = 1000, move.Velocity = 100, move.Execute = true;
    plc.program = [&](const MotionContext& ctx) {
        move(ctx);
        reset(ctx);
    };
    plc.run_for(100ms);
    plc.axis.stop_for_error(0x3001, false);
    plc.run_for(1s);
    ASSERT_TRUE(move.Error);
    const auto error = move.ErrorID;
    reset.Execute = true;
    plc.run_until([&] { return reset.Done; }, 1s);
    ASSERT_TRUE(reset.Done);
    EXPECT_EQ(plc.state(), AxisState::Standstill);
    EXPECT_TRUE(move.Error);
    EXPECT_EQ(move.ErrorID, error);
    move.Execute = false;
    plc.scan();
    EXPECT_FALSE(move.Error);
}

// P1-123, P1-124, P1-122: Homing from the take-over until Done, then homed, for MC_ReadAxisInfo too.
TEST(HomingState, LastsUntilDoneAndLeavesTheAxisHomed) {
    auto config = Plc::roomy_axis();
    config.homing = {.kind = axes::HomingKind::drive, .method = 21};
    Plc plc{config};
    MC_Home home;
    MC_ReadAxisInfo info;
    MC_ReadStatus status;
    home.Axis = info.Axis = status.Axis = Plc::x;
    home.Position = 123.5;
    info.Enable = status.Enable = true;
    plc.program = [&](const MotionContext& ctx) {
        home(ctx);
        info(ctx);
        status(ctx);
    };
    plc.run_for(5ms);
    EXPECT_TRUE(status.Standstill);
    EXPECT_FALSE(info.IsHomed);
    home.Execute = true;
    plc.scan();
    int homing = 0;
    plc.run_until(
        [&] {
            if (home.Done) return true;
            EXPECT_EQ(plc.state() == AxisState::Homing || plc.state() == AxisState::Standstill, true);
            homing += status.Homing;
            return false;
        },
        10s);
    EXPECT_TRUE(home.Done);
    EXPECT_GT(homing, 100) << "the drive's search took its time";
    EXPECT_EQ(plc.state(), AxisState::Standstill);
    plc.scan();
    EXPECT_TRUE(info.IsHomed);
    EXPECT_TRUE(status.Standstill);
}

// Figure 55 (P1-306): the drilling as a sequence, each step on Done of the one before: the same places as figure 54.
TEST(DrillingSequence, StepsOnDone) {
    Plc plc;
    MC_MoveAbsolute start, fast, back;
    MC_MoveRelative feed;
    TON dwell;
    start.Axis = fast.Axis = back.Axis = feed.Axis = Plc::x;
    start.Position = 30, fast.Position = 0, feed.Distance = -10, back.Position = 30;
    start.Velocity = fast.Velocity = back.Velocity = 100, feed.Velocity = 25;
    dwell.PT = 500ms;
    int step = 0;
    std::vector<double> places;
    Duration at_bottom{};
    plc.program = [&](const MotionContext& ctx) {
        start.Execute = step == 0;
        start(ctx);
        fast.Execute = step == 1;
        fast(ctx);
        feed.Execute = step == 2;
        feed(ctx);
        dwell.IN = step == 3;
        dwell(ctx);
        back.Execute = step == 4;
        back(ctx);
        if (plc.position() == -10 && plc.velocity() == 0) at_bottom += Plc::period;
        const bool ends = (step == 0 && start.Done) || (step == 1 && fast.Done) || (step == 2 && feed.Done) || (step == 3 && dwell.Q) ||
                          (step == 4 && back.Done);
        if (!ends) return;
        places.push_back(plc.position());
        ++step;
    };
    plc.run_until([&] { return step == 5; }, 10s);
    EXPECT_EQ(places, (std::vector<double>{30, 0, -10, -10, 30}));
    EXPECT_GE(at_bottom, 500ms);
}

}  // namespace
}  // namespace taktwerk::fb
