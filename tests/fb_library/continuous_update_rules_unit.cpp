// What ContinuousUpdate means, over every block of the list that has it: PLCopen Part 1 v2.0, 2.4.6; and Inxxx outputs, figure 8.

#include "tests/fb_library/block_rules.hpp"

namespace taktwerk::fb {
namespace {

template <class B>
class ContinuousUpdateRules : public Bench<B> {};
TYPED_TEST_SUITE(ContinuousUpdateRules, ContinuousUpdateBlocks);

TYPED_TEST(ContinuousUpdateRules, InputsGoToTheAxisAsLongAsItStaysTrue) {  // P1-053, P1-103
    this->block.ContinuousUpdate = true;
    this->begin();
    const auto id = this->axes.calls_of("submit").at(0).id;
    this->change_inputs(99);
    this->scan();
    this->change_inputs(98);
    this->scan();

    const auto updates = this->axes.calls_of("update");
    ASSERT_EQ(updates.size(), 3u) << "each call after that of the edge";
    EXPECT_EQ(updates[0].command, this->axes.calls_of("submit").at(0).command);
    EXPECT_NE(updates[1].command, updates[0].command);
    EXPECT_EQ(updates[2].command, this->block.command());
    for (const auto& update : updates) {
        EXPECT_EQ(update.id, id);
        EXPECT_EQ(update.axis.index, 0);
    }
    EXPECT_EQ(this->axes.calls_of("submit").size(), 1u) << "never a re-trigger";
    EXPECT_TRUE(this->block.Busy);
}

TYPED_TEST(ContinuousUpdateRules, SetAfterTheEdgeHasNoEffect) {  // P1-103
    this->begin();
    this->block.ContinuousUpdate = true;
    this->change_inputs(99);
    this->scan();
    EXPECT_TRUE(this->block.Busy);
    EXPECT_EQ(this->axes.calls.size(), 1u);
}

TYPED_TEST(ContinuousUpdateRules, OnceFalseItNeverComesBackForThisCommand) {  // P1-104
    this->block.ContinuousUpdate = true;
    this->begin();
    this->block.ContinuousUpdate = false;
    this->scan();
    const auto before = this->axes.calls.size();
    this->block.ContinuousUpdate = true;
    this->change_inputs(99);
    this->scan();
    this->scan();
    EXPECT_EQ(this->axes.calls.size(), before);

    this->trigger(false);
    this->scan();
    this->trigger(true);  // a new command, with it TRUE
    this->scan();
    this->scan();
    EXPECT_EQ(this->axes.calls.back().what, "update");
}

TYPED_TEST(ContinuousUpdateRules, EndsWithTheCommand) {  // P1-105, P1-106
    this->block.ContinuousUpdate = true;
    this->begin();
    this->axes.take_over();
    this->scan();
    ASSERT_TRUE(this->aborted());
    const auto before = this->axes.calls.size();
    this->change_inputs(99);
    this->scan();
    this->scan();
    EXPECT_EQ(this->axes.calls.size(), before);
    EXPECT_TRUE(this->aborted());
}

TYPED_TEST(ContinuousUpdateRules, ItGoesOnWhenExecuteFalls) {
    this->block.ContinuousUpdate = true;
    this->begin();
    this->trigger(false);
    this->scan();
    EXPECT_EQ(this->axes.calls.back().what, "update");
}

TYPED_TEST(ContinuousUpdateRules, ValuesThatTheAxisRefusesLeaveTheBlockAtItsCommand) {  // P1-058
    this->block.ContinuousUpdate = true;
    this->begin();
    this->axes.refuse_with = ErrorId::invalid_dynamics;
    this->scan();
    EXPECT_TRUE(this->block.Busy);
    EXPECT_FALSE(this->block.Error);
    EXPECT_EQ(this->block.ErrorID, ErrorId::none);
    const auto before = this->axes.calls.size();
    this->axes.refuse_with = ErrorId::none;
    this->scan();
    EXPECT_EQ(this->axes.calls.size(), before + 1) << "good ones are given again";
}

// --- blocks with Inxxx ---------------------------------------------------------------------------------------------------

template <class B>
class InTargetRules : public Bench<B> {
protected:
    /// Something runs, and the block's command will be buffered; false when it cannot be.
    bool waits_behind_another() {
        this->axes.take_over();
        if constexpr (requires { this->block.BufferMode; }) this->block.BufferMode = mcBuffered;
        return requires { this->block.BufferMode; };
    }
    void expect(bool busy, bool active, bool in_target, bool error, bool aborted, const char* event) {
        EXPECT_EQ(this->block.Busy, busy) << event;
        EXPECT_EQ(this->block.Active, active) << event;
        EXPECT_EQ(this->in_target(), in_target) << event;
        EXPECT_EQ(this->block.Error, error) << event;
        EXPECT_EQ(this->aborted(), aborted) << event;
    }
};
TYPED_TEST_SUITE(InTargetRules, InTargetBlocks);

TYPED_TEST(InTargetRules, Figure8Case1InterruptedWhileExecuteIsTrue) {  // P1-084
    if (!this->waits_behind_another()) return;
    this->begin();
    this->expect(true, false, false, false, false, "Execute rises");
    this->axes.finish(axes::Outcome::done);
    this->scan();
    this->expect(true, true, false, false, false, "takes control");
    this->axes.axis().active_in_target = true;
    this->scan();
    this->expect(true, true, true, false, false, "set equals commanded");
    this->axes.take_over();
    this->scan();
    this->expect(false, false, false, false, true, "interrupted");
    this->trigger(false);
    this->scan();
    this->expect(false, false, false, false, false, "Execute falls");
}

TYPED_TEST(InTargetRules, Figure8Case2AFault) {  // P1-084
    this->begin();
    this->expect(true, true, false, false, false, "control at once");
    this->axes.axis().active_in_target = true;
    this->scan();
    this->expect(true, true, true, false, false, "set equals commanded");
    this->axes.finish(axes::Outcome::error, ErrorId::interlocked);
    this->scan();
    this->expect(false, false, false, true, false, "fault");
    this->trigger(false);
    this->scan();
    this->expect(false, false, false, false, false, "Execute falls");
}

TYPED_TEST(InTargetRules, Figure8Case3ExecuteFallsWhileWaiting) {  // P1-084, P1-071
    if (!this->waits_behind_another()) return;
    this->begin();
    this->trigger(false);
    this->scan();
    this->expect(true, false, false, false, false, "Execute falls");
    this->axes.finish(axes::Outcome::done);
    this->scan();
    this->expect(true, true, false, false, false, "takes control");
    this->axes.axis().active_in_target = true;
    for (int i = 0; i < 3; ++i) {
        this->scan();
        this->expect(true, true, true, false, false, "stays");
    }
}

TYPED_TEST(InTargetRules, FollowsTheSetValueBothWays) {  // P1-070
    this->begin();
    for (const bool reached : {true, false, true}) {
        this->axes.axis().active_in_target = reached;
        this->scan();
        EXPECT_EQ(this->in_target(), reached);
    }
}

}  // namespace
}  // namespace taktwerk::fb
