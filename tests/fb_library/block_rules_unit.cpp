// PLCopen's rules (Part 1 v2.0, section 2.4.1) over every block in the list. Rule numbers P1-nnn: docs of the clause list.

#include "tests/fb_library/block_rules.hpp"

namespace taktwerk::fb {
namespace {

// --- all blocks ----------------------------------------------------------------------------------------------------------

template <class B>
class EveryBlock : public testing::Test {};
TYPED_TEST_SUITE(EveryBlock, AllBlocks::as<testing::Types>);

TYPED_TEST(EveryBlock, IsPlainData) {
    static_assert(std::is_trivially_copyable_v<TypeParam> && std::is_trivially_destructible_v<TypeParam>);
    static_assert(std::is_nothrow_invocable_v<TypeParam&, const axes::MotionContext&>, "a block is called as block(ctx)");
    static_assert(!std::is_polymorphic_v<TypeParam>);
}

TYPED_TEST(EveryBlock, DoesNothingAtRest) {
    FakeAxes axes;
    TypeParam block{};
    if constexpr (requires { block.Slave; }) block.Slave = {0};
    else if constexpr (requires { block.Axis; }) block.Axis = {0};
    for (int i = 0; i < 3; ++i) {
        block(axes.context);
        axes.next_scan();
    }
    EXPECT_TRUE(axes.calls.empty());
    if constexpr (requires { block.Busy; }) {
        EXPECT_FALSE(block.Busy);
    }
    if constexpr (requires { block.Error; }) {
        EXPECT_FALSE(block.Error);
    }
}

// --- blocks with an Execute ----------------------------------------------------------------------------------------------

template <class B>
class WorkRules : public Bench<B> {};
TYPED_TEST_SUITE(WorkRules, WorkBlocks);

TYPED_TEST(WorkRules, InvalidAxisHandleIsAnErrorUntilExecuteFalls) {
    if (!this->names_an_axis) return;  // digital points of the machine
    this->aim(0xFFFF);
    this->trigger(true);
    this->block(this->axes.context);
    EXPECT_TRUE(this->block.Error);
    EXPECT_EQ(this->block.ErrorID, ErrorId::invalid_axis);
    EXPECT_FALSE(this->block.Busy);

    this->scan();
    EXPECT_TRUE(this->block.Error) << "held while Execute is TRUE";
    this->trigger(false);
    this->scan();
    EXPECT_TRUE(this->quiet());
    EXPECT_TRUE(this->axes.calls.empty());
}

TYPED_TEST(WorkRules, ARefusalShowsInTheCallOfTheEdgeAndIsNotRepeated) {  // P1-044
    this->axes.refuse_with = ErrorId::owned_by_other;
    this->begin();
    this->scan();
    EXPECT_TRUE(this->block.Error);
    EXPECT_EQ(this->block.ErrorID, ErrorId::owned_by_other);
    EXPECT_EQ(this->axes.calls.size(), 1u);
}

TYPED_TEST(WorkRules, BusyRisesWithTheEdge) {  // P1-068
    this->trigger(true);
    this->block(this->axes.context);
    EXPECT_TRUE(this->block.Busy);
    EXPECT_FALSE(this->done());
}

TYPED_TEST(WorkRules, TheFirstCallWithExecuteTrueIsAnEdge) {
    this->begin();
    const std::size_t renewals = IsJog<TypeParam> ? 2 : 0;  // of its lease, in each call
    EXPECT_EQ(this->axes.calls.size(), 1u + renewals);
}

TYPED_TEST(WorkRules, DoneStaysUntilExecuteFalls) {  // P1-061
    if constexpr (HasDone<TypeParam>) {
        this->begin();
        this->complete();
        this->scan();
        EXPECT_TRUE(this->done());
        EXPECT_FALSE(this->block.Busy);
        this->scan();
        this->scan();
        EXPECT_TRUE(this->done());

        this->trigger(false);
        this->scan();
        EXPECT_TRUE(this->quiet()) << "in the call in which Execute falls";
    }
}

TYPED_TEST(WorkRules, DoneAfterExecuteFellLastsOneCall) {  // P1-063
    if constexpr (HasDone<TypeParam>) {
        this->trigger(true);
        this->block(this->axes.context);
        this->trigger(false);
        this->block(this->axes.context);  // still this scan: the block is busy
        this->complete();
        this->scan();
        EXPECT_TRUE(this->done());
        this->scan();
        EXPECT_TRUE(this->quiet());
    }
}

TYPED_TEST(WorkRules, AfterDoneANewEdgeStartsAnew) {
    if constexpr (HasDone<TypeParam>) {
        this->begin();
        this->complete();
        this->scan();
        const auto before = this->axes.calls.size();
        this->trigger(false);
        this->scan();
        if constexpr (std::is_same_v<TypeParam, MC_Reset>) this->axes.axis().state = axes::AxisState::ErrorStop;
        this->axes.next_scan();
        this->begin();
        EXPECT_GT(this->axes.calls.size(), before);
        EXPECT_FALSE(this->block.Error);
    }
}

// Every order of edges, outcomes and refusals: at most one of Busy, Done, CommandAborted, Error; one of them while Execute is TRUE;
// Active and Inxxx only while Busy; ErrorID if and only if Error. With and without ContinuousUpdate.
// P1-045, P1-058, P1-059, P1-068, P1-078, P1-107
TYPED_TEST(WorkRules, OutputsExcludeEachOtherInEveryOrderOfEvents) {
    std::mt19937 random{20110317};  // fixed: the same run each time
    bool level = false;
    int outcomes_seen = 0;
    for (int step = 0; step < 20000; ++step) {
        switch (random() % 9) {
            case 0: this->trigger(level = !level); break;
            case 1: this->complete(); break;
            case 2: this->axes.take_over(); break;
            case 3: this->axes.finish(axes::Outcome::error, ErrorId::aborted_by_axis_error); break;
            case 4: this->axes.refuse_with = random() % 2 ? ErrorId::state_forbids : ErrorId::none; break;
            case 5: this->axes.axis().state = random() % 2 ? axes::AxisState::ErrorStop : axes::AxisState::Standstill; break;
            case 6: this->axes.axis().active_in_target = random() % 2; break;
            case 7:
                if constexpr (requires { this->block.ContinuousUpdate; }) this->block.ContinuousUpdate = random() % 2;
                break;
            default: break;
        }
        this->scan();
        const int shown = this->block.Busy + this->done() + this->aborted() + this->block.Error;
        ASSERT_LE(shown, 1) << step;
        if constexpr (!IsJog<TypeParam>) {  // a jog's level is taken at standstill only
            if (level) {
                ASSERT_EQ(shown, 1) << step;
            }
        }
        ASSERT_EQ(this->block.Error, this->block.ErrorID != ErrorId::none) << step;
        if (this->active()) {
            ASSERT_TRUE(this->block.Busy) << step;
        }
        if (this->in_target()) {
            ASSERT_TRUE(this->active()) << step;
        }
        outcomes_seen += this->done() || this->aborted() || this->block.Error;
    }
    EXPECT_GT(outcomes_seen, 100);
}

TYPED_TEST(WorkRules, AfterAWarmStartNothingStartsOrWaitsForEver) {
    this->trigger(true);
    this->block(this->axes.context);
    ASSERT_TRUE(this->block.Busy);
    TypeParam retained{};
    std::memcpy(static_cast<void*>(&retained), &this->block, sizeof retained);
    FakeAxes rebooted{2};
    retained.warm_start(Instant{});

    retained(rebooted.context);
    EXPECT_FALSE(retained.Busy);
    EXPECT_TRUE(rebooted.calls.empty());
    if constexpr (CanBeAborted<TypeParam>) {
        EXPECT_TRUE(retained.CommandAborted);
    } else {
        EXPECT_EQ(retained.ErrorID, ErrorId::aborted_by_axis_error);
    }
}

template <class B>
class CommandRules : public Bench<B> {};
TYPED_TEST_SUITE(CommandRules, CommandBlocks);

TYPED_TEST(CommandRules, AbortedByAnotherCommandUntilExecuteFalls) {  // P1-077, P1-078
    this->begin();
    EXPECT_TRUE(this->active());
    this->axes.take_over();
    this->scan();
    EXPECT_TRUE(this->shows_abortion());
    EXPECT_FALSE(this->block.Busy);
    this->scan();
    EXPECT_TRUE(this->shows_abortion());
    this->trigger(false);
    this->scan();
    EXPECT_TRUE(this->quiet());
}

TYPED_TEST(CommandRules, EndedByAnAxisErrorShowsItsReason) {  // P1-040
    this->begin();
    this->axes.finish(axes::Outcome::error, ErrorId::homing_failed);
    this->scan();
    EXPECT_TRUE(this->block.Error);
    EXPECT_EQ(this->block.ErrorID, ErrorId::homing_failed);
}

TYPED_TEST(CommandRules, AnErrorWithoutAReasonStillHasAnErrorID) {
    this->begin();
    this->axes.finish(axes::Outcome::error);
    this->scan();
    EXPECT_EQ(this->block.ErrorID, ErrorId::aborted_by_axis_error);
}

TYPED_TEST(CommandRules, AResultThatTheLedgerHasForgottenIsAnAbortion) {
    this->begin();
    for (int i = 0; i < 20; ++i) this->axes.take_over();
    this->scan();
    EXPECT_TRUE(this->shows_abortion());
}

TYPED_TEST(CommandRules, TheCommandBelongsToTheAxisOfTheEdge) {  // P1-099
    this->aim(1);
    this->begin();
    this->aim(0);
    this->scan();
    EXPECT_TRUE(this->block.Busy);

    this->axes.finish(axes::Outcome::done, ErrorId::none, 1);
    this->scan();
    EXPECT_FALSE(this->block.Busy);
    EXPECT_FALSE(this->block.Error);
    for (const auto& call : this->axes.calls) EXPECT_EQ(call.axis.index, 1);
}

TYPED_TEST(CommandRules, CommandsInTheNameOfTheContextsOwner) {
    this->axes.context.owner = axes::Owner::commissioning;
    this->begin();
    ASSERT_FALSE(this->axes.calls.empty());
    for (const auto& call : this->axes.calls) EXPECT_EQ(call.owner, axes::Owner::commissioning);
}

template <class B>
class ExecuteRules : public Bench<B> {};
TYPED_TEST_SUITE(ExecuteRules, ExecuteBlocks);

TYPED_TEST(ExecuteRules, FallingExecuteLeavesTheCommandAlone) {  // P1-062
    this->begin();
    this->trigger(false);
    this->scan();
    this->scan();
    EXPECT_TRUE(this->block.Busy);
    EXPECT_EQ(this->axes.calls_of("submit").size(), 1u);
    EXPECT_EQ(this->axes.calls.size() - this->axes.calls_of("release_stop").size(), 1u);
}

TYPED_TEST(ExecuteRules, InputsCountAtTheEdgeOnly) {  // P1-052
    this->begin();
    this->change_inputs(99);
    this->scan();
    this->scan();
    EXPECT_EQ(this->axes.calls.size(), 1u);
}

TYPED_TEST(ExecuteRules, ANewEdgeWhileBusyShowsNoOutcomeOfTheFirst) {  // P1-064
    this->begin();
    this->trigger(false);
    this->scan();
    this->trigger(true);
    this->scan();  // the axis aborts the first for the second
    EXPECT_TRUE(this->block.Busy);
    this->scan();
    EXPECT_TRUE(this->block.Busy);
    EXPECT_FALSE(this->aborted());
    EXPECT_EQ(this->axes.calls_of("submit").size(), 2u);

    this->axes.finish(axes::Outcome::error, ErrorId::interlocked);
    this->scan();
    EXPECT_EQ(this->block.ErrorID, ErrorId::interlocked) << "follows the second";
}

// A slower task's request takes effect later than its next view: the id is still ahead of AxisView::last_id.
TYPED_TEST(ExecuteRules, AnIdThatTheViewDoesNotKnowYetIsWaitedFor) {
    this->trigger(true);
    for (int i = 0; i < 5; ++i) {
        this->block(this->axes.context);  // no next_scan: the view stays old
        EXPECT_TRUE(this->block.Busy);
        EXPECT_FALSE(this->aborted());
    }
    this->scan();
    EXPECT_TRUE(this->active());
}

// Figure 7, case 3: Execute falls while the command waits; it takes control; it finishes.
TYPED_TEST(ExecuteRules, ABufferedCommandIsBusyButNotActiveUntilItsTurn) {  // P1-074, P1-083
    if constexpr (requires { this->block.BufferMode; }) {
        this->axes.take_over();  // some other command runs
        this->block.BufferMode = mcBuffered;
        this->begin();
        EXPECT_TRUE(this->block.Busy);
        EXPECT_FALSE(this->active());
        this->trigger(false);
        this->scan();
        EXPECT_TRUE(this->block.Busy);

        this->axes.finish(axes::Outcome::done);
        this->scan();
        EXPECT_TRUE(this->active());
    }
}

}  // namespace
}  // namespace taktwerk::fb
