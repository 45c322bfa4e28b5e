#pragma once
// The thin bases of Execute blocks over ExecuteCore.
//
//   CommandBlock   a command of the axis: its `kind`, the inputs of the usual names, and `details() const` where the kind has some; taken
//                  at the edge and, with ContinuousUpdate, in each call. Inxxx instead of Done: `in_target_pin`. The axis acted on is Slave
//                  where there is one, otherwise Axis.
//   SettingBlock   something of the axis that is no motion, at once or queued. Says `AxisSetting setting() const` and has ExecutionMode.
//   ExecuteBlock   everything else: `start(ctx)` and `follow(ctx)`, both on `core_`; a block that must act on the falling edge says
//                  `released(ctx)`.
//
// A block with outputs of its own says `show(ctx)`: it runs last in each call and must be public.

#include <cstdint>

#include "core/time.hpp"
#include "fb_library/motion/execute_core.hpp"
#include "fb_library/motion/motion_types.hpp"
#include "fb_library/motion/shared_pins.hpp"

namespace taktwerk::fb {

template <class Block>
struct ExecuteBlock {
    using Self = Block;

    /// Real-time safe. Call it in every scan while Busy, whatever Execute is.
    void operator()(const MotionContext& ctx) noexcept {
        Block& block = static_cast<Block&>(*this);
        const auto edge = core_.begin(block.Execute);
        if (edge == ExecuteCore::Edge::rising) block.start(ctx);
        if constexpr (requires { block.released(ctx); })
            if (edge == ExecuteCore::Edge::falling) block.released(ctx);
        if (core_.running()) block.follow(ctx);
        core_.publish(block, edge);
        if constexpr (requires { block.show(ctx); }) block.show(ctx);
    }

    void warm_start(Instant) noexcept {
        Block& block = static_cast<Block&>(*this);
        core_.warm_start(requires { block.CommandAborted; });
        core_.publish(block);
    }

    /// A block that picks its axis otherwise says so by a function of this name.
    [[nodiscard]] AxisRef acted_on() const noexcept {
        const Block& block = static_cast<const Block&>(*this);
        if constexpr (requires { block.Slave; }) return block.Slave;
        else if constexpr (requires { block.Axis; }) return block.Axis;
        else return block.Output.axis;
    }

protected:
    ExecuteCore core_;
};

template <class Block>
struct CommandBlock : ExecuteBlock<Block> {
    /// The latch of the inputs as they are now.
    [[nodiscard]] axes::AxisCommand command() const noexcept {
        const Block& block = static_cast<const Block&>(*this);
        axes::AxisCommand command{.kind = Block::kind};
        if constexpr (requires { block.BufferMode; }) command.buffer_mode = block.BufferMode;
        if constexpr (requires { command.direction = block.Direction; }) command.direction = block.Direction;
        if constexpr (requires { block.Position; }) command.position = block.Position;
        if constexpr (requires { block.Distance; }) command.position = block.Distance;
        if constexpr (requires { block.PhaseShift; }) command.position = block.PhaseShift;
        if constexpr (requires { block.Velocity; }) command.velocity = block.Velocity;
        if constexpr (requires { block.VelocityDiff; }) command.velocity = block.VelocityDiff;
        if constexpr (requires { block.EndVelocity; }) command.end_velocity = block.EndVelocity;
        if constexpr (requires { block.Acceleration; }) command.acceleration = block.Acceleration;
        if constexpr (requires { block.Deceleration; }) command.deceleration = block.Deceleration;
        if constexpr (requires { block.Jerk; }) command.jerk = block.Jerk;
        if constexpr (requires { block.details(); }) command.details = block.details();
        return command;
    }

protected:
    friend ExecuteBlock<Block>;

    void start(const MotionContext& ctx) noexcept {
        const Block& block = static_cast<const Block&>(*this);
        this->core_.submit(ctx, block.acted_on(), block.command());
        if constexpr (requires { block.ContinuousUpdate; })
            if (block.ContinuousUpdate) this->core_.allow_updates();
    }

    void follow(const MotionContext& ctx) noexcept {
        const Block& block = static_cast<const Block&>(*this);
        if constexpr (requires { Block::in_target_pin; }) this->core_.follow(ctx, Completion::in_target);
        else this->core_.follow(ctx, Completion::done);
        if constexpr (requires { block.ContinuousUpdate; }) {
            if (!block.ContinuousUpdate) this->core_.end_updates();
            if (this->core_.updating()) this->core_.update(ctx, block.command());
        }
        if constexpr (!requires { block.CommandAborted; })
            if (this->core_.aborted()) this->core_.refuse(ErrorId::aborted_by_command);
    }
};

template <class Block>
struct SettingBlock : ExecuteBlock<Block> {
protected:
    friend ExecuteBlock<Block>;

    void start(const MotionContext& ctx) noexcept {
        const Block& block = static_cast<const Block&>(*this);
        const AxisRef axis = block.acted_on();
        if (ctx.view(axis) == nullptr) return this->core_.refuse(ErrorId::invalid_axis);
        if (block.ExecutionMode == mcDelayed) return this->core_.refuse(ErrorId::not_supported);  // Part 4's
        if (block.ExecutionMode == mcImmediately) return set_at_once(ctx, axis, block.setting());
        this->core_.submit(ctx, axis,
                           {.kind = axes::CommandKind::setting, .buffer_mode = mcBuffered, .details = axes::AxisSetting{block.setting()}});
    }

    /// For what is no axis' and has been done in this call.
    void start_at_once(const MotionContext& ctx) noexcept {
        this->core_.start({});
        start_cycle_ = ctx.cycle;
    }

    void follow(const MotionContext& ctx) noexcept {
        if (this->core_.command() == 0) {  // done at once: the views of the next scan show it
            if (ctx.cycle != start_cycle_) this->core_.finish();
            return;
        }
        this->core_.follow(ctx, Completion::done);
        if (this->core_.aborted()) this->core_.refuse(ErrorId::aborted_by_command);
    }

    void set_at_once(const MotionContext& ctx, AxisRef axis, const axes::AxisSetting& setting) noexcept {
        this->core_.set(ctx, axis, setting);
        start_cycle_ = ctx.cycle;
    }

private:
    std::uint64_t start_cycle_ = 0;
};

}  // namespace taktwerk::fb
