// Motion blocks in a slower task: their requests apply a release later, under ids of the task's own.
#include <gtest/gtest.h>

#include <vector>

#include "fb_library/motion/moves.hpp"
#include "runtime/latched_requests.hpp"
#include "tests/fb_library/fake_axes.hpp"

namespace taktwerk::runtime {
namespace {

struct SlowTaskBlocks : testing::Test {
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

}  // namespace
}  // namespace taktwerk::runtime
