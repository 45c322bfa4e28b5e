// Motion blocks in a slower task: their requests apply a release later, under ids of the task's own.
#include <gtest/gtest.h>

#include <vector>

#include "fb_library/motion/administration.hpp"
#include "fb_library/motion/camming.hpp"
#include "fb_library/motion/moves.hpp"
#include "fb_library/motion/override.hpp"
#include "fb_library/motion/parameter_blocks.hpp"
#include "fb_library/motion/probes.hpp"
#include "fb_library/motion/superimposed.hpp"
#include "runtime/tasks/latched_requests.hpp"
#include "tests/fb_library/fake_axes.hpp"

namespace taktwerk::runtime {
namespace {

struct SlowTaskBlocks : ::testing::Test {
    SlowTaskBlocks() {
        requests.bind(views);
        release();
    }
    /// As SlowTask does: what was asked applies, then the views are taken.
    void release() {
        requests.apply(axes);
        axes.next_scan();
        requests.latch(axes.context.axes, views);
        ctx = axes.context;
        ctx.axes = views;
        ctx.requests = &requests;
    }

    fb::FakeAxes axes{1};
    std::vector<axes::AxisView> views{1};
    LatchedRequests requests{1};
    axes::MotionContext ctx;
};

TEST_F(SlowTaskBlocks, AMoveRunsItsCourse) {
    fb::MC_MoveAbsolute move;
    move.Axis = {0};
    move.Execute = true;
    move(ctx);
    EXPECT_TRUE(move.Busy);
    EXPECT_FALSE(move.Active);
    release();
    move(ctx);
    EXPECT_TRUE(move.Active);
    axes.finish(axes::Outcome::done);
    release();
    move(ctx);
    EXPECT_TRUE(move.Done);
}

TEST_F(SlowTaskBlocks, ARefusalShowsAfterTheRelease) {
    fb::MC_MoveAbsolute move;
    move.Axis = {0};
    move.Execute = true;
    axes.refuse_with = axes::ErrorId::not_homed;
    move(ctx);
    release();
    move(ctx);
    EXPECT_EQ(move.ErrorID, axes::ErrorId::not_homed);
}

// The block was not called for so long that nobody knows its command any more: aborted, not Busy for ever.
TEST_F(SlowTaskBlocks, AForgottenCommandIsAborted) {
    fb::MC_MoveAbsolute move, other;
    move.Axis = other.Axis = {0};
    move.Execute = true;
    move(ctx);
    release();
    for (int i = 0; i < 100; ++i) {
        other.Execute = true;
        other(ctx);
        release();
        other.Execute = false;
        other(ctx);
        release();
    }
    move(ctx);
    EXPECT_TRUE(move.CommandAborted);
    EXPECT_FALSE(move.Busy);
}

// What runs beside the axis' motion is known under the task's id as well.
TEST_F(SlowTaskBlocks, ASuperimposedMotionRunsItsCourse) {
    fb::MC_MoveSuperimposed move;
    move.Axis = {0};
    move.Execute = true;
    move(ctx);
    release();
    axes.axis().superimposed_covered = 1.5;
    release();
    move(ctx);
    EXPECT_TRUE(move.Busy);
    EXPECT_EQ(move.CoveredDistance, 1.5);
    axes.finish(axes::Outcome::done);
    release();
    move(ctx);
    EXPECT_TRUE(move.Done);
}

TEST_F(SlowTaskBlocks, AProbeKnowsItsOwnLatch) {
    fb::MC_TouchProbe probe;
    probe.Axis = {0};
    probe.Execute = true;
    probe(ctx);
    release();
    axes.axis().probe_latched[0] = axes.axis().side[static_cast<std::size_t>(axes::SideSlot::probe1)];
    axes.axis().probe_position[0] = 42.5;
    axes.finish(axes::Outcome::done);
    release();
    probe(ctx);
    EXPECT_TRUE(probe.Done);
    EXPECT_EQ(probe.RecordedPosition, 42.5);
}

TEST_F(SlowTaskBlocks, ASettingIsDoneWhenItHasBeenCarriedOut) {
    fb::MC_SetPosition set;
    set.Axis = {0};
    set.Execute = true;
    set(ctx);
    EXPECT_TRUE(set.Busy);
    EXPECT_TRUE(axes.calls.empty());
    release();
    EXPECT_EQ(axes.calls_of("set").size(), 1u);
    set(ctx);
    EXPECT_TRUE(set.Done);
}

TEST_F(SlowTaskBlocks, ARefusedSettingIsAnErrorOfItsBlock) {
    fb::MC_SetPosition set;
    set.Axis = {0};
    set.Execute = true;
    axes.refuse_with = axes::ErrorId::state_forbids;
    set(ctx);
    release();
    set(ctx);
    EXPECT_FALSE(set.Done);
    EXPECT_EQ(set.ErrorID, axes::ErrorId::state_forbids);
}

TEST_F(SlowTaskBlocks, OverrideFactorsThatAreRefusedShowErrorAsLongAsTheyStay) {
    fb::MC_SetOverride factors;
    factors.Axis = {0};
    factors.Enable = true;
    factors.AccFactor = 0;
    axes.refuse_with = axes::ErrorId::invalid_override;
    factors(ctx);
    EXPECT_FALSE(factors.Enabled);
    for (int i = 0; i < 3; ++i) {
        release();
        factors(ctx);
        EXPECT_FALSE(factors.Enabled);
        EXPECT_EQ(factors.ErrorID, axes::ErrorId::invalid_override);
    }
    axes.refuse_with = axes::ErrorId::none;
    factors.AccFactor = 0.5;
    factors(ctx);
    release();
    factors(ctx);
    EXPECT_TRUE(factors.Enabled);
    EXPECT_EQ(axes.axis().override_factors.acceleration, 0.5);
}

TEST_F(SlowTaskBlocks, ASelectedCamIsKnownAfterTheRelease) {
    fb::MC_CamTableSelect select;
    select.Slave = {0};
    select.CamTable = {4};
    select.Execute = true;
    select(ctx);
    release();
    select(ctx);
    EXPECT_TRUE(select.Done);
    EXPECT_EQ(select.CamTableID, axes.axis().selected_cam);
}

TEST_F(SlowTaskBlocks, ARefusedCamIsAnErrorOfItsBlock) {
    fb::MC_CamTableSelect select;
    select.Slave = {0};
    select.Execute = true;
    axes.refuse_with = axes::ErrorId::invalid_table;
    select(ctx);
    release();
    select(ctx);
    EXPECT_EQ(select.ErrorID, axes::ErrorId::invalid_table);
}

// ContinuousUpdate: the real id goes to the axis, also when the command was given in the same run.
TEST_F(SlowTaskBlocks, UpdatesReachTheCommandUnderItsRealId) {
    fb::MC_MoveAbsolute move;
    move.Axis = {0};
    move.Execute = move.ContinuousUpdate = true;
    move(ctx);
    move.Position = 5;
    move(ctx);
    release();
    const auto submitted = axes.calls_of("submit"), updates = axes.calls_of("update");
    ASSERT_EQ(submitted.size(), 1u);
    ASSERT_EQ(updates.size(), 1u);
    EXPECT_EQ(updates[0].id, submitted[0].id);
    EXPECT_EQ(updates[0].command.position, 5);
}

TEST_F(SlowTaskBlocks, AProbeTriggeredAnewNamesItsFormerCommandAsTheAxisKnowsIt) {
    fb::MC_TouchProbe probe;
    probe.Axis = {0};
    for (const bool level : {true, false, true}) {
        probe.Execute = level;
        probe(ctx);
        release();
    }
    const auto commands = axes.calls_of("submit");
    ASSERT_EQ(commands.size(), 2u);
    EXPECT_EQ(std::get<axes::ProbeDetails>(commands[0].command.details).replaces, 0u);
    EXPECT_EQ(std::get<axes::ProbeDetails>(commands[1].command.details).replaces, commands[0].id);
}

TEST_F(SlowTaskBlocks, AParameterThatCannotBeWrittenIsRefusedAtOnce) {
    fb::MC_WriteParameter write;
    write.Axis = {0};
    write.ParameterNumber = 8;
    write.Execute = true;
    write(ctx);
    EXPECT_EQ(write.ErrorID, axes::ErrorId::read_only_parameter);
}

}  // namespace
}  // namespace taktwerk::runtime
