#pragma once
// The thin bases of Execute blocks over ExecuteCore.
//
// A motion block derives from CommandBlock and says `AxisCommand command() const`; optionally `ErrorId refusal() const` (inputs
// that this version cannot honour) and `in_target_pin` (Inxxx instead of Done). An administrative block derives from ExecuteBlock and
// says `start(ctx)` and `follow(ctx)`, both on `core_`; a block that must act on the falling edge says `released(ctx)`.

#include "core/time.hpp"
#include "fb_library/motion/execute_core.hpp"
#include "fb_library/motion/motion_types.hpp"

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
        core_.publish(block);
    }

    void warm_start(Instant) noexcept {
        Block& block = static_cast<Block&>(*this);
        core_.warm_start(requires { block.CommandAborted; });
        core_.publish(block);
    }

protected:
    ExecuteCore core_;
};

template <class Block>
struct CommandBlock : ExecuteBlock<Block> {
protected:
    friend ExecuteBlock<Block>;

    void start(const MotionContext& ctx) noexcept {
        const Block& block = static_cast<const Block&>(*this);
        if constexpr (requires { block.ContinuousUpdate; })
            if (block.ContinuousUpdate) return this->core_.refuse(ErrorId::not_supported);
        if constexpr (requires { block.refusal(); })
            if (const ErrorId error = block.refusal(); error != ErrorId::none) return this->core_.refuse(error);
        this->core_.submit(ctx, block.Axis, block.command());
    }

    void follow(const MotionContext& ctx) noexcept {
        if constexpr (requires { Block::in_target_pin; }) this->core_.follow(ctx, Completion::in_target);
        else this->core_.follow(ctx, Completion::done);
    }
};

}  // namespace taktwerk::fb
