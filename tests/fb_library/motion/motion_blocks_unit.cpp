// What each motion block asks of its axis and makes of the answers. Rules common to all: tests/fb_library/block_rules_unit.cpp.
#include <gtest/gtest.h>

#include <limits>

#include "fb_library/all_blocks.hpp"
#include "tests/fb_library/fake_axes.hpp"

namespace taktwerk::fb {
namespace {

using axes::AxisState;
using axes::CommandKind;
using axes::Outcome;
using namespace std::chrono_literals;

template <class Block>
struct MotionBench : testing::Test {
    MotionBench() { block.Axis = {0}; }
    void scan() {
        axes.next_scan();
        block(axes.context);
    }
    const FakeAxes::Call& last() const { return axes.calls.back(); }
    std::size_t count(const char* what) const { return axes.calls_of(what).size(); }

    FakeAxes axes{2};
    Block block{};
};

// --- MC_MoveAbsolute, MC_MoveRelative, MC_MoveVelocity, MC_Home, MC_Halt: the command is the value of the pins ------------

using MoveAbsolute = MotionBench<MC_MoveAbsolute>;
TEST_F(MoveAbsolute, CommandsWhatThePinsSay) {
    block.Execute = true;
    block.Position = -12.5, block.Velocity = 3, block.Acceleration = 4, block.Deceleration = 5, block.Jerk = 6;
    block.Direction = mcShortestWay;
    block.BufferMode = mcBuffered;
    scan();
    const auto& c = last().command;
    EXPECT_EQ(c.kind, CommandKind::move_absolute);
    EXPECT_EQ(c.position, -12.5);
    EXPECT_EQ(c.velocity, 3);
    EXPECT_EQ(c.acceleration, 4);
    EXPECT_EQ(c.deceleration, 5);
    EXPECT_EQ(c.jerk, 6);
    EXPECT_EQ(c.direction, mcShortestWay);
    EXPECT_EQ(c.buffer_mode, mcBuffered);
}

TEST_F(MoveAbsolute, AbortsByDefault) {  // P1-085
    block.Execute = true;
    block.Velocity = 1;
    scan();
    EXPECT_EQ(last().command.buffer_mode, mcAborting);
}

// P1-016: two aborting commands in one scan: the later call wins.
TEST_F(MoveAbsolute, OfTwoInOneScanTheLaterWins) {
    MC_MoveAbsolute other;
    other.Axis = {0};
    block.Execute = other.Execute = true;
    block(axes.context);
    other(axes.context);
    axes.next_scan();
    block(axes.context);
    other(axes.context);
    EXPECT_TRUE(block.CommandAborted);
    EXPECT_TRUE(other.Active);
}

using MoveModulo = MotionBench<MC_MoveModulo>;
TEST_F(MoveModulo, CommandsAnAbsoluteMoveWithWholeTurns) {
    block.Execute = true;
    block.Position = 450, block.Velocity = 3, block.Acceleration = 4, block.Deceleration = 5, block.Jerk = 6;
    block.Direction = mcNegativeDirection;
    block.BufferMode = mcBuffered;
    scan();
    const auto& c = last().command;
    EXPECT_EQ(c.kind, CommandKind::move_absolute);
    EXPECT_TRUE(std::holds_alternative<axes::WholeTurns>(c.details));
    EXPECT_EQ(c.position, 450);
    EXPECT_EQ(c.velocity, 3);
    EXPECT_EQ(c.acceleration, 4);
    EXPECT_EQ(c.deceleration, 5);
    EXPECT_EQ(c.jerk, 6);
    EXPECT_EQ(c.direction, mcNegativeDirection);
    EXPECT_EQ(c.buffer_mode, mcBuffered);
}

using MoveRelative = MotionBench<MC_MoveRelative>;
TEST_F(MoveRelative, CommandsWhatThePinsSay) {
    block.Execute = true;
    block.Distance = -7, block.Velocity = 3, block.Acceleration = 4, block.Deceleration = 5, block.Jerk = 6;
    block.BufferMode = mcBuffered;
    scan();
    const auto& c = last().command;
    EXPECT_EQ(c.kind, CommandKind::move_relative);
    EXPECT_EQ(c.position, -7);
    EXPECT_EQ(c.velocity, 3);
    EXPECT_EQ(c.acceleration, 4);
    EXPECT_EQ(c.deceleration, 5);
    EXPECT_EQ(c.jerk, 6);
    EXPECT_EQ(c.buffer_mode, mcBuffered);
}

using MoveVelocity = MotionBench<MC_MoveVelocity>;
TEST_F(MoveVelocity, CommandsWhatThePinsSay) {
    block.Execute = true;
    block.Velocity = -3, block.Acceleration = 4, block.Deceleration = 5, block.Jerk = 6;
    block.Direction = mcNegativeDirection;
    block.BufferMode = mcBuffered;
    scan();
    const auto& c = last().command;
    EXPECT_EQ(c.kind, CommandKind::move_velocity);
    EXPECT_EQ(c.velocity, -3);
    EXPECT_EQ(c.acceleration, 4);
    EXPECT_EQ(c.deceleration, 5);
    EXPECT_EQ(c.jerk, 6);
    EXPECT_EQ(c.direction, mcNegativeDirection);
    EXPECT_EQ(c.buffer_mode, mcBuffered);
}

// Figure 8, case 3 and P1-070, P1-071: InVelocity rises after Execute fell, may toggle, and Busy and Active stay.
TEST_F(MoveVelocity, InVelocityFollowsTheAxisWhileTheBlockControlsIt) {
    block.Execute = true;
    block.Velocity = 10;
    scan();
    block.Execute = false;
    scan();
    EXPECT_TRUE(block.Active);
    EXPECT_FALSE(block.InVelocity);

    for (const bool reached : {true, false, true}) {
        axes.axis().active_in_target = reached;
        scan();
        EXPECT_EQ(block.InVelocity, reached);
        EXPECT_TRUE(block.Busy);
        EXPECT_TRUE(block.Active);
    }

    axes.take_over();
    scan();
    EXPECT_FALSE(block.InVelocity);
    EXPECT_TRUE(block.CommandAborted);
    scan();
    EXPECT_FALSE(block.CommandAborted) << "one call, as Execute is FALSE";
}

// P1-111, P1-112 (our choice): InVelocity falls with the new edge, also when the velocity is the same.
TEST_F(MoveVelocity, ANewEdgeTakesInVelocityBack) {
    block.Execute = true;
    block.Velocity = 10;
    scan();
    axes.axis().active_in_target = true;
    scan();
    ASSERT_TRUE(block.InVelocity);
    block.Execute = false;
    scan();
    block.Execute = true;
    scan();
    EXPECT_FALSE(block.InVelocity);
    EXPECT_TRUE(block.Busy);
}

using Home = MotionBench<MC_Home>;
TEST_F(Home, CommandsTheReferencesCoordinate) {
    block.Execute = true;
    block.Position = 123.5;
    block.BufferMode = mcBuffered;
    scan();
    EXPECT_EQ(last().command.kind, CommandKind::home);
    EXPECT_EQ(last().command.position, 123.5);
    EXPECT_EQ(last().command.buffer_mode, mcBuffered);
}

using Halt = MotionBench<MC_Halt>;
TEST_F(Halt, CommandsWhatThePinsSay) {
    block.Execute = true;
    block.Deceleration = 5, block.Jerk = 6;
    block.BufferMode = mcBuffered;
    scan();
    EXPECT_EQ(last().command.kind, CommandKind::halt);
    EXPECT_EQ(last().command.deceleration, 5);
    EXPECT_EQ(last().command.jerk, 6);
    EXPECT_EQ(last().command.buffer_mode, mcBuffered);
}

// --- MC_Stop -------------------------------------------------------------------------------------------------------------

using Stop = MotionBench<MC_Stop>;
TEST_F(Stop, HoldsTheLockUntilExecuteFalls) {  // P1-128, figure 15, case "held"
    block.Execute = true;
    block.Deceleration = 20, block.Jerk = 6;
    scan();
    EXPECT_EQ(last().command.kind, CommandKind::stop);
    EXPECT_EQ(last().command.deceleration, 20);
    EXPECT_EQ(last().command.jerk, 6);
    const auto id = last().id;

    axes.axis().active_in_target = true;  // it stands, the lock holds
    scan();
    EXPECT_TRUE(block.Done);
    EXPECT_EQ(count("release_stop"), 0u);

    block.Execute = false;
    scan();
    EXPECT_FALSE(block.Done);
    ASSERT_EQ(count("release_stop"), 1u);
    EXPECT_EQ(last().id, id);
    scan();
    EXPECT_EQ(count("release_stop"), 1u);
}

TEST_F(Stop, ReleasedDuringTheRampIsDoneForOneCallAtStandstill) {  // P1-128, figure 15, case "short"
    block.Execute = true;
    scan();
    block.Execute = false;
    scan();
    EXPECT_EQ(count("release_stop"), 1u);
    EXPECT_TRUE(block.Busy);

    axes.finish(Outcome::done);
    scan();
    EXPECT_TRUE(block.Done);
    scan();
    EXPECT_FALSE(block.Done);
}

TEST_F(Stop, ReleasesTheAxisItStoppedThoughThePinHasChanged) {
    block.Execute = true;
    scan();
    block.Axis = {1};
    block.Execute = false;
    scan();
    EXPECT_EQ(last().what, "release_stop");
    EXPECT_EQ(last().axis.index, 0);
}

TEST_F(Stop, ARefusedStopReleasesNothing) {
    axes.refuse_with = ErrorId::not_powered;
    block.Execute = true;
    scan();
    block.Execute = false;
    scan();
    EXPECT_EQ(count("release_stop"), 0u);
}

// --- MC_Power ------------------------------------------------------------------------------------------------------------

using Power = MotionBench<MC_Power>;
TEST_F(Power, StatusIsThePowerStagesNotEnables) {  // P1-114, P1-115
    axes.axis().powered = false;
    block.Enable = true;
    scan();
    EXPECT_FALSE(block.Status);
    EXPECT_TRUE(block.Valid);
    axes.axis().powered = true;
    scan();
    EXPECT_TRUE(block.Status);
    block.Enable = false;
    scan();
    EXPECT_TRUE(block.Status) << "the stage is still on";
    EXPECT_FALSE(block.Valid);
    axes.axis().powered = false;
    scan();
    EXPECT_FALSE(block.Status);
}

TEST_F(Power, RenewsItsWishInEachCallAndTakesItBackOnce) {
    scan();
    EXPECT_EQ(count("power"), 0u) << "Enable was never TRUE: no wish";
    block.Enable = true;
    scan();
    scan();
    EXPECT_EQ(count("power"), 2u);
    EXPECT_TRUE(last().enable);
    block.Enable = false;
    scan();
    scan();
    EXPECT_EQ(count("power"), 3u);
    EXPECT_FALSE(last().enable);
}

TEST_F(Power, PassesThePermittedDirectionsAsLevels) {  // P1-119
    block.Enable = true;
    scan();
    EXPECT_TRUE(last().positive);
    EXPECT_TRUE(last().negative);
    block.EnablePositive = false;
    scan();
    EXPECT_FALSE(last().positive);
    EXPECT_TRUE(last().negative);
    block.EnableNegative = false;
    scan();
    EXPECT_FALSE(last().negative);
}

TEST_F(Power, ShowsAConflictAsLongAsItLasts) {  // P1-120
    axes.refuse_with = ErrorId::power_conflict;
    block.Enable = true;
    scan();
    EXPECT_TRUE(block.Error);
    EXPECT_FALSE(block.Valid);
    EXPECT_EQ(block.ErrorID, ErrorId::power_conflict);
    axes.refuse_with = ErrorId::none;
    scan();
    EXPECT_FALSE(block.Error);
    EXPECT_TRUE(block.Valid);
}

TEST_F(Power, StaysWithTheAxisOfTheEdge) {
    block.Enable = true;
    scan();
    block.Axis = {1};
    scan();
    EXPECT_EQ(last().axis.index, 0);
    block.Enable = false;
    scan();
    EXPECT_EQ(last().axis.index, 0);
    EXPECT_FALSE(last().enable);
    block.Enable = true;
    scan();
    EXPECT_EQ(last().axis.index, 1);
}

// --- MC_Reset ------------------------------------------------------------------------------------------------------------

using Reset = MotionBench<MC_Reset>;
TEST_F(Reset, IsDoneWhenTheAxisHasLeftErrorStop) {  // P1-231
    for (const AxisState after : {AxisState::Standstill, AxisState::Disabled}) {
        axes.axis().state = AxisState::ErrorStop;
        block.Execute = false;
        scan();
        block.Execute = true;
        scan();
        EXPECT_TRUE(block.Busy);
        axes.axis().state = after;
        scan();
        EXPECT_TRUE(block.Done);
    }
    EXPECT_EQ(count("reset"), 2u);
}

TEST_F(Reset, OutsideErrorStopIsDoneAtOnce) {  // P1-233, our choice
    block.Execute = true;
    scan();
    EXPECT_TRUE(block.Done);
    EXPECT_EQ(count("reset"), 1u);
}

TEST_F(Reset, FailsWhenTheAxisGivesUp) {  // P1-234
    axes.axis().state = AxisState::ErrorStop;
    block.Execute = true;
    scan();
    axes.axis().resetting = true;
    scan();
    EXPECT_TRUE(block.Busy);
    axes.axis().resetting = false;
    axes.axis().reset_error = ErrorId::reset_failed;
    scan();
    EXPECT_EQ(block.ErrorID, ErrorId::reset_failed);
    EXPECT_FALSE(block.Done);
}

TEST_F(Reset, IgnoresTheAnswerToAnEarlierReset) {
    axes.axis().state = AxisState::ErrorStop;
    axes.axis().reset_error = ErrorId::reset_failed;
    block.Execute = true;
    scan();
    EXPECT_TRUE(block.Busy);
    scan();
    EXPECT_TRUE(block.Busy);
}

TEST_F(Reset, FailsAfterABoundedTimeWithoutAnyAnswer) {
    axes.axis().state = AxisState::ErrorStop;
    block.Execute = true;
    scan();
    axes.next_scan(MC_Reset::patience - 1ns);
    block(axes.context);
    EXPECT_TRUE(block.Busy);
    axes.next_scan(1ns);
    block(axes.context);
    EXPECT_EQ(block.ErrorID, ErrorId::reset_failed);
}

// --- MC_SetPosition ------------------------------------------------------------------------------------------------------

using SetPosition = MotionBench<MC_SetPosition>;
TEST_F(SetPosition, ShiftsOnceAndIsDoneInTheNextScan) {
    block.Execute = true;
    block.Position = 4.5;
    scan();
    EXPECT_TRUE(block.Busy);
    EXPECT_EQ(last().what, "set");
    EXPECT_EQ(last().setting, axes::AxisSetting(axes::SetPosition{4.5, false}));
    scan();
    EXPECT_TRUE(block.Done);
    scan();
    EXPECT_EQ(count("set"), 1u);
}

TEST_F(SetPosition, PassesRelative) {
    block.Execute = true;
    block.Relative = true;
    scan();
    EXPECT_EQ(last().setting, axes::AxisSetting(axes::SetPosition{0, true}));
}

TEST_F(SetPosition, QueuedItIsDoneWhenItsTurnCame) {  // P1-201
    axes.take_over();                                 // a motion runs
    block.Execute = true;
    block.Position = 4.5;
    block.ExecutionMode = mcQueued;
    scan();
    EXPECT_EQ(last().what, "submit");
    EXPECT_EQ(std::get<axes::AxisSetting>(last().command.details), axes::AxisSetting(axes::SetPosition{4.5, false}));
    scan();
    EXPECT_TRUE(block.Busy);
    axes.finish(Outcome::done);  // the motion
    scan();
    EXPECT_FALSE(block.Done);
    axes.finish(Outcome::done);
    scan();
    EXPECT_TRUE(block.Done);
    EXPECT_EQ(count("set"), 0u);
}

// --- reading -------------------------------------------------------------------------------------------------------------

using ReadStatus = MotionBench<MC_ReadStatus>;
TEST_F(ReadStatus, ShowsExactlyTheAxisState) {  // P1-226
    const std::pair<AxisState, bool MC_ReadStatus::*> states[] = {
        {AxisState::Disabled, &MC_ReadStatus::Disabled},
        {AxisState::Standstill, &MC_ReadStatus::Standstill},
        {AxisState::Homing, &MC_ReadStatus::Homing},
        {AxisState::DiscreteMotion, &MC_ReadStatus::DiscreteMotion},
        {AxisState::ContinuousMotion, &MC_ReadStatus::ContinuousMotion},
        {AxisState::SynchronizedMotion, &MC_ReadStatus::SynchronizedMotion},
        {AxisState::Stopping, &MC_ReadStatus::Stopping},
        {AxisState::ErrorStop, &MC_ReadStatus::ErrorStop},
    };
    static_assert(std::size(states) == axes::axis_state_count);
    block.Enable = true;
    for (const auto& [state, own] : states) {
        axes.axis().state = state;
        scan();
        for (const auto& [_, pin] : states) EXPECT_EQ(block.*pin, pin == own) << static_cast<int>(state);
    }
}

using ReadActualPosition = MotionBench<MC_ReadActualPosition>;
TEST_F(ReadActualPosition, FollowsTheFeedback) {  // P1-223, P1-079
    block.Enable = true;
    for (const double position : {1.0, -2.5}) {
        axes.axis().actual_position = position;
        scan();
        EXPECT_TRUE(block.Valid);
        EXPECT_EQ(block.Position, position);
    }
}

TEST_F(ReadActualPosition, AnOldValueIsNotShownAndValidComesBackByItself) {  // P1-049, P1-080
    block.Enable = true;
    axes.axis().actual_position = 3;
    scan();
    axes.axis().online = false;
    scan();
    EXPECT_FALSE(block.Valid);
    EXPECT_TRUE(block.Busy);
    EXPECT_EQ(block.ErrorID, ErrorId::drive_not_ready);
    EXPECT_EQ(block.Position, 0);
    axes.axis().online = true;
    scan();
    EXPECT_TRUE(block.Valid);
    EXPECT_FALSE(block.Error);
    EXPECT_EQ(block.Position, 3);
}

using ReadAxisError = MotionBench<MC_ReadAxisError>;
TEST_F(ReadAxisError, ShowsTheAxisErrorAndIsItselfValid) {  // P1-230
    block.Enable = true;
    axes.axis().state = AxisState::ErrorStop;
    axes.axis().error = 0x3004;
    scan();
    EXPECT_EQ(block.AxisErrorID, 0x3004);
    EXPECT_TRUE(block.Valid);
    EXPECT_FALSE(block.Error);
}

TEST_F(ReadAxisError, IsZeroOutsideErrorStop) {
    block.Enable = true;
    axes.axis().error = static_cast<std::uint16_t>(ErrorId::invalid_velocity);  // some block's command was refused
    scan();
    EXPECT_TRUE(block.Valid);
    EXPECT_EQ(block.AxisErrorID, 0);
}

}  // namespace
}  // namespace taktwerk::fb
