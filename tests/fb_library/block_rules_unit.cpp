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
concept HasMotionOutputs = requires(B b) {
    b.Busy;
    b.ErrorID;
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

/// Gives the axis a command that the axis keeps until its end.
template <class B>
concept IsCommand = IsJog<B> || requires {
    B::kind;
};

template <class B>
struct StartsWork : std::bool_constant<(IsExecute<B> && HasMotionOutputs<B>) || IsJog<B>> {};
template <class B>
struct Commands : std::bool_constant<IsCommand<B>> {};
template <class B>
struct HasExecute : std::bool_constant<IsExecute<B> && IsCommand<B>> {};
template <class B>
struct HasEnable : std::bool_constant<IsEnable<B>> {};
template <class B>
    struct HasContinuousUpdate : std::bool_constant < requires(B b) {
    b.ContinuousUpdate;
} > {};
template <class B>
    struct HasInTarget : std::bool_constant < requires {
    B::in_target_pin;
} > {};
template <class B>
    struct IsQueuedSetting : std::bool_constant < requires(B b) {
    b.ExecutionMode;
} > {};

using WorkBlocks = Filter<StartsWork, decltype(detail::joined(MotionBlocks{}, HomingBlocks{}))>::type;  // Execute blocks and MC_Jog
using CommandBlocks = Filter<Commands, AllBlocks>::type;    // those of them that command an axis
using ExecuteBlocks = Filter<HasExecute, AllBlocks>::type;  // without MC_Jog, whose inputs are levels
using EnableBlocks = Filter<HasEnable, AllBlocks>::type;
using ContinuousUpdateBlocks = Filter<HasContinuousUpdate, AllBlocks>::type;
using InTargetBlocks = Filter<HasInTarget, AllBlocks>::type;
using SettingBlocks = Filter<IsQueuedSetting, AllBlocks>::type;

// --- driving any of them -------------------------------------------------------------------------------------------------

template <class B>
class Bench : public testing::Test {
protected:
    Bench() {
        if constexpr (requires { block.Master; }) block.Master = {1};
        aim(0);
        if constexpr (requires { block.Velocity; }) block.Velocity = 10;
        if constexpr (std::is_same_v<B, MC_Reset>) axes.axis().state = axes::AxisState::ErrorStop;
        if constexpr (IsJog<B>) block.Mode = mcJogContinuous;
        if constexpr (requires { block.ParameterNumber; }) block.ParameterNumber = axes::enable_limit_positive;  // a BOOL
        if constexpr (requires { block.Input; }) block.Input.axis = {0};
        if constexpr (requires { block.Output; }) block.Output.axis = {0};
        if constexpr (requires { block.Switches; }) {
            axes.context.tables = &tables;
            const axes::CamSwitch cams[]{{.track = 1, .first = 0, .last = 1}};
            block.Switches = tables.add_cam_switches(cams);
        }
        if constexpr (std::is_same_v<B, MC_ExtSetPointGenDisable>)
            axes.axis(0).active_kind = axes.axis(1).active_kind = axes::CommandKind::external;
        axes.next_scan();
    }
    /// Which axis it acts on.
    void aim(std::uint16_t index) {
        if constexpr (requires { block.CamTable; }) block.Master = {index};  // either of the two will do
        if constexpr (requires { block.Slave; }) block.Slave = {index};
        else if constexpr (requires { block.Axis; }) block.Axis = {index};
    }
    static constexpr bool names_an_axis = requires(B b) { b.Slave; }
    || requires(B b) { b.Axis; };
    /// Another number on every input that is one.
    void change_inputs(std::int32_t value) {
        const double real = value;
        for (const Pin& pin : B::pins()) {
            if (pin.direction != PinDirection::in) continue;
            char* const place = reinterpret_cast<char*>(&block) + pin.offset;
            if (pin.type.kind == PinKind::LREAL) std::memcpy(place, &real, sizeof real);
            if (pin.type.kind == PinKind::DINT || pin.type.kind == PinKind::UDINT) std::memcpy(place, &value, sizeof value);
        }
    }
    bool in_target() const {
        if constexpr (requires { B::in_target_pin; }) return block.*B::in_target_pin;
        else return false;
    }
    void trigger(bool level) {
        if constexpr (IsJog<B>) block.JogForward = level;
        else block.Execute = level;
    }
    void scan() {
        if constexpr (std::is_same_v<B, MC_ExtSetPointGenDisable>) axes.axis().active_kind = axes::CommandKind::external;
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
        else if constexpr (requires { B::in_target_pin; }) axes.axis().active_in_target = true;
        else if constexpr (IsCommand<B>) axes.finish(axes::Outcome::done);
    }

    bool aborted() const {
        if constexpr (CanBeAborted<B>) return block.CommandAborted;
        else return false;
    }
    /// CommandAborted, or on a block without it the error that says so.
    bool shows_abortion() const {
        if constexpr (CanBeAborted<B>) return block.CommandAborted;
        else return block.ErrorID == ErrorId::aborted_by_command;
    }
    bool done() const {
        if constexpr (HasDone<B>) return block.Done;
        else return false;
    }
    bool active() const {
        if constexpr (requires { block.Active; }) return block.Active;
        else return block.Busy;
    }
    /// Valid, or what the block has in its place.
    bool valid() const {
        if constexpr (requires { block.Valid; }) return block.Valid;
        else if constexpr (requires { block.Enabled; }) return block.Enabled;
        else return block.InOperation;
    }
    bool quiet() const { return !done() && !block.Busy && !aborted() && !block.Error && block.ErrorID == ErrorId::none; }

    FakeAxes axes{2};
    axes::MotionTables tables;
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

TYPED_TEST(ContinuousUpdateRules, ValuesThatTheAxisRefusesShowErrorAndEndTheUpdates) {
    this->block.ContinuousUpdate = true;
    this->begin();
    this->axes.refuse_with = ErrorId::invalid_dynamics;
    this->scan();
    EXPECT_EQ(this->block.ErrorID, ErrorId::invalid_dynamics);
    const auto before = this->axes.calls.size();
    this->axes.refuse_with = ErrorId::none;
    this->scan();
    EXPECT_TRUE(this->block.Error) << "held while Execute is TRUE";
    EXPECT_EQ(this->axes.calls.size(), before);
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

// --- settings: ExecutionMode ---------------------------------------------------------------------------------------------

template <class B>
class SettingRules : public Bench<B> {};
TYPED_TEST_SUITE(SettingRules, SettingBlocks);

TYPED_TEST(SettingRules, QueuedItWaitsForItsTurnLikeABufferedCommand) {  // P1-201, P1-215
    this->axes.take_over();                                              // a motion runs
    this->block.ExecutionMode = mcQueued;
    this->begin();
    ASSERT_EQ(this->axes.calls.size(), 1u);
    const auto& submitted = this->axes.calls[0];
    EXPECT_EQ(submitted.what, "submit");
    EXPECT_EQ(submitted.command.kind, axes::CommandKind::setting);
    EXPECT_EQ(submitted.command.buffer_mode, mcBuffered);
    this->scan();
    EXPECT_TRUE(this->block.Busy);
    EXPECT_FALSE(this->done());
    this->axes.finish(axes::Outcome::done);  // the motion
    this->axes.finish(axes::Outcome::done);  // the setting, whose turn it is
    this->scan();
    EXPECT_FALSE(this->block.Error);
}

TYPED_TEST(SettingRules, ClearedFromTheQueueItIsAnError) {  // no CommandAborted pin
    this->axes.take_over();
    this->block.ExecutionMode = mcQueued;
    this->begin();
    this->axes.last_slot.reset();
    this->axes.take_over();  // an aborting command clears the queue
    this->scan();
    EXPECT_EQ(this->block.ErrorID, ErrorId::aborted_by_command);
}

// --- blocks with an Enable -----------------------------------------------------------------------------------------------

template <class B>
class EnableRules : public Bench<B> {};
TYPED_TEST_SUITE(EnableRules, EnableBlocks);

TYPED_TEST(EnableRules, InvalidAxisIsAnErrorThatGoesWhenTheHandleIsMended) {  // P1-049
    if (!this->names_an_axis) return;
    this->aim(0xFFFF);
    this->block.Enable = true;
    this->scan();
    EXPECT_TRUE(this->block.Error);
    EXPECT_EQ(this->block.ErrorID, ErrorId::invalid_axis);
    EXPECT_FALSE(this->valid());
    if constexpr (requires { this->block.Busy; }) {
        EXPECT_TRUE(this->block.Busy);
        this->aim(0);
        this->scan();
        EXPECT_TRUE(this->valid());
        EXPECT_FALSE(this->block.Error);
        EXPECT_EQ(this->block.ErrorID, ErrorId::none);
    }
}

TYPED_TEST(EnableRules, EveryOutputGoesBackInTheCallInWhichEnableFalls) {  // P1-065
    const TypeParam fresh{};
    this->block.Enable = true;
    this->axes.axis().actual_position = 3;
    this->scan();
    EXPECT_TRUE(this->valid());

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
    this->aim(0xFFFF);
    this->block.Enable = true;
    this->scan();
    this->block.Enable = false;
    this->scan();
    EXPECT_FALSE(this->block.Error);
    EXPECT_EQ(this->block.ErrorID, ErrorId::none);
}

}  // namespace
}  // namespace taktwerk::fb
