#pragma once
// MC_SetBrake: a holding brake that the controller works. Not part of PLCopen; vendors have it under names of their own (B&R: MC_BR_BrakeControl).
// Real-time safe.
//
// With MC_Power alone a brake opens and closes by itself. This block closes it under power, at standstill, and opens it again; and, where the machine
// file permits it, opens it without power, to move the axis by hand.

#include <cstdint>
#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

struct MC_SetBrake : ExecuteBlock<MC_SetBrake> {
    AxisRef Axis{};
    bool Execute = false;
    bool Release = false;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    bool Released = false;

    static constexpr std::string_view summary = "Opens or closes the holding brake of an axis, where the controller works it.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), in<&Self::Release>("", "TRUE opens it, FALSE closes it"),
                         out<&Self::Done>("", "it is open, or closed, by the time that it needs"), outcome<Self>(),
                         out<&Self::Released>("", "it is open, whoever opened it"));
    }

    void show(const MotionContext& ctx) noexcept {
        const axes::AxisView* view = ctx.view(Axis);
        Released = view != nullptr && view->brake == axes::BrakeState::open;
    }

private:
    friend ExecuteBlock<MC_SetBrake>;
    static constexpr std::uint8_t patience = 100;  // calls until the order must be seen, also by a slower task

    void start(const MotionContext& ctx) noexcept {
        if (ctx.view(Axis) == nullptr) return core_.refuse(ErrorId::invalid_axis);
        core_.set(ctx, Axis, axes::SetBrake{Release});
        releases_ = Release;
        seen_ = false;
        calls_ = 0;
    }
    void follow(const MotionContext& ctx) noexcept {
        using State = axes::BrakeState;
        if (calls_++ == 0) return;  // the views of the next scan show it
        const axes::AxisView* view = ctx.view(core_.axis());
        if (view == nullptr) return core_.refuse(ErrorId::invalid_axis);
        const auto state = view->brake;
        if (state == (releases_ ? State::open : State::closed)) return core_.finish();
        const bool on_the_way = state == (releases_ ? State::opening : State::closing);
        seen_ = seen_ || on_the_way;
        if (!on_the_way && (seen_ || calls_ > patience)) core_.refuse(ErrorId::aborted_by_command);
        if (calls_ > patience) calls_ = patience;
    }

    bool releases_ = false, seen_ = false;
    std::uint8_t calls_ = 0;
};

}  // namespace taktwerk::fb
