// PLCopen's rules (Part 1 v2.0, section 2.4.1) over every block in the list. Rule numbers P1-nnn: docs of the clause list.
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <type_traits>

#include "fb_library/all_blocks.hpp"
#include "tests/fb_library/fake_axes.hpp"

namespace taktwerk::fb {
namespace {

// --- which rule is for which block ---------------------------------------------------------------------------------------

template <class B>
concept IsExecute = requires(B b) {
    b.Execute;
};
template <class B>
concept IsJog = requires(B b) {
    b.JogForward;
};
template <class B>
concept IsEnable = requires(B b) {
    b.Enable;
};
template <class B>
concept HasDone = requires(B b) {
    b.Done;
};
template <class B>
concept CanBeAborted = requires(B b) {
    b.CommandAborted;
};

template <template <class> class Wanted, class List, class... Kept>
struct Filter;
template <template <class> class Wanted, class... Kept>
struct Filter<Wanted, BlockList<>, Kept...> {
    using type = testing::Types<Kept...>;
};
template <template <class> class Wanted, class B, class... More, class... Kept>
struct Filter<Wanted, BlockList<B, More...>, Kept...>
    : std::conditional_t<Wanted<B>::value, Filter<Wanted, BlockList<More...>, Kept..., B>, Filter<Wanted, BlockList<More...>, Kept...>> {};

template <class B>
struct StartsWork : std::bool_constant<IsExecute<B> || IsJog<B>> {};
template <class B>
struct Commands : std::bool_constant<(IsExecute<B> || IsJog<B>)&&CanBeAborted<B>> {};
template <class B>
struct HasExecute : std::bool_constant<IsExecute<B> && CanBeAborted<B>> {};
template <class B>
struct HasEnable : std::bool_constant<IsEnable<B>> {};
template <class B>
    struct HasContinuousUpdate : std::bool_constant < requires(B b) {
    b.ContinuousUpdate;
} > {};

using WorkBlocks = Filter<StartsWork, MotionBlocks>::type;  // Execute blocks and MC_Jog
using CommandBlocks = Filter<Commands, AllBlocks>::type;    // those of them that command an axis
using ExecuteBlocks = Filter<HasExecute, AllBlocks>::type;  // without MC_Jog, whose inputs are levels
using EnableBlocks = Filter<HasEnable, AllBlocks>::type;
using ContinuousUpdateBlocks = Filter<HasContinuousUpdate, AllBlocks>::type;

// --- driving any of them -------------------------------------------------------------------------------------------------

template <class B>
class Bench : public testing::Test {
protected:
    Bench() {
        block.Axis = {0};
        if constexpr (requires { block.Velocity; }) block.Velocity = 10;
        if constexpr (std::is_same_v<B, MC_Reset>) axes.axis().state = axes::AxisState::ErrorStop;
        if constexpr (IsJog<B>) block.Mode = mcJogContinuous;
        axes.next_scan();
    }
    void trigger(bool level) {
        if constexpr (IsJog<B>) block.JogForward = level;
        else block.Execute = level;
    }
    void scan() {
        axes.next_scan();
        block(axes.context);
    }
    /// Starts the work and lets it become active.
    void begin() {
        trigger(true);
        block(axes.context);
        scan();
    }
    /// The block's work ends well; seen in the next scan.
    void complete() {
        if constexpr (std::is_same_v<B, MC_Reset>) axes.axis().state = axes::AxisState::Standstill;
        else if constexpr (std::is_same_v<B, MC_MoveVelocity>) axes.axis().active_in_target = true;
        else if constexpr (CanBeAborted<B>) axes.finish(axes::Outcome::done);
    }

    bool aborted() const {
        if constexpr (CanBeAborted<B>) return block.CommandAborted;
        else return false;
    }
    bool done() const {
        if constexpr (HasDone<B>) return block.Done;
        else return false;
    }
    bool active() const {
        if constexpr (requires { block.Active; }) return block.Active;
        else return block.Busy;
    }
    bool quiet() const { return !done() && !block.Busy && !aborted() && !block.Error && block.ErrorID == ErrorId::none; }

    FakeAxes axes{2};
    B block{};
};

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
    if constexpr (requires { block.Axis; }) block.Axis = {0};
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
    this->block.Axis = {};
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
// Active and Inxxx only while Busy; ErrorID if and only if Error. P1-058, P1-059, P1-068, P1-078.
TYPED_TEST(WorkRules, OutputsExcludeEachOtherInEveryOrderOfEvents) {
    std::mt19937 random{20110317};  // fixed: the same run each time
    bool level = false;
    int outcomes_seen = 0;
    for (int step = 0; step < 20000; ++step) {
        switch (random() % 8) {
            case 0: this->trigger(level = !level); break;
            case 1: this->complete(); break;
            case 2: this->axes.take_over(); break;
            case 3: this->axes.finish(axes::Outcome::error, ErrorId::aborted_by_axis_error); break;
            case 4: this->axes.refuse_with = random() % 2 ? ErrorId::state_forbids : ErrorId::none; break;
            case 5: this->axes.axis().state = random() % 2 ? axes::AxisState::ErrorStop : axes::AxisState::Standstill; break;
            case 6: this->axes.axis().active_in_target = random() % 2; break;
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
        if constexpr (requires { this->block.InVelocity; }) {
            if (this->block.InVelocity) {
                ASSERT_TRUE(this->block.Active) << step;
            }
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
    EXPECT_TRUE(this->aborted());
    EXPECT_FALSE(this->block.Busy);
    this->scan();
    EXPECT_TRUE(this->aborted());
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
    EXPECT_TRUE(this->aborted());
}

TYPED_TEST(CommandRules, TheCommandBelongsToTheAxisOfTheEdge) {  // P1-099
    this->block.Axis = {1};
    this->begin();
    this->block.Axis = {0};
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
    EXPECT_NE(this->axes.axis().active, 0u);
}

TYPED_TEST(ExecuteRules, InputsCountAtTheEdgeOnly) {  // P1-052
    this->begin();
    if constexpr (requires { this->block.Position; }) this->block.Position = 99;
    if constexpr (requires { this->block.Velocity; }) this->block.Velocity = 99;
    if constexpr (requires { this->block.Deceleration; }) this->block.Deceleration = 99;
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

template <class B>
class ContinuousUpdateRules : public Bench<B> {};
TYPED_TEST_SUITE(ContinuousUpdateRules, ContinuousUpdateBlocks);

TYPED_TEST(ContinuousUpdateRules, IsRefusedAtTheEdgeAsNotSupportedSoFar) {
    this->block.ContinuousUpdate = true;
    this->begin();
    EXPECT_EQ(this->block.ErrorID, ErrorId::not_supported);
    EXPECT_TRUE(this->axes.calls.empty());
}

TYPED_TEST(ContinuousUpdateRules, SetAfterTheEdgeHasNoEffect) {  // P1-103
    this->begin();
    this->block.ContinuousUpdate = true;
    this->block.Velocity = 99;
    this->scan();
    EXPECT_TRUE(this->block.Busy);
    EXPECT_EQ(this->axes.calls.size(), 1u);
}

// --- blocks with an Enable -----------------------------------------------------------------------------------------------

template <class B>
class EnableRules : public Bench<B> {};
TYPED_TEST_SUITE(EnableRules, EnableBlocks);

TYPED_TEST(EnableRules, InvalidAxisIsAnErrorThatGoesWhenTheHandleIsMended) {  // P1-049
    this->block.Axis = {};
    this->block.Enable = true;
    this->scan();
    EXPECT_TRUE(this->block.Error);
    EXPECT_EQ(this->block.ErrorID, ErrorId::invalid_axis);
    EXPECT_FALSE(this->block.Valid);
    if constexpr (requires { this->block.Busy; }) {
        EXPECT_TRUE(this->block.Busy);
        this->block.Axis = {0};
        this->scan();
        EXPECT_TRUE(this->block.Valid);
        EXPECT_FALSE(this->block.Error);
        EXPECT_EQ(this->block.ErrorID, ErrorId::none);
    }
}

TYPED_TEST(EnableRules, EveryOutputGoesBackInTheCallInWhichEnableFalls) {  // P1-065
    const TypeParam fresh{};
    this->block.Enable = true;
    this->axes.axis().actual_position = 3;
    this->scan();
    EXPECT_TRUE(this->block.Valid);

    this->block.Enable = false;
    this->scan();
    for (const Pin& pin : TypeParam::pins()) {
        if (pin.direction != PinDirection::out || pin.name == "Status") continue;  // MC_Power.Status is the power stage's
        EXPECT_EQ(std::memcmp(reinterpret_cast<const char*>(&this->block) + pin.offset, reinterpret_cast<const char*>(&fresh) + pin.offset,
                              pin.size),
                  0)
            << pin.name;
    }
}

TYPED_TEST(EnableRules, ErrorOutputsFallWithEnable) {  // P1-048
    this->block.Axis = {};
    this->block.Enable = true;
    this->scan();
    this->block.Enable = false;
    this->scan();
    EXPECT_FALSE(this->block.Error);
    EXPECT_EQ(this->block.ErrorID, ErrorId::none);
}

}  // namespace
}  // namespace taktwerk::fb
