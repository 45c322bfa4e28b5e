// What lies over the axis' own motion: superimposed moves, override.
#include "tests/fb_library/motion/one_block.hpp"

namespace taktwerk::fb {
namespace {

using axes::CommandKind;
using axes::Outcome;
using axes::SideSlot;

using MoveSuperimposed = OneBlock<MC_MoveSuperimposed>;
TEST_F(MoveSuperimposed, CommandsWhatThePinsSay) {
    block.Axis = {1};
    block.Distance = -7, block.VelocityDiff = 3, block.Acceleration = 4, block.Deceleration = 5, block.Jerk = 6;
    block.Execute = true;
    scan();
    EXPECT_EQ(last().axis.index, 1);
    const auto& c = last().command;
    EXPECT_EQ(c.kind, CommandKind::move_superimposed);
    EXPECT_EQ(c.position, -7);
    EXPECT_EQ(c.velocity, 3);
    EXPECT_EQ(c.acceleration, 4);
    EXPECT_EQ(c.deceleration, 5);
    EXPECT_EQ(c.jerk, 6);
}

TEST_F(MoveSuperimposed, RunsBesideTheBlockThatCommandsTheAxis) {  // P1-157
    MC_MoveVelocity under;
    under.Axis = {0};
    under.Execute = true;
    under(axes.context);
    block.Axis = {0};
    begin();
    under(axes.context);
    EXPECT_TRUE(under.Active);
    EXPECT_FALSE(under.CommandAborted);
    EXPECT_TRUE(block.Busy);
}

TEST_F(MoveSuperimposed, ShowsTheDistanceCoveredAndKeepsItAfterDone) {
    block.Axis = {0};
    begin();
    axes.axis().superimposed_covered = 2.5;
    scan();
    EXPECT_EQ(block.CoveredDistance, 2.5);
    axes.axis().superimposed_covered = 10;
    axes.finish(Outcome::done);
    scan();
    EXPECT_TRUE(block.Done);
    EXPECT_EQ(block.CoveredDistance, 10);
}

TEST_F(MoveSuperimposed, ASecondOneReplacesTheFirstAndCountsForItself) {  // P1-152
    MC_MoveSuperimposed second;
    second.Axis = block.Axis = {0};
    begin();
    axes.axis().superimposed_covered = 4;
    scan();
    second.Execute = true;
    second(axes.context);
    axes.axis().superimposed_covered = 0.5;
    scan();
    second(axes.context);
    EXPECT_TRUE(block.CommandAborted);
    EXPECT_EQ(block.CoveredDistance, 4);
    EXPECT_TRUE(second.Busy);
    EXPECT_EQ(second.CoveredDistance, 0.5);
}

TEST_F(MoveSuperimposed, ANewEdgeCountsFromZero) {
    block.Axis = {0};
    begin();
    axes.axis().superimposed_covered = 10;
    axes.finish(Outcome::done);
    scan();
    block.Execute = false;
    scan();
    block.Execute = true;
    block(axes.context);
    EXPECT_EQ(block.CoveredDistance, 0);
}

using HaltSuperimposed = OneBlock<MC_HaltSuperimposed>;
TEST_F(HaltSuperimposed, EndsTheSuperimposedMotion) {  // P1-161: outputs
    MC_MoveSuperimposed running;
    running.Axis = block.Axis = {0};
    running.Execute = true;
    running(axes.context);
    block.Deceleration = 5, block.Jerk = 6;
    begin();
    running(axes.context);
    EXPECT_TRUE(running.CommandAborted);
    EXPECT_EQ(last().command.kind, CommandKind::halt_superimposed);
    EXPECT_EQ(last().command.deceleration, 5);
    EXPECT_EQ(last().command.jerk, 6);
    axes.finish(Outcome::done);
    scan();
    EXPECT_TRUE(block.Done);
}

struct SetOverride : testing::Test {
    SetOverride() {
        block.Axis = {0};
        scan();
    }
    void scan() {
        axes.next_scan();
        block(axes.context);
    }
    const axes::Override& factors() { return axes.axis().override_factors; }
    FakeAxes axes;
    MC_SetOverride block;
};

TEST_F(SetOverride, WritesWhileEnabledAndLeavesTheLastFactors) {  // P1-202, P1-212
    block.VelFactor = 0.5;
    scan();
    EXPECT_EQ(factors().velocity, 1) << "not enabled";
    block.Enable = true;
    scan();
    EXPECT_TRUE(block.Enabled);
    EXPECT_TRUE(block.Busy);
    EXPECT_EQ(factors().velocity, 0.5);
    block.AccFactor = 0.25, block.JerkFactor = 0.75;
    scan();
    EXPECT_EQ(factors(), (axes::Override{0.5, 0.25, 0.75}));
    block.Enable = false;
    block.VelFactor = 1;
    scan();
    EXPECT_FALSE(block.Enabled);
    EXPECT_FALSE(block.Busy);
    EXPECT_EQ(factors(), (axes::Override{0.5, 0.25, 0.75}));
}

TEST_F(SetOverride, FactorsAreOneByDefault) {  // P1-204
    block.Enable = true;
    scan();
    EXPECT_TRUE(block.Enabled);
    EXPECT_EQ(factors(), (axes::Override{1, 1, 1}));
}

TEST_F(SetOverride, WritesOnlyWhatTheAxisDoesNotHaveYet) {
    block.Enable = true;
    block.VelFactor = 0.5;
    for (int i = 0; i < 5; ++i) scan();
    EXPECT_EQ(axes.calls.size(), 1u);
    axes.axis().override_factors = {};  // somebody else
    scan();
    scan();
    EXPECT_EQ(axes.calls.size(), 2u);
    EXPECT_EQ(factors().velocity, 0.5);
}

TEST_F(SetOverride, ARefusalIsAnErrorThatGoesWithItsCause) {  // P1-206, P1-212
    block.Enable = true;
    block.AccFactor = 0;
    axes.refuse_with = ErrorId::invalid_override;
    for (int i = 0; i < 3; ++i) {
        scan();
        EXPECT_FALSE(block.Enabled);
        EXPECT_TRUE(block.Error) << "as long as its cause stands";
        EXPECT_EQ(block.ErrorID, ErrorId::invalid_override);
    }
    ASSERT_FALSE(axes.calls.empty());
    EXPECT_EQ(std::get<axes::Override>(axes.calls.back().setting), (axes::Override{1, 0, 1})) << "the axis judges, not the block";
    axes.refuse_with = ErrorId::none;
    block.AccFactor = 0.5;
    scan();
    EXPECT_TRUE(block.Enabled);
    EXPECT_FALSE(block.Error);
    EXPECT_EQ(block.ErrorID, ErrorId::none);
    EXPECT_EQ(factors(), (axes::Override{1, 0.5, 1}));
}

}  // namespace
}  // namespace taktwerk::fb
