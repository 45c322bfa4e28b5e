#pragma once
// What MC_GroupJog and MC_GroupJogVector have in common: an input that is held moves the group, one that is let go stops it. Real-time safe.

#include <cstdint>

#include "axes/group/group_jog.hpp"
#include "fb_library/groups/group_block.hpp"

namespace taktwerk::fb {

/// What a jog block holds down in one call.
struct JogWish {
    axes::JointVector direction{};  ///< 0: nothing
    MC_CoordSystem frame = mcACS;
    axes::JogPins pins{};
    ErrorId error = ErrorId::none;  ///< of the inputs themselves

    [[nodiscard]] bool still() const noexcept { return direction == axes::JointVector{}; }
};

/// The lifecycle of both: presses, renews, lets go.
class JogCore {
public:
    void call(const MotionContext& ctx, GroupRef group, bool enable, const JogWish& wish) noexcept {
        if (!enable) return let_go(ctx);
        if (!enabled_) {
            *this = {};
            enabled_ = true;
        }
        const axes::GroupView* view = view_of(ctx, group);
        if (view == nullptr) return show(ErrorId::invalid_group);
        if (aborted_) return;
        follow(ctx, wish);
        if (aborted_ || command_ != 0) return;
        const bool same = wish.frame == tried_.frame && axes::GroupJog::same_way(wish.direction, tried_.direction);
        if (!same) error_ = ErrorId::none;
        if (wish.error != ErrorId::none) return show(wish.error);
        if (view->state == axes::GroupState::GroupDisabled) return show(ErrorId::group_disabled);
        if (view->state == axes::GroupState::GroupErrorStop) return show(ErrorId::in_error_stop);
        if (wish.still() || !same) tried_ = {};
        if (wish.still()) return show(ErrorId::none);
        if (!same) press(ctx, group, wish);
    }
    /// Last in each call.
    template <class Block>
    void publish(Block& block) const noexcept {
        block.Enabled = enabled_ && !aborted_ && error_ == ErrorId::none;
        block.Active = enabled_ && moves_;
        block.CommandAborted = enabled_ && aborted_;
        block.Error = enabled_ && error_ != ErrorId::none;
        block.ErrorID = enabled_ ? error_ : ErrorId::none;
    }
    void warm_start() noexcept {
        const bool enabled = enabled_;
        *this = {};
        enabled_ = aborted_ = enabled;  // nothing moves by itself after a restart
    }

private:
    void show(ErrorId error) noexcept { error_ = error; }

    void press(const MotionContext& ctx, GroupRef group, const JogWish& wish) noexcept {
        tried_ = wish;
        const auto answer = ctx.groups->submit(
            group, {.kind = axes::GroupCommandKind::jog, .frame = wish.frame, .target = wish.direction, .jog = wish.pins, .instance = this},
            ctx.owner);
        error_ = answer.error;
        command_ = answer.id;
        group_ = group;
    }

    /// What became of the command, and the lease.
    void follow(const MotionContext& ctx, const JogWish& wish) noexcept {
        moves_ = false;
        const axes::GroupView* view = command_ != 0 ? view_of(ctx, group_) : nullptr;
        if (view == nullptr) return;
        using Status = axes::CommandStatus;
        ErrorId error = ErrorId::none;
        switch (view->status(command_, &error)) {
            case Status::error: error_ = error != ErrorId::none ? error : ErrorId::aborted_by_axis_error; break;
            case Status::done: break;
            case Status::aborted: aborted_ = true; break;
            case Status::unknown:
                if (static_cast<std::int32_t>(command_ - view->last_id) <= 0) {
                    aborted_ = true;
                    break;
                }
                [[fallthrough]];
            default: return hold(ctx, wish, *view);
        }
        command_ = 0;
    }

    void hold(const MotionContext& ctx, const JogWish& wish, const axes::GroupView& view) noexcept {
        moves_ = view.path_velocity != 0;
        // Another frame is another press, from rest; with inputs that mean nothing it comes to rest.
        const bool usable = wish.error == ErrorId::none && wish.frame == tried_.frame;
        axes::HoldJog held{.id = command_};
        if (usable) {
            held.direction = wish.direction;
            held.velocity = wish.pins.velocity;
            held.acceleration = wish.pins.acceleration;
        }
        const auto error = ctx.groups->set(group_, held, ctx.owner);
        error_ = wish.error != ErrorId::none ? wish.error : error;
        tried_.direction = held.direction;
    }

    void let_go(const MotionContext& ctx) noexcept {
        if (enabled_ && command_ != 0 && view_of(ctx, group_) != nullptr)
            (void)ctx.groups->set(group_, axes::HoldJog{.id = command_}, ctx.owner);
        *this = {};
    }

    JogWish tried_{};  // the last press, with the direction that is held now
    GroupRef group_{};
    axes::CommandId command_ = 0;
    ErrorId error_ = ErrorId::none;
    bool enabled_ = false, moves_ = false, aborted_ = false;
};

/// Values that are no shares: invalid_override.
[[nodiscard]] inline ErrorId refuse_jog_shares(double velocity, double acceleration) noexcept {
    const bool usable = velocity >= 0 && velocity <= 1 && acceleration > 0 && acceleration <= 1;
    return usable ? ErrorId::none : ErrorId::invalid_override;
}

}  // namespace taktwerk::fb
