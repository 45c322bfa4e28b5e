#pragma once
// MC_Stop and MC_Halt: PLCopen Part 1 v2.0, 3.3, 3.4. Real-time safe.
//
// MC_Stop locks the axis (state Stopping) while its Execute is TRUE, Done or not; only power off makes it CommandAborted. MC_Halt is an
// ordinary command: anything may take over during its ramp. Deceleration and Jerk 0 mean the axis' default in both.

#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

struct MC_Stop : CommandBlock<MC_Stop> {
    AxisRef Axis{};
    bool Execute = false;
    double Deceleration = 0, Jerk = 0;

    bool Done = false, Busy = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::stop;
    static constexpr std::string_view summary = "Stops the axis, ends whatever it does and locks it while Execute is TRUE.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis>(),  //
                         in<&Self::Execute>("", "a rising edge stops; the axis stays locked while TRUE"),
                         shared<&Self::Deceleration, &Self::Jerk>(), out<&Self::Done>("", "set velocity is zero"), shared<&Self::Busy>(),
                         out<&Self::CommandAborted>("", "power went off"), shared<&Self::Error, &Self::ErrorID>());
    }

private:
    friend ExecuteBlock<MC_Stop>;
    void follow(const MotionContext& ctx) noexcept { core_.follow(ctx, Completion::done_held); }
    /// Also during the ramp: the axis keeps the lock until it stands.
    void released(const MotionContext& ctx) noexcept {
        if (core_.command() != 0) ctx.requests->release_stop(core_.axis(), core_.command(), ctx.owner);
    }
};

struct MC_Halt : CommandBlock<MC_Halt> {
    AxisRef Axis{};
    bool Execute = false;
    double Deceleration = 0, Jerk = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::halt;
    static constexpr std::string_view summary = "Brings the axis to standstill; any other command may take over meanwhile.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute, &Self::Deceleration, &Self::Jerk, &Self::BufferMode>(),
                         out<&Self::Done>("", "set velocity is zero"), outcome<Self>());
    }
};

}  // namespace taktwerk::fb
