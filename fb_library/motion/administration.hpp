#pragma once
// MC_Reset and MC_SetPosition: PLCopen Part 1 v2.0, 3.31, 3.17. Real-time safe.

#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

/// Done once the axis has left ErrorStop; Error when the axis has given up, or has not answered within `patience`: the cause is still there.
/// Outside ErrorStop it is Done at once (it may still acknowledge a warning of the drive). It never touches other blocks' outputs.
struct MC_Reset : ExecuteBlock<MC_Reset> {
    AxisRef Axis{};
    bool Execute = false;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    Instant started{};            ///< not a pin
    bool seen_resetting = false;  ///< not a pin

    /// Longer than an axis waits for its drive to acknowledge.
    static constexpr Duration patience = std::chrono::seconds{10};

    static constexpr std::string_view summary = "Clears the axis' errors: from ErrorStop to Standstill or Disabled.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), out<&Self::Done>("", "the axis is not in ErrorStop (any more)"),
                         shared<&Self::Busy>(), out<&Self::Error>("", "refused, or the cause is still there"), shared<&Self::ErrorID>());
    }

private:
    friend ExecuteBlock<MC_Reset>;
    void start(const MotionContext& ctx) noexcept {
        if (ctx.view(Axis) == nullptr) return core_.refuse(ErrorId::invalid_axis);
        if (const ErrorId error = ctx.requests->reset(Axis, ctx.owner); error != ErrorId::none) return core_.refuse(error);
        core_.start(Axis);
        started = ctx.now;
        seen_resetting = false;
    }
    void follow(const MotionContext& ctx) noexcept {
        const axes::AxisView* view = ctx.view(core_.axis());
        if (view == nullptr) return core_.refuse(ErrorId::invalid_axis);
        if (view->state != axes::AxisState::ErrorStop) return core_.finish();
        // Only what the axis says after it has begun: its last answer may still stand in the view.
        const bool given_up = seen_resetting && !view->resetting;
        seen_resetting = view->resetting;
        if (given_up) return core_.refuse(view->reset_error != ErrorId::none ? view->reset_error : ErrorId::reset_failed);
        if (ctx.now - started >= patience) core_.refuse(ErrorId::reset_failed);
    }
};

/// Done when the views show the new coordinates: at once in the call after the edge, queued when its turn came.
struct MC_SetPosition : SettingBlock<MC_SetPosition> {
    AxisRef Axis{};
    bool Execute = false;
    double Position = 0;
    bool Relative = false;
    MC_ExecutionMode ExecutionMode = mcImmediately;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Shifts the axis' coordinates: set and actual position alike, without motion.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(),
                         in<&Self::Position>("u", "the actual position's new value; with Relative added to it"),
                         in<&Self::Relative>("", "Position is a distance"), shared<&Self::ExecutionMode>(),
                         out<&Self::Done>("", "the position has its new value"), outcome<Self>());
    }

    [[nodiscard]] axes::SetPosition setting() const noexcept { return {Position, Relative}; }
};

}  // namespace taktwerk::fb
