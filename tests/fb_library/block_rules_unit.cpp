// PLCopen's rules (Part 1 v2.0, section 2.4.1) over every block in the list. Rule numbers P1-nnn: docs of the clause list.

#include "tests/fb_library/block_rules.hpp"

namespace taktwerk::fb {
namespace {

// --- all blocks ----------------------------------------------------------------------------------------------------------

template <class... Blocks>
constexpr bool are_plain_data(BlockList<Blocks...>) {
    static_assert(((std::is_trivially_copyable_v<Blocks> && std::is_trivially_destructible_v<Blocks>)&&...));
    static_assert((std::is_nothrow_invocable_v<Blocks&, const axes::MotionContext&> && ...), "a block is called as block(ctx)");
    static_assert(!(std::is_polymorphic_v<Blocks> || ...));
    return true;
}

TEST(EveryBlock, IsPlainData) { EXPECT_TRUE(are_plain_data(AllBlocks{})); }

TEST(EveryBlock, DoesNothingAtRest) {
    for (const BlockType& type : all_block_types()) {
        FakeAxes axes;
        AnyBlock block{type};
        if (block.has("Slave")) block.at<AxisRef>("Slave") = {0};
        else if (block.has("Axis")) block.at<AxisRef>("Axis") = {0};
        for (int i = 0; i < 3; ++i) {
            block(axes.context);
            axes.next_scan();
        }
        EXPECT_TRUE(axes.calls.empty()) << type.name;
        EXPECT_FALSE(block.Busy) << type.name;
        EXPECT_FALSE(block.Error) << type.name;
    }
}

// --- blocks with an Execute ----------------------------------------------------------------------------------------------

class WorkRules : public Bench {};
INSTANTIATE_TEST_SUITE_P(Each, WorkRules, testing::ValuesIn(work_blocks()), name_of);

TEST_P(WorkRules, InvalidAxisHandleIsAnErrorUntilExecuteFalls) {
    if (!names_an_axis()) return;  // digital points of the machine
    aim(0xFFFF);
    trigger(true);
    block(axes.context);
    EXPECT_TRUE(block.Error);
    EXPECT_EQ(block.ErrorID, ErrorId::invalid_axis);
    EXPECT_FALSE(block.Busy);

    scan();
    EXPECT_TRUE(block.Error) << "held while Execute is TRUE";
    trigger(false);
    scan();
    EXPECT_TRUE(quiet());
    EXPECT_TRUE(axes.calls.empty());
}

TEST_P(WorkRules, ARefusalShowsInTheCallOfTheEdgeAndIsNotRepeated) {  // P1-044
    axes.refuse_with = ErrorId::owned_by_other;
    begin();
    scan();
    EXPECT_TRUE(block.Error);
    EXPECT_EQ(block.ErrorID, ErrorId::owned_by_other);
    EXPECT_EQ(axes.calls.size(), 1u);
}

TEST_P(WorkRules, BusyRisesWithTheEdge) {  // P1-068
    trigger(true);
    block(axes.context);
    EXPECT_TRUE(block.Busy);
    EXPECT_FALSE(done());
}

TEST_P(WorkRules, TheFirstCallWithExecuteTrueIsAnEdge) {
    begin();
    const std::size_t renewals = kind.is_jog() ? 2 : 0;  // of its lease, in each call
    EXPECT_EQ(axes.calls.size(), 1u + renewals);
}

TEST_P(WorkRules, DoneStaysUntilExecuteFalls) {  // P1-061
    if (has_done) {
        begin();
        complete();
        scan();
        EXPECT_TRUE(done());
        EXPECT_FALSE(block.Busy);
        scan();
        scan();
        EXPECT_TRUE(done());

        trigger(false);
        scan();
        EXPECT_TRUE(quiet()) << "in the call in which Execute falls";
    }
}

TEST_P(WorkRules, DoneAfterExecuteFellLastsOneCall) {  // P1-063
    if (has_done) {
        trigger(true);
        block(axes.context);
        trigger(false);
        block(axes.context);  // still this scan: the block is busy
        complete();
        scan();
        EXPECT_TRUE(done());
        scan();
        EXPECT_TRUE(quiet());
    }
}

TEST_P(WorkRules, AfterDoneANewEdgeStartsAnew) {
    if (has_done) {
        begin();
        complete();
        scan();
        const auto before = axes.calls.size();
        trigger(false);
        scan();
        if (kind.is("MC_Reset")) axes.axis().state = axes::AxisState::ErrorStop;
        axes.next_scan();
        begin();
        EXPECT_GT(axes.calls.size(), before);
        EXPECT_FALSE(block.Error);
    }
}

// Every order of edges, outcomes and refusals: at most one of Busy, Done, CommandAborted, Error; one of them while Execute is TRUE;
// Active and Inxxx only while Busy; ErrorID if and only if Error. With and without ContinuousUpdate.
// P1-045, P1-058, P1-059, P1-068, P1-078, P1-107
TEST_P(WorkRules, OutputsExcludeEachOtherInEveryOrderOfEvents) {
    std::mt19937 random{20110317};  // fixed: the same run each time
    bool level = false;
    int outcomes_seen = 0;
    for (int step = 0; step < 20000; ++step) {
        switch (random() % 9) {
            case 0: trigger(level = !level); break;
            case 1: complete(); break;
            case 2: axes.take_over(); break;
            case 3: axes.finish(axes::Outcome::error, ErrorId::aborted_by_axis_error); break;
            case 4: axes.refuse_with = random() % 2 ? ErrorId::state_forbids : ErrorId::none; break;
            case 5: axes.axis().state = random() % 2 ? axes::AxisState::ErrorStop : axes::AxisState::Standstill; break;
            case 6: axes.axis().active_in_target = random() % 2; break;
            case 7:
                if (has("ContinuousUpdate")) block.ContinuousUpdate = random() % 2;
                break;
            default: break;
        }
        scan();
        const int shown = block.Busy + done() + aborted() + block.Error;
        ASSERT_LE(shown, 1) << step;
        if (!kind.is_jog()) {  // a jog's level is taken at standstill only
            if (level) {
                ASSERT_EQ(shown, 1) << step;
            }
        }
        ASSERT_EQ(block.Error, block.ErrorID != ErrorId::none) << step;
        if (active()) {
            ASSERT_TRUE(block.Busy) << step;
        }
        if (in_target()) {
            ASSERT_TRUE(active()) << step;
        }
        outcomes_seen += done() || aborted() || block.Error;
    }
    EXPECT_GT(outcomes_seen, 100);
}

TEST_P(WorkRules, AfterAWarmStartNothingStartsOrWaitsForEver) {
    trigger(true);
    block(axes.context);
    ASSERT_TRUE(block.Busy);
    AnyBlock retained{*kind.type};
    retained.become(block);
    FakeAxes rebooted{2};
    retained.warm_start(Instant{});

    retained(rebooted.context);
    EXPECT_FALSE(retained.Busy);
    EXPECT_TRUE(rebooted.calls.empty());
    if (can_be_aborted) {
        EXPECT_TRUE(retained.CommandAborted);
    } else {
        EXPECT_EQ(retained.ErrorID, ErrorId::aborted_by_axis_error);
    }
}

class CommandRules : public Bench {};
INSTANTIATE_TEST_SUITE_P(Each, CommandRules, testing::ValuesIn(command_blocks()), name_of);

TEST_P(CommandRules, AbortedByAnotherCommandUntilExecuteFalls) {  // P1-077, P1-078
    begin();
    EXPECT_TRUE(active());
    axes.take_over();
    scan();
    EXPECT_TRUE(shows_abortion());
    EXPECT_FALSE(block.Busy);
    scan();
    EXPECT_TRUE(shows_abortion());
    trigger(false);
    scan();
    EXPECT_TRUE(quiet());
}

TEST_P(CommandRules, EndedByAnAxisErrorShowsItsReason) {  // P1-040
    begin();
    axes.finish(axes::Outcome::error, ErrorId::homing_failed);
    scan();
    EXPECT_TRUE(block.Error);
    EXPECT_EQ(block.ErrorID, ErrorId::homing_failed);
}

TEST_P(CommandRules, AnErrorWithoutAReasonStillHasAnErrorID) {
    begin();
    axes.finish(axes::Outcome::error);
    scan();
    EXPECT_EQ(block.ErrorID, ErrorId::aborted_by_axis_error);
}

TEST_P(CommandRules, AResultThatTheLedgerHasForgottenIsAnAbortion) {
    begin();
    for (int i = 0; i < 20; ++i) axes.take_over();
    scan();
    EXPECT_TRUE(shows_abortion());
}

TEST_P(CommandRules, TheCommandBelongsToTheAxisOfTheEdge) {  // P1-099
    aim(1);
    begin();
    aim(0);
    scan();
    EXPECT_TRUE(block.Busy);

    axes.finish(axes::Outcome::done, ErrorId::none, 1);
    scan();
    EXPECT_FALSE(block.Busy);
    EXPECT_FALSE(block.Error);
    for (const auto& call : axes.calls) EXPECT_EQ(call.axis.index, 1);
}

TEST_P(CommandRules, CommandsInTheNameOfTheContextsOwner) {
    axes.context.owner = axes::Owner::commissioning;
    begin();
    ASSERT_FALSE(axes.calls.empty());
    for (const auto& call : axes.calls) EXPECT_EQ(call.owner, axes::Owner::commissioning);
}

class ExecuteRules : public Bench {};
INSTANTIATE_TEST_SUITE_P(Each, ExecuteRules, testing::ValuesIn(execute_blocks()), name_of);

TEST_P(ExecuteRules, FallingExecuteLeavesTheCommandAlone) {  // P1-062
    begin();
    trigger(false);
    scan();
    scan();
    EXPECT_TRUE(block.Busy);
    EXPECT_EQ(axes.calls_of("submit").size(), 1u);
    EXPECT_EQ(axes.calls.size() - axes.calls_of("release_stop").size(), 1u);
}

TEST_P(ExecuteRules, InputsCountAtTheEdgeOnly) {  // P1-052
    begin();
    change_inputs(99);
    scan();
    scan();
    EXPECT_EQ(axes.calls.size(), 1u);
}

TEST_P(ExecuteRules, ANewEdgeWhileBusyShowsNoOutcomeOfTheFirst) {  // P1-064
    begin();
    trigger(false);
    scan();
    trigger(true);
    scan();  // the axis aborts the first for the second
    EXPECT_TRUE(block.Busy);
    scan();
    EXPECT_TRUE(block.Busy);
    EXPECT_FALSE(aborted());
    EXPECT_EQ(axes.calls_of("submit").size(), 2u);

    axes.finish(axes::Outcome::error, ErrorId::interlocked);
    scan();
    EXPECT_EQ(block.ErrorID, ErrorId::interlocked) << "follows the second";
}

// A slower task's request takes effect later than its next view: the id is still ahead of AxisView::last_id.
TEST_P(ExecuteRules, AnIdThatTheViewDoesNotKnowYetIsWaitedFor) {
    trigger(true);
    for (int i = 0; i < 5; ++i) {
        block(axes.context);  // no next_scan: the view stays old
        EXPECT_TRUE(block.Busy);
        EXPECT_FALSE(aborted());
    }
    scan();
    EXPECT_TRUE(active());
}

// Figure 7, case 3: Execute falls while the command waits; it takes control; it finishes.
TEST_P(ExecuteRules, ABufferedCommandIsBusyButNotActiveUntilItsTurn) {  // P1-074, P1-083
    if (has("BufferMode")) {
        axes.take_over();  // some other command runs
        block.BufferMode = mcBuffered;
        begin();
        EXPECT_TRUE(block.Busy);
        EXPECT_FALSE(active());
        trigger(false);
        scan();
        EXPECT_TRUE(block.Busy);

        axes.finish(axes::Outcome::done);
        scan();
        EXPECT_TRUE(active());
    }
}

}  // namespace
}  // namespace taktwerk::fb
