#pragma once
// The rules that all blocks share, for typed tests: which rule is for which block of the list, and how to drive any of them.

#include <cstring>
#include <random>
#include <type_traits>

#include <gtest/gtest.h>

#include "fb_library/all_blocks.hpp"
#include "tests/fb_library/fake_axes.hpp"

namespace taktwerk::fb {

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
/// Those of groups act on no axis of their own: their rules are shown on a group (tests/fb_library/groups).
template <class B>
concept IsOfGroup = requires(B b) {
    b.AxesGroup;
};
template <class B>
struct HasEnable : std::bool_constant<IsEnable<B> && !IsOfGroup<B>> {};
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
using SettingBlocks = Filter<IsQueuedSetting, decltype(detail::joined(MotionBlocks{}, HomingBlocks{}))>::type;  // of an axis

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
        if constexpr (requires { block.ParameterNumber = axes::enable_limit_positive; })
            block.ParameterNumber = axes::enable_limit_positive;  // a BOOL
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
        for (const Pin& pin : pins_of<B>) {
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

}  // namespace taktwerk::fb
