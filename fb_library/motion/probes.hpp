#pragma once
// MC_TouchProbe and MC_AbortTrigger: PLCopen Part 1 v2.0, 3.33, 3.34. Real-time safe.

#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

/// Single shot. A probe of the drive gives the position at the edge itself; it waits for events some cycles after Execute rose. A
/// switch or an input of the machine is seen once per cycle: its position is uncertain by half the way of one cycle to either side.
/// In every state of the axis, also Disabled. Execute rising again while Busy begins anew.
struct MC_TouchProbe : CommandBlock<MC_TouchProbe> {
    AxisRef Axis{};
    TriggerRef TriggerInput{};
    bool Execute = false;
    bool WindowOnly = false;
    double FirstPosition = 0;
    double LastPosition = 0;

    bool Done = false, Busy = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};
    double RecordedPosition = 0;

    static constexpr axes::CommandKind kind = axes::CommandKind::touch_probe;
    [[nodiscard]] axes::ProbeDetails details() const noexcept {
        return {TriggerInput, core_.running() ? core_.command() : axes::CommandId{0}, WindowOnly, FirstPosition, LastPosition};
    }

    static constexpr std::string_view summary = "Records the axis' position at the first trigger event after the edge.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            shared<&Self::Axis>(), in_out<&Self::TriggerInput>("", "a probe or switch of the drive, or an input of the machine"),
            in<&Self::Execute>("", "a rising edge arms the probe"),
            in<&Self::WindowOnly>("", "events outside FirstPosition to LastPosition do not count"),
            in<&Self::FirstPosition>("u", "window's begin in positive sense, included; on a modulo axis it may be above LastPosition"),
            in<&Self::LastPosition>("u", "window's end, included"), out<&Self::Done>("", "recorded"), shared<&Self::Busy>(),
            out<&Self::CommandAborted>("", "by MC_AbortTrigger"), shared<&Self::Error, &Self::ErrorID>(),
            out<&Self::RecordedPosition>("u", "where the axis was at the event; 0 until there is one"));
    }

    /// Not a pin: the core calls it last in each call.
    void show(const MotionContext& ctx) noexcept {
        if (core_.running()) RecordedPosition = 0;
        const axes::AxisView* view = ctx.view(core_.axis());
        if (!core_.done() || view == nullptr) return;
        for (std::size_t i = 0; i < view->probe_latched.size(); ++i)
            if (view->probe_latched[i] == core_.command()) RecordedPosition = view->probe_position[i];
    }
};

/// Ends the MC_TouchProbe that waits for the same trigger. Error with probe_idle when none does.
struct MC_AbortTrigger : CommandBlock<MC_AbortTrigger> {
    AxisRef Axis{};
    TriggerRef TriggerInput{};
    bool Execute = false;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr axes::CommandKind kind = axes::CommandKind::abort_trigger;
    [[nodiscard]] axes::ProbeDetails details() const noexcept { return {.trigger = TriggerInput, .replaces = 0}; }

    static constexpr std::string_view summary = "Ends the probing command that waits for a trigger.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis>(), in_out<&Self::TriggerInput>("", "as at the MC_TouchProbe"), shared<&Self::Execute>(),
                         out<&Self::Done>("", "nobody waits for the trigger any more"), outcome<Self>());
    }
};

}  // namespace taktwerk::fb
