// The blocks that show or set values (PLCopen Part 1 v2.0, 2.2.3, 3.19 to 3.31), on a real axis over a drive whose state the test knows.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "fb_library/all_blocks.hpp"
#include "tests/fb_library/motion/plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::AxisState;

template <class Block>
struct EnabledOnAnAxis : testing::Test {};
using ReadingBlocks =
    testing::Types<MC_ReadStatus, MC_ReadAxisError, MC_ReadParameter, MC_ReadBoolParameter, MC_ReadDigitalInput, MC_ReadActualPosition,
                   MC_ReadActualVelocity, MC_ReadActualTorque, MC_ReadMotionState, MC_ReadAxisInfo>;
TYPED_TEST_SUITE(EnabledOnAnAxis, ReadingBlocks);

// P1-049 (figure 5), P1-048, P1-065, P1-069, P1-080: Valid and Busy with Enable; an error that heals itself leaves Busy, and Valid comes back; with Enable
// everything falls in that call.
TYPED_TEST(EnabledOnAnAxis, ValidErrorAndValidAgain) {
    Plc plc;
    TypeParam block{};
    const auto refer_to = [&](axes::AxisRef axis) {
        if constexpr (requires { block.Axis; }) block.Axis = axis;
        else block.Input.axis = axis;
    };
    if constexpr (requires { block.ParameterNumber; }) block.ParameterNumber = axes::enable_limit_positive;
    refer_to(Plc::x);
    plc.program = [&](const MotionContext& ctx) { block(ctx); };
    plc.run_for(3ms);
    EXPECT_FALSE(block.Valid || block.Busy || block.Error);

    block.Enable = true;
    plc.scan();
    EXPECT_TRUE(block.Valid && block.Busy);
    refer_to({7});  // there is no such axis
    plc.scan();
    EXPECT_TRUE(block.Error && block.Busy);
    EXPECT_FALSE(block.Valid);
    EXPECT_EQ(block.ErrorID, ErrorId::invalid_axis);
    refer_to(Plc::x);
    plc.scan();
    EXPECT_TRUE(block.Valid && block.Busy);
    EXPECT_FALSE(block.Error);
    EXPECT_EQ(block.ErrorID, ErrorId::none);

    refer_to({7});
    plc.scan();
    ASSERT_TRUE(block.Error);
    block.Enable = false;
    plc.scan();
    EXPECT_FALSE(block.Valid || block.Busy || block.Error);
    EXPECT_EQ(block.ErrorID, ErrorId::none);
}

struct ValuesOnAnAxis : testing::Test {
    ValuesOnAnAxis() {
        read.Axis = speed.Axis = torque.Axis = parameter.Axis = boolean.Axis = info.Axis = error.Axis = status.Axis = state.Axis = Plc::x;
        move.Axis = run.Axis = reset.Axis = Plc::x;
        read.Enable = speed.Enable = torque.Enable = parameter.Enable = boolean.Enable = info.Enable = error.Enable = status.Enable = true;
        state.Enable = true;
        move.Velocity = run.Velocity = 100;
        move.Acceleration = move.Deceleration = run.Acceleration = run.Deceleration = 1000;
        plc.program = [this](const MotionContext& ctx) {
            move(ctx), run(ctx), reset(ctx);
            read(ctx), speed(ctx), torque(ctx), parameter(ctx), boolean(ctx), info(ctx), error(ctx), status(ctx), state(ctx);
        };
    }
    Plc plc;
    MC_MoveAbsolute move;
    MC_MoveVelocity run;
    MC_Reset reset;
    MC_ReadActualPosition read;
    MC_ReadActualVelocity speed;
    MC_ReadActualTorque torque;
    MC_ReadParameter parameter;
    MC_ReadBoolParameter boolean;
    MC_ReadAxisInfo info;
    MC_ReadAxisError error;
    MC_ReadStatus status;
    MC_ReadMotionState state;
};

// P1-223: in u, of the motor and not of the set-point: a motor that stays 250 counts of 1000 behind.
TEST_F(ValuesOnAnAxis, ThePositionIsTheMotors) {
    move.Position = 10, move.Execute = true;
    plc.drive.lag = 250;
    plc.run_for(1s);
    EXPECT_EQ(plc.position(), 10);
    EXPECT_NEAR(read.Position, 9.75, 1e-9);
}

// P1-224, P1-225: signed; dropping Enable takes them to 0 with Valid, while the values themselves go on.
TEST_F(ValuesOnAnAxis, VelocityAndTorqueAreSignedAndGoWithEnable) {
    plc.drive.load = 0.25;
    for (const auto direction : {mcPositiveDirection, mcNegativeDirection}) {
        run.Execute = false;
        plc.scan();
        run.Direction = direction, run.Execute = true;
        plc.run_for(500ms);
        EXPECT_NEAR(speed.Velocity, direction == mcPositiveDirection ? 100 : -100, 1) << "100 counts a cycle, whole counts";
        EXPECT_NEAR(torque.Torque, 0.25, 1e-9);
    }
    plc.drive.load = -0.5;
    plc.run_for(10ms);
    EXPECT_NEAR(torque.Torque, -0.5, 1e-9);
    speed.Enable = torque.Enable = false;
    plc.scan();
    EXPECT_FALSE(speed.Valid || torque.Valid);
    EXPECT_EQ(speed.Velocity, 0);
    EXPECT_EQ(torque.Torque, 0);
    EXPECT_NE(plc.velocity(), 0);
}

// P1-213: the value of each call, and one that was written meanwhile.
TEST_F(ValuesOnAnAxis, ParametersFollow) {
    move.Position = 20, move.Execute = true;
    parameter.ParameterNumber = axes::commanded_position;
    double seen = parameter.Value;
    int changes = 0;
    for (int i = 0; i < 100; ++i) {
        plc.scan();
        changes += parameter.Value != seen;
        seen = parameter.Value;
        ASSERT_TRUE(parameter.Valid);
    }
    EXPECT_GT(changes, 90) << "in motion the set position is another in each cycle";
}

// P1-218, our choice: the BOOL blocks write and read the standard's 4 to 6 and nothing else; the REAL block reads them as 0 and 1.
TEST_F(ValuesOnAnAxis, BooleanParametersByTheBooleanBlocks) {
    MC_WriteBoolParameter write;
    write.Axis = Plc::x;
    auto others = plc.program;
    plc.program = [&](const MotionContext& ctx) { write(ctx), others(ctx); };
    boolean.ParameterNumber = parameter.ParameterNumber = write.ParameterNumber = axes::enable_lag_monitoring;
    for (const bool value : {false, true, false}) {
        write.Execute = false;
        plc.scan();
        write.Value = value, write.Execute = true;
        plc.run_for(5ms);
        EXPECT_TRUE(write.Done) << static_cast<int>(write.ErrorID);
        EXPECT_TRUE(boolean.Valid);
        EXPECT_EQ(boolean.Value, value);
        EXPECT_EQ(parameter.Value, value ? 1 : 0);
    }
    write.Execute = false;
    boolean.ParameterNumber = write.ParameterNumber = axes::velocity_of_application;
    plc.scan();
    EXPECT_EQ(boolean.ErrorID, ErrorId::invalid_parameter);
    write.Execute = true;
    plc.scan();
    EXPECT_EQ(write.ErrorID, ErrorId::invalid_parameter);
}

// P1-226: exactly one of eight, the axis' own state, through power off, standstill, motions, a stop and an error.
TEST_F(ValuesOnAnAxis, StatusShowsOneOfEight) {
    MC_Stop stop;
    stop.Axis = Plc::x;
    auto others = plc.program;
    plc.program = [&](const MotionContext& ctx) { stop(ctx), others(ctx); };
    const auto shown = [&] {
        const std::array all{status.ErrorStop,  status.Disabled,       status.Stopping,         status.Homing,
                             status.Standstill, status.DiscreteMotion, status.ContinuousMotion, status.SynchronizedMotion};
        EXPECT_EQ(std::count(all.begin(), all.end(), true), 1);
        return status;
    };
    plc.run_for(3ms);
    EXPECT_TRUE(shown().Standstill);
    move.Position = 100, move.Execute = true;
    plc.run_for(100ms);
    EXPECT_TRUE(shown().DiscreteMotion);
    run.Execute = true;
    plc.run_for(100ms);
    EXPECT_TRUE(shown().ContinuousMotion);
    stop.Execute = true, stop.Deceleration = 1000;
    plc.run_for(20ms);
    EXPECT_TRUE(shown().Stopping);
    stop.Execute = move.Execute = run.Execute = false;
    plc.run_for(1s);
    EXPECT_TRUE(shown().Standstill);
    plc.axis.stop_for_error(0x3001, false);
    plc.run_for(100ms);
    EXPECT_TRUE(shown().ErrorStop);
    plc.power.Enable = false;
    reset.Execute = true;
    plc.run_for(1s);
    EXPECT_TRUE(shown().Disabled);
}

/// The calls in which one output of MC_ReadMotionState is TRUE, run by run.
struct Phases {
    std::vector<char> order;
    void note(const MC_ReadMotionState& state) {
        const char now = state.Accelerating ? '+' : state.Decelerating ? '-' : '=';
        if (order.empty() || order.back() != now) order.push_back(now);
    }
};

// P1-227: a trapezoid in both senses: constant at rest, faster, constant, slower, constant; by the absolute velocity; one of the three at a time;
// the direction is the sense in which the position goes.
TEST_F(ValuesOnAnAxis, MotionStateOfATrapezoidInBothSenses) {
    for (const double target : {50.0, -50.0}) {
        const double start = plc.position();
        move.Position = target, move.Execute = true;
        Phases phases;
        int wrong = 0;
        plc.run_until(
            [&] {
                if (state.Valid) phases.note(state);
                wrong += state.ConstantVelocity + state.Accelerating + state.Decelerating != 1;
                wrong += target > start ? state.DirectionNegative : state.DirectionPositive;
                return move.Done;
            },
            10s);
        plc.run_for(3ms);
        phases.note(state);
        EXPECT_EQ(std::string(phases.order.begin(), phases.order.end()), "=+=-=");
        EXPECT_EQ(wrong - (target > start ? 1 : 0), 0) << "only the very first call has shown nothing yet";
        EXPECT_FALSE(state.DirectionPositive || state.DirectionNegative);
        move.Execute = false;
        plc.scan();
    }
}

// P1-228: of the actual value everything comes later by what the drive takes.
TEST(MotionStateOnAnAxis, OfTheActualValueComesLater) {
    Plc plc;
    plc.drive.dead_cycles = 30;
    MC_MoveVelocity run;
    MC_ReadMotionState set, actual;
    run.Axis = set.Axis = actual.Axis = Plc::x;
    set.Enable = actual.Enable = true;
    set.Source = mcSetValue, actual.Source = mcActualValue;
    run.Velocity = 100, run.Acceleration = 100;
    int cycle = 0, set_began = 0, actual_began = 0;
    plc.program = [&](const MotionContext& ctx) {
        run(ctx), set(ctx), actual(ctx);
        ++cycle;
        if (set_began == 0 && set.Accelerating) set_began = cycle;
        if (actual_began == 0 && actual.Accelerating) actual_began = cycle;
    };
    run.Execute = true;
    plc.run_for(500ms);
    ASSERT_GT(set_began, 0);
    EXPECT_GE(actual_began - set_began, 30);
}

// P1-229: each output with its cause: switches, power, reference, warning, the line to the drive.
TEST_F(ValuesOnAnAxis, AxisInfoFollowsItsCauses) {
    plc.run_for(3ms);
    EXPECT_TRUE(info.PowerOn && info.CommunicationReady && info.ReadyForPowerOn);
    EXPECT_FALSE(info.HomeAbsSwitch || info.LimitSwitchPos || info.LimitSwitchNeg || info.IsHomed || info.AxisWarning || info.Simulation);
    plc.drive.switches = true, plc.drive.home_low = -5, plc.drive.home_high = 5;
    plc.drive.warning = true;
    plc.run_for(3ms);
    EXPECT_TRUE(info.HomeAbsSwitch && info.AxisWarning);
    plc.drive.home_low = 50, plc.drive.home_high = 60;
    plc.drive.warning = false;
    plc.drive.positive_end = -10;
    plc.run_for(3ms);
    EXPECT_TRUE(info.LimitSwitchPos);
    EXPECT_FALSE(info.HomeAbsSwitch || info.LimitSwitchNeg || info.AxisWarning);
    plc.drive.positive_end = std::numeric_limits<std::int64_t>::max(), plc.drive.negative_end = 10;
    plc.run_for(3ms);
    EXPECT_TRUE(info.LimitSwitchNeg);
    EXPECT_FALSE(info.LimitSwitchPos);
    plc.drive.negative_end = std::numeric_limits<std::int64_t>::min();
    plc.power.Enable = false;
    plc.run_for(100ms);
    EXPECT_FALSE(info.PowerOn);
    EXPECT_TRUE(info.ReadyForPowerOn);
    plc.drive.offline = true;
    plc.run_for(100ms);
    EXPECT_FALSE(info.CommunicationReady || info.PowerOn || info.ReadyForPowerOn);
    EXPECT_TRUE(info.Valid);
}

// P1-230: a refused block is no error of the axis; an error of the axis is, and the block that shows it has none itself.
TEST_F(ValuesOnAnAxis, AxisErrorIsTheAxis) {
    move.Velocity = -1, move.Execute = true;
    plc.run_for(3ms);
    ASSERT_TRUE(move.Error);
    EXPECT_EQ(error.AxisErrorID, 0);
    EXPECT_TRUE(error.Valid);
    plc.drive.fault_code = 0x7121;
    plc.run_for(10ms);
    EXPECT_NE(error.AxisErrorID, 0);
    EXPECT_TRUE(error.Valid);
    EXPECT_FALSE(error.Error);
}

// P1-231, P1-233: out of ErrorStop into Standstill with power and into Disabled without; elsewhere Done at once, and nothing changes.
TEST_F(ValuesOnAnAxis, ResetLeadsToStandstillOrDisabled) {
    for (const bool powered : {true, false}) {
        plc.run_for(100ms);
        plc.axis.stop_for_error(0x3001, !powered);
        plc.power.Enable = powered;
        plc.run_for(500ms);
        ASSERT_EQ(plc.state(), AxisState::ErrorStop);
        reset.Execute = true;
        plc.run_until([&] { return reset.Done; }, 1s);
        EXPECT_TRUE(reset.Done);
        EXPECT_EQ(plc.state(), powered ? AxisState::Standstill : AxisState::Disabled);
        reset.Execute = false;
        plc.scan();
        reset.Execute = true;
        plc.run_for(2ms);
        EXPECT_TRUE(reset.Done) << "our choice: outside ErrorStop there is nothing to reset";
        EXPECT_EQ(plc.state(), powered ? AxisState::Standstill : AxisState::Disabled);
        reset.Execute = false;
        plc.power.Enable = true;
    }
}

// P1-219, P1-220, P1-221, P1-222: the drive's own points through the axis: the level of each call; written once at the edge and read back; numbers that
// do not exist are errors.
TEST(DigitalPointsOnAnAxis, AreReadWrittenAndReadBack) {
    Plc plc;
    plc.drive.caps.digital_outputs = true;
    MC_ReadDigitalInput input;
    MC_ReadDigitalOutput output;
    MC_WriteDigitalOutput write;
    input.Input.axis = output.Output.axis = write.Output.axis = Plc::x;
    input.Enable = output.Enable = true;
    input.InputNumber = 5, output.OutputNumber = write.OutputNumber = 3;
    plc.program = [&](const MotionContext& ctx) { write(ctx), input(ctx), output(ctx); };
    for (const bool on : {true, false, true}) {
        plc.drive.inputs = on ? 1u << 5 : 0;
        plc.run_for(2ms);
        EXPECT_EQ(input.Value, on);
    }
    input.InputNumber = 4;
    plc.scan();
    EXPECT_FALSE(input.Value) << "another bit";

    write.Value = true, write.Execute = true;
    plc.run_for(5ms);
    EXPECT_TRUE(write.Done);
    EXPECT_TRUE(output.Value);
    EXPECT_EQ(plc.drive.last.digital_outputs & plc.drive.last.digital_output_mask, 1u << 3) << "what the drive was told";
    write.Value = false;
    plc.run_for(5ms);
    EXPECT_TRUE(output.Value) << "written at the edge only";

    write.Execute = false;
    plc.scan();
    write.OutputNumber = output.OutputNumber = input.InputNumber = 32;
    write.Execute = true;
    plc.run_for(2ms);
    EXPECT_EQ(write.ErrorID, ErrorId::invalid_output);
    EXPECT_EQ(output.ErrorID, ErrorId::invalid_output);
    EXPECT_EQ(input.ErrorID, ErrorId::invalid_output);
}

}  // namespace
}  // namespace taktwerk::fb
