#pragma once
// The thin bases of group blocks, over the lifecycle of all blocks.
//
//   GroupCommandBlock  a command of the group. Says `GroupCommand command() const`; `completion` where it is not plain Done.
//   GroupSettingBlock  something at once. Says `GroupSetting setting() const`, perhaps `ErrorId refuse() const` of its pins; Done in the next call.
//   GroupReadBlock     while Enable is TRUE. Says, public, `Reading read_group(const GroupView&)` (or with the context in front) and `clear()`.

#include <cstdint>

#include "fb_library/groups/group_pins.hpp"
#include "fb_library/motion/enable_core.hpp"
#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

template <class Block>
struct GroupCommandBlock : ExecuteBlock<Block> {
    /// Last in each call.
    void show(const MotionContext&) noexcept {
        Block& block = static_cast<Block&>(*this);
        const auto id = this->core_.running() ? this->core_.command() : 0;
        if constexpr (requires { block.CommandAccepted; }) block.CommandAccepted = id != 0;
        if constexpr (requires { block.CommandID; }) block.CommandID = {id};
    }

protected:
    friend ExecuteBlock<Block>;

    void start(const MotionContext& ctx) noexcept {
        const Block& block = static_cast<const Block&>(*this);
        if (view_of(ctx, block.AxesGroup) == nullptr) return this->core_.refuse(ErrorId::invalid_group);
        axes::GroupCommand command = block.command();
        command.instance = &this->core_;
        const auto answer = ctx.groups->submit(block.AxesGroup, command, ctx.owner);
        if (answer.error != ErrorId::none) return this->core_.refuse(answer.error);
        group_ = block.AxesGroup;
        this->core_.accepted(answer.id);
    }
    void follow(const MotionContext& ctx) noexcept {
        const axes::GroupView* view = view_of(ctx, group_);
        if (view == nullptr) return this->core_.refuse(ErrorId::invalid_group);
        this->core_.follow_in(*view, Completion::done);
        if constexpr (!requires(const Block& block) { block.CommandAborted; })
            if (this->core_.aborted()) this->core_.refuse(ErrorId::aborted_by_command);
    }

    GroupRef group_{};  // of the last accepted start
};

template <class Block>
struct GroupSettingBlock : ExecuteBlock<Block> {
protected:
    friend ExecuteBlock<Block>;

    void start(const MotionContext& ctx) noexcept {
        const Block& block = static_cast<const Block&>(*this);
        if (view_of(ctx, block.AxesGroup) == nullptr) return this->core_.refuse(ErrorId::invalid_group);
        if constexpr (requires { block.refuse(); })
            if (const ErrorId error = block.refuse(); error != ErrorId::none) return this->core_.refuse(error);
        const auto error = ctx.groups->set(block.AxesGroup, block.setting(), ctx.owner);
        if (error != ErrorId::none) return this->core_.refuse(error);
        this->core_.start({});
        start_cycle_ = ctx.cycle;
    }
    void follow(const MotionContext& ctx) noexcept {
        if (ctx.cycle != start_cycle_) this->core_.finish();
    }

private:
    std::uint64_t start_cycle_ = 0;
};

template <class Block>
struct GroupReadBlock : EnableBlock<Block> {
    [[nodiscard]] Reading read(const MotionContext& ctx) noexcept {
        Block& block = static_cast<Block&>(*this);
        const axes::GroupView* view = view_of(ctx, block.AxesGroup);
        if (view == nullptr) return Reading::unless(ErrorId::invalid_group);
        if constexpr (requires { block.read_group(ctx, *view); }) return block.read_group(ctx, *view);
        else return block.read_group(*view);
    }
};

}  // namespace taktwerk::fb
