// Endless moves, torque, profiles over time, fed set-points, the drive's mode: what the blocks ask of the axis and make of its view.
#include "tests/fb_library/motion/one_block.hpp"

namespace taktwerk::fb {
namespace {

using axes::CommandKind;
using axes::Outcome;

using MoveAdditive = OneBlock<MC_MoveAdditive>;
TEST_F(MoveAdditive, CommandsWhatThePinsSay) {
    block.Axis = {1};
    block.Distance = -7, block.Velocity = 3, block.Acceleration = 4, block.Deceleration = 5, block.Jerk = 6;
    block.BufferMode = mcBlendingHigh;
    block.Execute = true;
    scan();
    const auto& c = last().command;
    EXPECT_EQ(last().axis.index, 1);
    EXPECT_EQ(c.kind, CommandKind::move_additive);
    EXPECT_EQ(c.position, -7);
    EXPECT_EQ(c.velocity, 3);
    EXPECT_EQ(c.acceleration, 4);
    EXPECT_EQ(c.deceleration, 5);
    EXPECT_EQ(c.jerk, 6);
    EXPECT_EQ(c.buffer_mode, mcBlendingHigh);
}

using MoveContinuousAbsolute = OneBlock<MC_MoveContinuousAbsolute>;
TEST_F(MoveContinuousAbsolute, CommandsWhatThePinsSay) {
    block.Axis = {0};
    block.Position = 100, block.EndVelocity = -20, block.Velocity = 50, block.Acceleration = 4, block.Deceleration = 5, block.Jerk = 6;
    block.Direction = mcNegativeDirection;
    block.BufferMode = mcBuffered;
    block.Execute = true;
    scan();
    const auto& c = last().command;
    EXPECT_EQ(c.kind, CommandKind::move_continuous_absolute);
    EXPECT_EQ(c.position, 100);
    EXPECT_EQ(c.end_velocity, -20);
    EXPECT_EQ(c.velocity, 50);
    EXPECT_EQ(c.acceleration, 4);
    EXPECT_EQ(c.deceleration, 5);
    EXPECT_EQ(c.jerk, 6);
    EXPECT_EQ(c.direction, mcNegativeDirection);
    EXPECT_EQ(c.buffer_mode, mcBuffered);
}

using MoveContinuousRelative = OneBlock<MC_MoveContinuousRelative>;
TEST_F(MoveContinuousRelative, CommandsWhatThePinsSay) {
    block.Axis = {0};
    block.Distance = 100, block.EndVelocity = 20, block.Velocity = 50;
    block.Execute = true;
    scan();
    const auto& c = last().command;
    EXPECT_EQ(c.kind, CommandKind::move_continuous_relative);
    EXPECT_EQ(c.position, 100);
    EXPECT_EQ(c.end_velocity, 20);
    EXPECT_EQ(c.velocity, 50);
}

using TorqueControl = OneBlock<MC_TorqueControl>;
TEST_F(TorqueControl, CommandsWhatThePinsSay) {
    block.Axis = {0};
    block.Torque = -0.5, block.TorqueRamp = 2, block.Velocity = 30, block.Acceleration = 4, block.Deceleration = 5, block.Jerk = 6;
    block.Direction = mcNegativeDirection;
    block.Execute = true;
    scan();
    const auto& c = last().command;
    EXPECT_EQ(c.kind, CommandKind::torque);
    EXPECT_EQ(c.velocity, 30);
    EXPECT_EQ(c.acceleration, 4);
    EXPECT_EQ(c.deceleration, 5);
    EXPECT_EQ(c.jerk, 6);
    EXPECT_EQ(c.direction, mcNegativeDirection);
    EXPECT_EQ(details<axes::TorqueDetails>(), (axes::TorqueDetails{-0.5, 2}));
}

using PositionProfile = OneBlock<MC_PositionProfile>;
TEST_F(PositionProfile, CommandsWhatThePinsSayAndIsDoneAtItsEnd) {  // P1-191
    block.Axis = {0};
    block.TimePosition = TimeTableRef{3};
    block.TimeScale = 2, block.PositionScale = 3, block.Offset = 4;
    begin();
    EXPECT_EQ(last().command.kind, CommandKind::position_profile);
    EXPECT_EQ(details<axes::TimeProfileDetails>(), (axes::TimeProfileDetails{{3}, 2, 3, 4}));
    axes.finish(Outcome::done);
    scan();
    EXPECT_TRUE(block.Done);
}

using VelocityProfile = OneBlock<MC_VelocityProfile>;
TEST_F(VelocityProfile, KeepsTheAxisAfterItsLastRow) {  // P1-193
    block.Axis = {0};
    block.TimeVelocity = TimeTableRef{3};
    block.VelocityScale = 3, block.Offset = 4;
    begin();
    EXPECT_EQ(last().command.kind, CommandKind::velocity_profile);
    EXPECT_EQ(details<axes::TimeProfileDetails>(), (axes::TimeProfileDetails{{3}, 1, 3, 4}));
    axes.axis().active_in_target = true;
    scan();
    EXPECT_TRUE(block.ProfileCompleted);
    EXPECT_TRUE(block.Active);
    axes.take_over();
    scan();
    EXPECT_FALSE(block.ProfileCompleted);
    EXPECT_TRUE(block.CommandAborted);
}

using AccelerationProfile = OneBlock<MC_AccelerationProfile>;
TEST_F(AccelerationProfile, CommandsWhatThePinsSay) {
    block.Axis = {0};
    block.TimeAcceleration = TimeTableRef{5};
    block.TimeScale = 0.5, block.AccelerationScale = 3, block.Offset = 4;
    begin();
    EXPECT_EQ(last().command.kind, CommandKind::acceleration_profile);
    EXPECT_EQ(details<axes::TimeProfileDetails>(), (axes::TimeProfileDetails{{5}, 0.5, 3, 4}));
}

using ExternalEnable = OneBlock<MC_ExtSetPointGenEnable>;
TEST_F(ExternalEnable, TakesTheAxisUntilAnotherCommandDoes) {
    block.Axis = {0};
    begin();
    EXPECT_EQ(last().command.kind, CommandKind::external);
    EXPECT_TRUE(block.Active);
    axes.axis().active_in_target = true;
    scan();
    EXPECT_TRUE(block.Enabled);
    axes.take_over();
    scan();
    EXPECT_FALSE(block.Enabled);
    EXPECT_TRUE(block.CommandAborted);
}

TEST(ExternalFeed, GivesASetPointInEachCallWhileEnabled) {
    FakeAxes axes;
    MC_ExtSetPointGenFeed feed;
    feed.Axis = {0};
    feed.Enable = true;
    for (int i = 0; i < 3; ++i) {
        axes.next_scan();
        feed.Position = i, feed.Velocity = 10 * i, feed.Acceleration = -i;
        feed(axes.context);
        EXPECT_TRUE(feed.Valid);
        EXPECT_EQ(axes.calls.back().setting, axes::AxisSetting(axes::SetpointFeed{double(i), 10.0 * i, double(-i)}));
    }
    EXPECT_EQ(axes.calls.size(), 3u);
    axes.refuse_with = ErrorId::state_forbids;  // another command has the axis
    feed(axes.context);
    EXPECT_EQ(feed.ErrorID, ErrorId::state_forbids);
    EXPECT_TRUE(feed.Busy) << "it may come back";
    feed.Enable = false;
    feed(axes.context);
    EXPECT_FALSE(feed.Error);
    EXPECT_EQ(axes.calls.size(), 4u);
}

using ExternalDisable = OneBlock<MC_ExtSetPointGenDisable>;
TEST_F(ExternalDisable, HaltsAnAxisThatIsFed) {
    block.Axis = {0};
    block.Deceleration = 5, block.Jerk = 6;
    axes.axis().active_kind = CommandKind::external;
    begin();
    EXPECT_EQ(last().command.kind, CommandKind::halt);
    EXPECT_EQ(last().command.deceleration, 5);
    EXPECT_EQ(last().command.jerk, 6);
    axes.finish(Outcome::done);
    scan();
    EXPECT_TRUE(block.Done);
}

TEST_F(ExternalDisable, LeavesAnyOtherMotionAlone) {
    block.Axis = {0};
    axes.axis().active_kind = CommandKind::move_velocity;
    begin();
    EXPECT_EQ(block.ErrorID, ErrorId::state_forbids);
    EXPECT_TRUE(axes.calls.empty());
}

using TorqueLimitBlock = OneBlock<MC_SetTorqueLimit>;
TEST_F(TorqueLimitBlock, GivesBothLimitsAsTheyStand) {
    block.Axis = {0};
    block.PositiveLimit = 0.5;
    block.NegativeLimit = 0.3;
    block.Execute = true;
    scan();
    EXPECT_EQ(last().command.kind, CommandKind::set_torque_limit);
    const auto* limits = std::get_if<axes::TorqueLimitDetails>(&last().command.details);
    ASSERT_NE(limits, nullptr);
    EXPECT_EQ(*limits, (axes::TorqueLimitDetails{0.5, 0.3}));
    EXPECT_TRUE(block.Busy);
}

using ControllerMode = OneBlock<MC_SetControllerMode>;
TEST_F(ControllerMode, NamesTheDrivesMode) {
    block.Axis = {0};
    for (const auto& [mode, drive] :
         {std::pair{mcPositionControl, axes::DriveMode::cyclic_position}, std::pair{mcVelocityControl, axes::DriveMode::cyclic_velocity},
          std::pair{mcTorqueControl, axes::DriveMode::cyclic_torque}}) {
        block.Execute = false;
        scan();
        block.Mode = mode;
        block.Execute = true;
        scan();
        EXPECT_EQ(last().command.kind, CommandKind::set_controller_mode);
        EXPECT_EQ(last().command.position, static_cast<double>(drive));
    }
}

}  // namespace
}  // namespace taktwerk::fb
