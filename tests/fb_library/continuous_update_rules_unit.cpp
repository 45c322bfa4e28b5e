// What ContinuousUpdate means, over every block of the list that has it: PLCopen Part 1 v2.0, 2.4.6; and Inxxx outputs, figure 8.

#include "tests/fb_library/block_rules.hpp"

namespace taktwerk::fb {
namespace {

class ContinuousUpdateRules : public Bench {};
INSTANTIATE_TEST_SUITE_P(Each, ContinuousUpdateRules, testing::ValuesIn(continuous_update_blocks()), name_of);

TEST_P(ContinuousUpdateRules, InputsGoToTheAxisAsLongAsItStaysTrue) {  // P1-053, P1-103
    block.ContinuousUpdate = true;
    begin();
    const auto id = axes.calls_of("submit").at(0).id;
    change_inputs(99);
    scan();
    change_inputs(98);
    scan();

    const auto updates = axes.calls_of("update");
    ASSERT_EQ(updates.size(), 3u) << "each call after that of the edge";
    EXPECT_EQ(updates[0].command, axes.calls_of("submit").at(0).command);
    EXPECT_NE(updates[1].command, updates[0].command);
    EXPECT_EQ(updates[2].command, kind.command(block.bytes()));
    for (const auto& update : updates) {
        EXPECT_EQ(update.id, id);
        EXPECT_EQ(update.axis.index, 0);
    }
    EXPECT_EQ(axes.calls_of("submit").size(), 1u) << "never a re-trigger";
    EXPECT_TRUE(block.Busy);
}

TEST_P(ContinuousUpdateRules, SetAfterTheEdgeHasNoEffect) {  // P1-103
    begin();
    block.ContinuousUpdate = true;
    change_inputs(99);
    scan();
    EXPECT_TRUE(block.Busy);
    EXPECT_EQ(axes.calls.size(), 1u);
}

TEST_P(ContinuousUpdateRules, OnceFalseItNeverComesBackForThisCommand) {  // P1-104
    block.ContinuousUpdate = true;
    begin();
    block.ContinuousUpdate = false;
    scan();
    const auto before = axes.calls.size();
    block.ContinuousUpdate = true;
    change_inputs(99);
    scan();
    scan();
    EXPECT_EQ(axes.calls.size(), before);

    trigger(false);
    scan();
    trigger(true);  // a new command, with it TRUE
    scan();
    scan();
    EXPECT_EQ(axes.calls.back().what, "update");
}

TEST_P(ContinuousUpdateRules, EndsWithTheCommand) {  // P1-105, P1-106
    block.ContinuousUpdate = true;
    begin();
    axes.take_over();
    scan();
    ASSERT_TRUE(aborted());
    const auto before = axes.calls.size();
    change_inputs(99);
    scan();
    scan();
    EXPECT_EQ(axes.calls.size(), before);
    EXPECT_TRUE(aborted());
}

TEST_P(ContinuousUpdateRules, ItGoesOnWhenExecuteFalls) {
    block.ContinuousUpdate = true;
    begin();
    trigger(false);
    scan();
    EXPECT_EQ(axes.calls.back().what, "update");
}

TEST_P(ContinuousUpdateRules, ValuesThatTheAxisRefusesLeaveTheBlockAtItsCommand) {  // P1-058
    block.ContinuousUpdate = true;
    begin();
    axes.refuse_with = ErrorId::invalid_dynamics;
    scan();
    EXPECT_TRUE(block.Busy);
    EXPECT_FALSE(block.Error);
    EXPECT_EQ(block.ErrorID, ErrorId::none);
    const auto before = axes.calls.size();
    axes.refuse_with = ErrorId::none;
    scan();
    EXPECT_EQ(axes.calls.size(), before + 1) << "good ones are given again";
}

// --- blocks with Inxxx ---------------------------------------------------------------------------------------------------

class InTargetRules : public Bench {
protected:
    /// Something runs, and the block's command will be buffered; false when it cannot be.
    bool waits_behind_another() {
        axes.take_over();
        if (has("BufferMode")) block.BufferMode = mcBuffered;
        return has("BufferMode");
    }
    void expect(bool busy, bool active, bool in_target, bool error, bool aborted, const char* event) {
        EXPECT_EQ(block.Busy, busy) << event;
        EXPECT_EQ(block.Active, active) << event;
        EXPECT_EQ(this->in_target(), in_target) << event;
        EXPECT_EQ(block.Error, error) << event;
        EXPECT_EQ(this->aborted(), aborted) << event;
    }
};
INSTANTIATE_TEST_SUITE_P(Each, InTargetRules, testing::ValuesIn(in_target_blocks()), name_of);

TEST_P(InTargetRules, Figure8Case1InterruptedWhileExecuteIsTrue) {  // P1-084
    if (!waits_behind_another()) return;
    begin();
    expect(true, false, false, false, false, "Execute rises");
    axes.finish(axes::Outcome::done);
    scan();
    expect(true, true, false, false, false, "takes control");
    axes.axis().active_in_target = true;
    scan();
    expect(true, true, true, false, false, "set equals commanded");
    axes.take_over();
    scan();
    expect(false, false, false, false, true, "interrupted");
    trigger(false);
    scan();
    expect(false, false, false, false, false, "Execute falls");
}

TEST_P(InTargetRules, Figure8Case2AFault) {  // P1-084
    begin();
    expect(true, true, false, false, false, "control at once");
    axes.axis().active_in_target = true;
    scan();
    expect(true, true, true, false, false, "set equals commanded");
    axes.finish(axes::Outcome::error, ErrorId::interlocked);
    scan();
    expect(false, false, false, true, false, "fault");
    trigger(false);
    scan();
    expect(false, false, false, false, false, "Execute falls");
}

TEST_P(InTargetRules, Figure8Case3ExecuteFallsWhileWaiting) {  // P1-084, P1-071
    if (!waits_behind_another()) return;
    begin();
    trigger(false);
    scan();
    expect(true, false, false, false, false, "Execute falls");
    axes.finish(axes::Outcome::done);
    scan();
    expect(true, true, false, false, false, "takes control");
    axes.axis().active_in_target = true;
    for (int i = 0; i < 3; ++i) {
        scan();
        expect(true, true, true, false, false, "stays");
    }
}

TEST_P(InTargetRules, FollowsTheSetValueBothWays) {  // P1-070
    begin();
    for (const bool reached : {true, false, true}) {
        axes.axis().active_in_target = reached;
        scan();
        EXPECT_EQ(in_target(), reached);
    }
}

}  // namespace
}  // namespace taktwerk::fb
