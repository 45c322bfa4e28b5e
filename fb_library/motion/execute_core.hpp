#pragma once
// The lifecycle of Execute blocks, once for all: PLCopen Part 1 v2.0, 2.4.1 (figures 7 and 8). Real-time safe.
//
//   * A rising Execute starts; the inputs are taken in that call only (the command's value is the latch, with its axis).
//   * Busy from the edge until the outcome; Active while the command controls the axis.
//   * Done, CommandAborted, Error: one of them, until Execute falls, and in any case for one call.
//   * A falling Execute changes nothing in the motion. A new edge while Busy starts anew; the former command's outcome is not shown.
//   * A new edge that is refused shows Error; what the axis was doing before goes on (an instance's error does not touch the axis).
//   * A new instance compares with FALSE: Execute TRUE in its first call is an edge.
//   * ContinuousUpdate TRUE at the edge: from the next call on the inputs go to the axis in each call, as long as it stays TRUE and the
//     block is Busy; once FALSE it never comes back for this command. Values that the axis refuses are not taken: the command goes on with the
//     last good ones and stays the block's (Error would end the block, P1-058, beside an axis that moves on).
//   * A command that another one aborts, on a block without CommandAborted, is an Error: aborted_by_command.

#include <cstdint>

#include "axes/axis/motion_context.hpp"

namespace taktwerk::fb {

/// What completes a command.
enum class Completion : std::uint8_t {
    done,       ///< Done, and the block is finished
    in_target,  ///< Inxxx follows "set value = commanded value" while the block stays Busy and Active
    done_held,  ///< MC_Stop: Done at standstill, although the command may stay active on the axis
};

class ExecuteCore {
public:
    enum class Edge : std::uint8_t { none, rising, falling };

    /// First thing in each call.
    constexpr Edge begin(bool execute) noexcept {
        const Edge edge = execute == execute_ ? Edge::none : execute ? Edge::rising : Edge::falling;
        execute_ = execute;
        if (!execute && finished()) phase_ = Phase::idle;
        if (updates_ == Updates::from_next_call) updates_ = Updates::now;
        return edge;
    }

    /// Gives the command to the axis; the answer comes at once.
    void submit(const axes::MotionContext& ctx, axes::AxisRef axis, axes::AxisCommand command) noexcept {
        if (ctx.view(axis) == nullptr) return refuse(axes::ErrorId::invalid_axis);
        command.instance = this;
        const axes::Submitted answer = ctx.requests->submit(axis, command, ctx.owner);
        if (answer.error != axes::ErrorId::none) return refuse(answer.error);
        axis_ = axis;
        command_ = answer.id;
        phase_ = Phase::waiting;
        updates_ = Updates::never;
    }

    /// Gives the axis a setting: command() is 0 when it is done at once, otherwise the id to follow.
    void set(const axes::MotionContext& ctx, axes::AxisRef axis, const axes::AxisSetting& setting) noexcept {
        const axes::Submitted answer = ctx.requests->set(axis, setting, ctx.owner);
        if (answer.error != axes::ErrorId::none) return refuse(answer.error);
        start(axis);
        command_ = answer.id;
    }

    // ContinuousUpdate. In the call of the edge the command has the inputs already.
    constexpr void allow_updates() noexcept {
        if (running()) updates_ = Updates::from_next_call;
    }
    constexpr void end_updates() noexcept { updates_ = Updates::never; }
    [[nodiscard]] constexpr bool updating() const noexcept { return updates_ == Updates::now && running(); }
    /// Gives the running command other inputs.
    void update(const axes::MotionContext& ctx, axes::AxisCommand command) noexcept {
        command.instance = this;
        (void)ctx.requests->update(axis_, command_, command, ctx.owner);
    }

    /// Reads what became of the command. An id that the view has not seen yet is on its way (a slower task's view is older
    /// than its request); one that it has forgotten was aborted long ago.
    void follow(const axes::MotionContext& ctx, Completion completion) noexcept {
        if (!running()) return;
        const axes::AxisView* view = ctx.view(axis_);
        if (view == nullptr) return refuse(axes::ErrorId::invalid_axis);
        if (command_ != 0 && command_ == view->active && !view->active_in_target) {  // on its way, in nearly every cycle
            phase_ = Phase::active;
            return;
        }
        follow_in(*view, completion);
    }
    /// The same in the view of whoever keeps the command: an axis, a group.
    template <class View>
    void follow_in(const View& view, Completion completion) noexcept {
        if (!running()) return;
        using Status = axes::CommandStatus;
        axes::ErrorId error = axes::ErrorId::none;
        switch (view.status(command_, &error)) {
            case Status::unknown: phase_ = static_cast<std::int32_t>(command_ - view.last_id) > 0 ? Phase::waiting : Phase::aborted; break;
            case Status::queued: phase_ = Phase::waiting; break;
            case Status::active: phase_ = Phase::active; break;
            case Status::in_target:
                phase_ = completion == Completion::done_held   ? Phase::done
                         : completion == Completion::in_target ? Phase::in_target
                                                               : Phase::active;
                break;
            case Status::done: phase_ = Phase::done; break;  // never of a motion without end: its successor aborts it
            case Status::aborted: phase_ = Phase::aborted; break;
            case Status::error: refuse(error != axes::ErrorId::none ? error : axes::ErrorId::aborted_by_axis_error); break;
        }
    }

    /// A command that no axis but a group has accepted.
    constexpr void accepted(axes::CommandId id) noexcept {
        start({});
        command_ = id;
    }

    // For blocks whose work is no axis command.
    constexpr void start(axes::AxisRef axis) noexcept {
        axis_ = axis;
        command_ = 0;
        phase_ = Phase::waiting;
    }
    constexpr void finish() noexcept { phase_ = Phase::done; }
    constexpr void refuse(axes::ErrorId error) noexcept {
        phase_ = Phase::error;
        error_ = error;
    }

    /// After a reboot: command ids mean nothing any more. Execute keeps its memory, so that nothing starts by itself.
    constexpr void warm_start(bool has_command_aborted) noexcept {
        if (running() && has_command_aborted) phase_ = Phase::aborted;
        else if (running()) refuse(axes::ErrorId::aborted_by_axis_error);
        command_ = 0;
    }

    /// The command controls the axis, or runs beside what does.
    [[nodiscard]] constexpr bool active() const noexcept { return phase_ == Phase::active || phase_ == Phase::in_target; }
    [[nodiscard]] constexpr bool in_target() const noexcept { return phase_ == Phase::in_target; }
    [[nodiscard]] constexpr bool done() const noexcept { return phase_ == Phase::done; }
    [[nodiscard]] constexpr bool aborted() const noexcept { return phase_ == Phase::aborted; }
    [[nodiscard]] constexpr bool running() const noexcept { return phase_ >= Phase::waiting && phase_ <= Phase::in_target; }
    [[nodiscard]] constexpr bool finished() const noexcept { return phase_ >= Phase::done; }
    /// The axis and command of the last accepted start; 0 = none.
    [[nodiscard]] constexpr axes::AxisRef axis() const noexcept { return axis_; }
    [[nodiscard]] constexpr axes::CommandId command() const noexcept { return command_; }

    /// Sets whichever of the standard's outputs the block has, where they are others than it has shown.
    template <class Block>
    constexpr void publish(Block& block, Edge edge) noexcept {
        if (edge != Edge::none || phase_ != shown_) publish(block);
    }
    template <class Block>
    constexpr void publish(Block& block) noexcept {
        shown_ = phase_;
        if constexpr (requires { block.Done; }) block.Done = phase_ == Phase::done;
        if constexpr (requires { Block::in_target_pin; }) block.*Block::in_target_pin = phase_ == Phase::in_target;
        if constexpr (requires { block.Busy; }) block.Busy = running();
        if constexpr (requires { block.Active; }) block.Active = active();
        if constexpr (requires { block.CommandAborted; }) block.CommandAborted = phase_ == Phase::aborted;
        block.Error = phase_ == Phase::error;
        block.ErrorID = phase_ == Phase::error ? error_ : axes::ErrorId::none;
    }

private:
    enum class Updates : std::uint8_t { never, from_next_call, now };
    enum class Phase : std::uint8_t { idle, waiting, active, in_target, done, aborted, error };

    axes::CommandId command_ = 0;
    axes::AxisRef axis_{};
    axes::ErrorId error_ = axes::ErrorId::none;
    Phase phase_ = Phase::idle;
    Phase shown_ = Phase::idle;
    bool execute_ = false;
    Updates updates_ = Updates::never;
};

}  // namespace taktwerk::fb
