// The blocks of PLCopen Part 5: their pins, and what they ask of the axis. The rules that every block keeps are in block_rules_unit.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "fb_library/all_blocks.hpp"
#include "fb_library/block_types.hpp"
#include "tests/fb_library/fake_axes.hpp"
#include "tests/fb_library/part5_pins.hpp"

namespace taktwerk::fb {
namespace {

using namespace std::chrono_literals;

TEST(HomingPins, HaveEveryPinOfPart5AndNoOther) {
    std::map<std::string_view, std::vector<part1::StandardPin>> standard;
    for (const auto& pin : part5::pins) standard[pin.block].push_back(pin);
    EXPECT_EQ(standard.size(), 11u);
    ASSERT_EQ(homing_block_types().size(), 11u);
    for (const BlockType& type : homing_block_types()) {
        const auto& expected = standard[type.name];
        ASSERT_EQ(type.pins.size(), expected.size()) << type.name;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const auto& pin = type.pins[i];
            const auto direction = expected[i].kind == part1::VAR_INPUT    ? PinDirection::in
                                   : expected[i].kind == part1::VAR_OUTPUT ? PinDirection::out
                                                                           : PinDirection::in_out;
            EXPECT_EQ(pin.name, expected[i].name) << type.name;
            EXPECT_EQ(pin.direction, direction) << type.name << '.' << pin.name;
            std::string wanted{expected[i].type};
            if (wanted == "REAL") wanted = "LREAL";
            if (wanted == "MC_REF_SIGNAL") wanted = "MC_REF_SIGNAL_REF";
            EXPECT_EQ(pin.type.name, wanted) << type.name << '.' << pin.name;
        }
    }
}

// The values as PLCopen spells them, in its order.
TEST(HomingPins, EnumerationsAreThoseOfPart5) {
    const auto values = [](const char* block, const char* pin) {
        std::string text;
        for (const auto name : find_block_type(block)->pin(pin)->type.values) text += (text.empty() ? "" : " ") + std::string{name};
        return text;
    };
    EXPECT_EQ(values("MC_StepAbsoluteSwitch", "Direction"), "mcPositiveDirection mcNegativeDirection mcSwitchPositive mcSwitchNegative");
    EXPECT_EQ(values("MC_StepAbsoluteSwitch", "SwitchMode"),
              "mcOn mcOff mcRisingEdge mcFallingEdge mcEdgeSwitchPositive mcEdgeSwitchNegative");
    EXPECT_EQ(static_cast<int>(MC_HomeDirection::mcSwitchNegative), 3);
    EXPECT_EQ(static_cast<int>(MC_SwitchMode::mcEdgeSwitchNegative), 5);
}

template <class Block>
axes::AxisCommand submitted(Block block) {
    FakeAxes axes;
    block.Axis = {0};
    block.Execute = true;
    block(axes.context);
    EXPECT_EQ(axes.calls.size(), 1u);
    return axes.calls.empty() ? axes::AxisCommand{} : axes.calls[0].command;
}

TEST(HomingBlocks, GiveTheAxisAllTheyWereGiven) {
    MC_StepAbsoluteSwitch at_switch;
    at_switch.Direction = MC_HomeDirection::mcSwitchNegative;
    at_switch.SwitchMode = MC_SwitchMode::mcEdgeSwitchPositive;
    at_switch.ReferenceSignal = {{.source = axes::TriggerSource::input, .point = 3, .bit = 1}};
    at_switch.Velocity = 5;
    at_switch.Acceleration = 6;
    at_switch.Deceleration = 7;
    at_switch.Jerk = 8;
    at_switch.SetPosition = 9;
    at_switch.TorqueLimit = 0.5;
    at_switch.TimeLimit = 10s;
    at_switch.DistanceLimit = 11;
    at_switch.BufferMode = mcBuffered;
    const axes::HomingStepDetails details{.step = axes::HomingStep::absolute_switch,
                                          .direction = MC_HomeDirection::mcSwitchNegative,
                                          .switch_mode = MC_SwitchMode::mcEdgeSwitchPositive,
                                          .reference = {.source = axes::TriggerSource::input, .point = 3, .bit = 1},
                                          .set_position = 9,
                                          .torque_limit = 0.5,
                                          .time_limit = 10s,
                                          .distance_limit = 11};
    const axes::AxisCommand expected{.kind = axes::CommandKind::homing_step,
                                     .buffer_mode = mcBuffered,
                                     .velocity = 5,
                                     .acceleration = 6,
                                     .deceleration = 7,
                                     .jerk = 8,
                                     .details = details};
    EXPECT_EQ(submitted(at_switch), expected);

    MC_StepBlock at_block;
    at_block.DetectionVelocityLimit = 2;
    at_block.DetectionVelocityTime = 30ms;
    at_block.TorqueLimit = 0.2;
    const auto block = std::get<axes::HomingStepDetails>(submitted(at_block).details);
    EXPECT_EQ(block.detection_velocity_limit, 2);
    EXPECT_EQ(block.detection_velocity_time, 30ms);
    EXPECT_EQ(block.torque_limit, 0.2);

    MC_StepLimitSwitch at_limit;
    at_limit.LimitSwitchMode = MC_SwitchMode::mcFallingEdge;
    EXPECT_EQ(std::get<axes::HomingStepDetails>(submitted(at_limit).details).switch_mode, MC_SwitchMode::mcFallingEdge);

    MC_FinishHoming finish;
    finish.Distance = -4;
    EXPECT_EQ(submitted(finish).position, -4);
}

TEST(HomingBlocks, EachIsItsOwnStepWithItsOwnReference) {
    const auto step_of = [](const auto& block) { return std::get<axes::HomingStepDetails>(submitted(block).details).step; };
    const auto reference_of = [](const auto& block) {
        return std::get<axes::HomingStepDetails>(submitted(block).details).reference.source;
    };
    using axes::HomingStep;
    EXPECT_EQ(step_of(MC_StepLimitSwitch{}), HomingStep::limit_switch);
    EXPECT_EQ(step_of(MC_StepBlock{}), HomingStep::block);
    EXPECT_EQ(step_of(MC_StepReferencePulse{}), HomingStep::reference_pulse);
    EXPECT_EQ(step_of(MC_StepDistanceCoded{}), HomingStep::distance_coded);
    EXPECT_EQ(step_of(MC_HomeDirect{}), HomingStep::direct);
    EXPECT_EQ(step_of(MC_HomeAbsolute{}), HomingStep::absolute);
    EXPECT_EQ(step_of(MC_FinishHoming{}), HomingStep::finish);
    EXPECT_EQ(step_of(MC_StepReferenceFlyingSwitch{}), HomingStep::flying_switch);
    EXPECT_EQ(step_of(MC_StepReferenceFlyingRefPulse{}), HomingStep::flying_reference_pulse);
    EXPECT_EQ(submitted(MC_AbortPassiveHoming{}).kind, axes::CommandKind::abort_passive_homing);
    EXPECT_EQ(reference_of(MC_StepAbsoluteSwitch{}), axes::TriggerSource::home_switch);
    EXPECT_EQ(reference_of(MC_StepReferenceFlyingSwitch{}), axes::TriggerSource::home_switch);
    EXPECT_EQ(reference_of(MC_StepReferencePulse{}), axes::TriggerSource::index_pulse);
    EXPECT_EQ(reference_of(MC_StepReferenceFlyingRefPulse{}), axes::TriggerSource::index_pulse);
}

}  // namespace
}  // namespace taktwerk::fb
