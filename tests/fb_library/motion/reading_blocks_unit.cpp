// Parameters, digital points, single values, condition and motion state as programs see them.
#include <gtest/gtest.h>

#include "fb_library/motion/axis_condition.hpp"
#include "fb_library/motion/axis_values.hpp"
#include "fb_library/motion/digital_io.hpp"
#include "fb_library/motion/moves.hpp"
#include "fb_library/motion/parameter_blocks.hpp"
#include "tests/fb_library/fake_axes.hpp"
#include "tests/fb_library/motion/plc.hpp"

namespace taktwerk::fb {
namespace {

/// A block that is enabled on axis 0.
template <class Block>
Block enabled() {
    Block block{};
    block.Enable = true;
    if constexpr (requires { block.Axis; }) block.Axis = {0};
    return block;
}

struct Bench {
    FakeAxes axes;
    axes::AxisView& axis = axes.axis();
    template <class Block>
    void scan(Block& block) {
        axes.next_scan();
        block(axes.context);
    }
};

// --- parameters ---------------------------------------------------------------------------------------------------------------

TEST(ReadParameter, FollowsTheValueWhileEnabled) {  // P1-213
    Bench bench;
    auto read = enabled<MC_ReadParameter>();
    read.ParameterNumber = 1;
    for (const double position : {1.0, 2.5, -3.0}) {
        bench.axis.set_position = position;
        bench.scan(read);
        EXPECT_TRUE(read.Valid);
        EXPECT_EQ(read.Value, position);
    }
    read.ParameterNumber = 11;
    bench.axis.set_velocity = 7;
    bench.scan(read);
    EXPECT_EQ(read.Value, 7) << "the number may change as well";
}

TEST(ReadParameter, AnUnknownNumberIsAnErrorUntilItIsMended) {  // P1-214
    Bench bench;
    auto read = enabled<MC_ReadParameter>();
    read.ParameterNumber = 18;
    bench.scan(read);
    EXPECT_FALSE(read.Valid);
    EXPECT_EQ(read.ErrorID, ErrorId::unknown_parameter);
    EXPECT_EQ(read.Value, 0);
    read.ParameterNumber = 2;
    bench.scan(read);
    EXPECT_TRUE(read.Valid);
}

TEST(ReadParameter, ABoolReadsAs0Or1AndTheBoolBlockTakesNothingElse) {  // P1-213, P1-218
    Bench bench;
    auto real = enabled<MC_ReadParameter>();
    auto boolean = enabled<MC_ReadBoolParameter>();
    real.ParameterNumber = boolean.ParameterNumber = 4;
    for (const bool level : {true, false}) {
        bench.axis.parameters[4] = level ? 1 : 0;
        bench.scan(real);
        bench.scan(boolean);
        EXPECT_EQ(real.Value, level ? 1 : 0);
        EXPECT_TRUE(boolean.Valid);
        EXPECT_EQ(boolean.Value, level);
    }
    boolean.ParameterNumber = 2;
    bench.scan(boolean);
    EXPECT_FALSE(boolean.Valid);
    EXPECT_EQ(boolean.ErrorID, ErrorId::invalid_parameter);
}

TEST(WriteParameter, WritesOnceAtTheEdge) {  // P1-215
    Bench bench;
    MC_WriteParameter write{};
    write.Axis = {0};
    write.Execute = true;
    write.ParameterNumber = 9;
    write.Value = 50;
    bench.scan(write);
    EXPECT_TRUE(write.Busy);
    write.Value = 60;
    for (int i = 0; i < 3; ++i) bench.scan(write);
    EXPECT_TRUE(write.Done);
    const auto calls = bench.axes.calls_of("set");
    ASSERT_EQ(calls.size(), 1u);
    EXPECT_EQ(std::get<axes::WriteParameter>(calls[0].setting), (axes::WriteParameter{9, 50}));
}

TEST(WriteParameter, TheBoolBlockWritesBoolsOnly) {  // P1-218
    Bench bench;
    MC_WriteBoolParameter write{};
    write.Axis = {0};
    write.Execute = true;
    write.Value = true;
    write.ParameterNumber = 9;
    bench.scan(write);
    EXPECT_EQ(write.ErrorID, ErrorId::invalid_parameter);
    EXPECT_TRUE(bench.axes.calls.empty());
    write.Execute = false;
    bench.scan(write);
    write.Execute = true;
    write.ParameterNumber = 6;
    bench.scan(write);
    ASSERT_EQ(bench.axes.calls.size(), 1u);
    EXPECT_EQ(std::get<axes::WriteParameter>(bench.axes.calls[0].setting), (axes::WriteParameter{6, 1}));
}

// On a real axis: the whole way, at once and behind a motion.
TEST(WriteParameter, ThroughTheAxisAndBack) {  // P1-215, P1-217
    Plc plc;
    MC_WriteParameter write{};
    MC_MoveAbsolute move{};
    auto read = enabled<MC_ReadParameter>();
    write.Axis = move.Axis = Plc::x;
    read.ParameterNumber = write.ParameterNumber = 9;
    write.Value = 100;
    move.Position = 10;
    move.Velocity = 50;
    plc.program = [&](const MotionContext& ctx) {
        move(ctx);
        write(ctx);
        read(ctx);
    };
    move.Execute = true;
    plc.run_for(3ms);
    write.ExecutionMode = mcQueued;
    write.Execute = true;
    plc.run_for(3ms);
    EXPECT_TRUE(write.Busy);
    EXPECT_EQ(read.Value, 10000);
    ASSERT_LE(plc.run_until([&] { return move.Done; }, 5s), 5s);
    EXPECT_TRUE(write.Done);
    EXPECT_EQ(read.Value, 100);

    write.Execute = false;
    plc.scan();
    write.Value = 20000;  // more than the system's 10000
    write.ExecutionMode = mcImmediately;
    write.Execute = true;
    plc.scan();
    EXPECT_EQ(write.ErrorID, ErrorId::invalid_parameter);
    plc.scan();
    EXPECT_EQ(read.Value, 100);
}

// --- digital points -----------------------------------------------------------------------------------------------------------

TEST(DigitalInput, FollowsTheSelectedBitEachScan) {  // P1-219
    Bench bench;
    const std::array<std::int64_t, 2> low{0, 0}, high{0, 1 << 5};
    auto read = enabled<MC_ReadDigitalInput>();
    read.Input.point = 1;
    read.InputNumber = 5;
    for (const auto* level : {&low, &high, &low, &high}) {
        bench.axes.context.inputs = *level;
        bench.scan(read);
        EXPECT_TRUE(read.Valid);
        EXPECT_EQ(read.Value, level == &high);
    }
    read.InputNumber = 4;
    bench.scan(read);
    EXPECT_FALSE(read.Value) << "another bit";
}

TEST(DigitalInput, OfADrive) {  // P1-219
    Bench bench;
    auto read = enabled<MC_ReadDigitalInput>();
    read.Input.axis = {0};
    read.InputNumber = 31;
    bench.axis.digital_inputs = 0x8000'0000u;
    bench.scan(read);
    EXPECT_TRUE(read.Value);
    bench.axis.online = false;
    bench.scan(read);
    EXPECT_EQ(read.ErrorID, ErrorId::drive_not_ready);
    EXPECT_FALSE(read.Value);
}

TEST(DigitalPoints, NumbersThatDoNotExist) {  // P1-222
    Bench bench;
    std::array<std::int64_t, 1> points{-1};  // all bits on
    bench.axes.context.inputs = points;
    bench.axes.context.outputs = points;
    struct Case {
        std::uint16_t point, axis;
        std::int32_t number;
        ErrorId error;
    };
    constexpr std::uint16_t none = 0xFFFF;
    for (const auto& c :
         {Case{0, none, 63, ErrorId::none}, Case{0, none, 64, ErrorId::invalid_output}, Case{0, none, -1, ErrorId::invalid_output},
          Case{1, none, 0, ErrorId::invalid_output}, Case{none, 0, 31, ErrorId::none}, Case{none, 0, 32, ErrorId::invalid_output},
          Case{none, none, 0, ErrorId::invalid_axis}}) {
        auto input = enabled<MC_ReadDigitalInput>();
        auto output = enabled<MC_ReadDigitalOutput>();
        input.Input = {c.point, {c.axis}};
        output.Output = {c.point, {c.axis}};
        input.InputNumber = output.OutputNumber = c.number;
        bench.scan(input);
        bench.scan(output);
        EXPECT_EQ(input.ErrorID, c.error) << c.number;
        EXPECT_EQ(output.ErrorID, c.error) << c.number;
    }
    MC_WriteDigitalOutput write{};
    write.Execute = true;
    write.Output.point = 0;
    write.OutputNumber = 64;
    bench.scan(write);
    EXPECT_EQ(write.ErrorID, ErrorId::invalid_output);
    EXPECT_EQ(points[0], -1);
}

TEST(DigitalOutput, WritesOneBitOnceAndReadsBack) {  // P1-220, P1-221
    Bench bench;
    std::array<std::int64_t, 1> points{0b100};
    bench.axes.context.outputs = points;
    MC_WriteDigitalOutput write{};
    auto read = enabled<MC_ReadDigitalOutput>();
    write.Output.point = read.Output.point = 0;
    write.OutputNumber = read.OutputNumber = 1;
    write.Value = write.Execute = true;
    bench.scan(write);
    EXPECT_EQ(points[0], 0b110);
    write.Value = false;
    bench.scan(write);
    bench.scan(read);
    EXPECT_TRUE(write.Done);
    EXPECT_EQ(points[0], 0b110) << "at the edge only";
    EXPECT_TRUE(read.Value);
    write.Execute = false;
    bench.scan(write);
    write.Execute = true;
    bench.scan(write);
    bench.scan(read);
    EXPECT_EQ(points[0], 0b100);
    EXPECT_FALSE(read.Value);

    write.Execute = false;
    bench.scan(write);
    write.Execute = true;
    write.ExecutionMode = mcQueued;
    bench.scan(write);
    EXPECT_EQ(write.ErrorID, ErrorId::not_supported) << "a point of the machine has no motion to wait for";
}

TEST(DigitalOutput, OfADriveThroughTheAxis) {  // P1-220, P1-221
    Plc plc;
    plc.drive.caps.digital_outputs = true;
    MC_WriteDigitalOutput write{};
    auto read = enabled<MC_ReadDigitalOutput>();
    write.Output.axis = read.Output.axis = Plc::x;
    write.OutputNumber = read.OutputNumber = 17;
    write.Value = true;
    plc.program = [&](const MotionContext& ctx) {
        write(ctx);
        read(ctx);
    };
    plc.scan();
    EXPECT_FALSE(read.Value);
    write.Execute = true;
    plc.run_for(2ms);
    EXPECT_TRUE(write.Done);
    EXPECT_TRUE(read.Value);
    EXPECT_EQ(plc.drive.last.digital_outputs, 1u << 17);
}

// --- values -------------------------------------------------------------------------------------------------------------------

TEST(ReadActualVelocity, IsSignedAndGoesBackWithEnable) {  // P1-224
    Bench bench;
    auto read = enabled<MC_ReadActualVelocity>();
    for (const double velocity : {12.5, -3.0}) {
        bench.axis.actual_velocity = velocity;
        bench.scan(read);
        EXPECT_TRUE(read.Valid);
        EXPECT_EQ(read.Velocity, velocity);
    }
    read.Enable = false;
    bench.scan(read);
    EXPECT_FALSE(read.Valid);
    EXPECT_EQ(read.Velocity, 0);
}

TEST(ReadActualTorque, IsSignedAndGoesBackWithEnable) {  // P1-225
    Bench bench;
    auto read = enabled<MC_ReadActualTorque>();
    bench.axis.actual_torque = -0.75;
    bench.scan(read);
    EXPECT_TRUE(read.Valid);
    EXPECT_EQ(read.Torque, -0.75);
    read.Enable = false;
    bench.scan(read);
    EXPECT_FALSE(read.Valid);
    EXPECT_EQ(read.Torque, 0);
}

TEST(ReadActualValues, AreAnErrorWithoutFeedback) {
    Bench bench;
    auto velocity = enabled<MC_ReadActualVelocity>();
    auto torque = enabled<MC_ReadActualTorque>();
    bench.axis.online = false;
    bench.scan(velocity);
    bench.scan(torque);
    EXPECT_EQ(velocity.ErrorID, ErrorId::drive_not_ready);
    EXPECT_EQ(torque.ErrorID, ErrorId::drive_not_ready);
}

TEST(ReadCommandValues, AreTheSetPoints) {
    Bench bench;
    bench.axis.set_position = 1;
    bench.axis.set_velocity = -2;
    bench.axis.set_acceleration = 3;
    auto position = enabled<MC_ReadCommandPosition>();
    auto velocity = enabled<MC_ReadCommandVelocity>();
    auto acceleration = enabled<MC_ReadCommandAcceleration>();
    bench.scan(position);
    bench.scan(velocity);
    bench.scan(acceleration);
    EXPECT_EQ(position.Position, 1);
    EXPECT_EQ(velocity.Velocity, -2);
    EXPECT_EQ(acceleration.Acceleration, 3);
}

// --- condition ----------------------------------------------------------------------------------------------------------------

TEST(ReadAxisInfo, EachOutputFollowsItsCause) {  // P1-229
    using axes::PowerState;
    Bench bench;
    auto info = enabled<MC_ReadAxisInfo>();
    const auto shows = [&](bool MC_ReadAxisInfo::*pin, auto cause) {
        bench.axis = {};
        bench.axis.online = true;
        bench.scan(info);
        const bool before = info.*pin;
        cause(bench.axis);
        bench.scan(info);
        return !before && info.*pin;
    };
    EXPECT_TRUE(shows(&MC_ReadAxisInfo::HomeAbsSwitch, [](auto& a) { a.home_switch = true; }));
    EXPECT_TRUE(shows(&MC_ReadAxisInfo::LimitSwitchPos, [](auto& a) { a.positive_limit_switch = true; }));
    EXPECT_TRUE(shows(&MC_ReadAxisInfo::LimitSwitchNeg, [](auto& a) { a.negative_limit_switch = true; }));
    EXPECT_TRUE(shows(&MC_ReadAxisInfo::Simulation, [](auto& a) { a.simulated = true; }));
    EXPECT_TRUE(shows(&MC_ReadAxisInfo::ReadyForPowerOn, [](auto& a) { a.drive_state = PowerState::ready; }));
    EXPECT_TRUE(shows(&MC_ReadAxisInfo::PowerOn, [](auto& a) { a.drive_state = PowerState::enabled; }));
    EXPECT_TRUE(shows(&MC_ReadAxisInfo::IsHomed, [](auto& a) { a.homed = true; }));
    EXPECT_TRUE(shows(&MC_ReadAxisInfo::AxisWarning, [](auto& a) { a.warning = true; }));
    EXPECT_FALSE(shows(&MC_ReadAxisInfo::ReadyForPowerOn, [](auto& a) { a.drive_state = PowerState::fault; }));
    EXPECT_FALSE(shows(&MC_ReadAxisInfo::ReadyForPowerOn, [](auto& a) {
        a.drive_state = PowerState::ready;
        a.state = axes::AxisState::ErrorStop;
    }));
    EXPECT_TRUE(info.CommunicationReady);
    bench.axis.home_switch = true;
    bench.axis.online = false;
    bench.scan(info);
    EXPECT_FALSE(info.CommunicationReady);
    EXPECT_FALSE(info.HomeAbsSwitch) << "an old value is none";
    EXPECT_TRUE(info.Valid);
}

/// What the block says, as one letter each: C A D for the velocity, + - 0 for the direction.
std::string word(const MC_ReadMotionState& state) {
    EXPECT_EQ(state.ConstantVelocity + state.Accelerating + state.Decelerating, 1);
    EXPECT_LE(state.DirectionPositive + state.DirectionNegative, 1);
    return std::string{state.ConstantVelocity ? "C"
                       : state.Accelerating   ? "A"
                                              : "D"} +
           (state.DirectionPositive   ? "+"
            : state.DirectionNegative ? "-"
                                      : "0");
}

/// The words in their order while the axis goes `distance`, each once.
std::vector<std::string> words_of_a_move(MC_Source source, double distance, Duration& first_change) {
    auto config = Plc::roomy_axis();
    config.limits.velocity = 100;
    config.limits.acceleration = config.limits.deceleration = 1000;
    Plc plc{config};
    MC_MoveRelative move{};
    auto state = enabled<MC_ReadMotionState>();
    state.Source = source;
    move.Axis = Plc::x;
    move.Distance = distance;
    move.Velocity = 100;
    std::vector<std::string> words;
    Duration since{};
    plc.program = [&](const MotionContext& ctx) {
        move(ctx);
        state(ctx);
        const auto now = word(state);
        if (words.empty() || words.back() != now) {
            if (words.size() == 1) first_change = since;
            words.push_back(now);
        }
        if (move.Execute) since += 1ms;
    };
    plc.run_for(10ms);
    move.Execute = true;
    plc.run_for(500ms);
    return words;
}

// Trapezoid without jerk limit: 100 ms up, 100 ms constant, 100 ms down. P1-227
TEST(ReadMotionState, OfTheSetPointInBothSenses) {
    Duration first{};
    using Words = std::vector<std::string>;
    const auto up = words_of_a_move(mcSetValue, 20, first), down = words_of_a_move(mcSetValue, -20, first);
    EXPECT_EQ(up, (Words{"C0", "A+", "C+", "D+", "C0"}));
    EXPECT_EQ(down, (Words{"C0", "A-", "C-", "D-", "C0"}));
}

// The actual value follows its set-point later: so do the words. P1-227, P1-228
TEST(ReadMotionState, OfTheActualValueLater) {
    Duration set{}, actual{};
    (void)words_of_a_move(mcSetValue, 20, set);
    const auto words = words_of_a_move(mcActualValue, 20, actual);
    ASSERT_GE(words.size(), 5u);
    EXPECT_EQ(words.front(), "C0");
    EXPECT_EQ(words[1], "A+");
    EXPECT_EQ(words[2], "C+");
    EXPECT_EQ(words[3], "D+");
    EXPECT_EQ(words.back(), "C0");
    EXPECT_GT(actual, set);
}

// Jitter of less than the window is no acceleration; the window is parameter 1012. P1-227
TEST(ReadMotionState, JitterInsideTheWindowIsConstant) {
    Bench bench;
    auto state = enabled<MC_ReadMotionState>();
    state.Source = mcActualValue;
    bench.axis.parameters[axes::place_of(axes::standstill_velocity)] = 0.5;
    for (int i = 0; i < 100; ++i) {
        bench.axis.actual_velocity = 10 + (i % 2 ? 0.4 : 0.0);
        bench.scan(state);
        ASSERT_TRUE(state.ConstantVelocity);
        ASSERT_TRUE(state.DirectionPositive);
    }
    bench.axis.actual_velocity = 0.4;
    for (int i = 0; i < 100; ++i) bench.scan(state);
    EXPECT_FALSE(state.DirectionPositive) << "standing";
    EXPECT_TRUE(state.ConstantVelocity);
}

}  // namespace
}  // namespace taktwerk::fb
