#pragma once
// MC_Stop and MC_Halt: PLCopen Part 1 v2.0, 3.3, 3.4. Real-time safe.
//
// MC_Stop locks the axis (state Stopping) while its Execute is TRUE, Done or not; only power off makes it CommandAborted. MC_Halt is an
// ordinary command: anything may take over during its ramp. Deceleration and Jerk 0 mean the axis' default in both.

#include <array>
#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

struct MC_Stop : CommandBlock<MC_Stop> {
    AxisRef Axis{};
    bool Execute = false;
    double Deceleration = 0, Jerk = 0;

    bool Done = false, Busy = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Stops the axis, ends whatever it does and locks it while Execute is TRUE.";
    static consteval auto pins() {
        return std::array{
            in_out<&Self::Axis>("", "axis acted on"),
            in<&Self::Execute>("", "a rising edge stops; the axis stays locked while TRUE"),
            in<&Self::Deceleration>("u/s2", "0 = the axis' default"),
            in<&Self::Jerk>("u/s3", "0 = the axis' default"),
            out<&Self::Done>("", "set velocity is zero"),
            out<&Self::Busy>("", "not finished"),
            out<&Self::CommandAborted>("", "power went off"),
            out<&Self::Error>("", "refused, or ended by an axis error"),
            out<&Self::ErrorID>("", "why"),
        };
    }

    [[nodiscard]] axes::AxisCommand command() const noexcept {
        return {.kind = axes::CommandKind::stop, .deceleration = Deceleration, .jerk = Jerk};
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

    static constexpr std::string_view summary = "Brings the axis to standstill; any other command may take over meanwhile.";
    static consteval auto pins() {
        return std::array{
            in_out<&Self::Axis>("", "axis acted on"),
            in<&Self::Execute>("", "a rising edge starts"),
            in<&Self::Deceleration>("u/s2", "0 = the axis' default"),
            in<&Self::Jerk>("u/s3", "0 = the axis' default"),
            in<&Self::BufferMode>("", "when the command takes effect"),
            out<&Self::Done>("", "set velocity is zero"),
            out<&Self::Busy>("", "not finished"),
            out<&Self::Active>("", "this command controls the axis"),
            out<&Self::CommandAborted>("", "another command took over, or power went off"),
            out<&Self::Error>("", "refused, or ended by an axis error"),
            out<&Self::ErrorID>("", "why"),
        };
    }

    [[nodiscard]] axes::AxisCommand command() const noexcept {
        return {.kind = axes::CommandKind::halt, .buffer_mode = BufferMode, .deceleration = Deceleration, .jerk = Jerk};
    }
};

}  // namespace taktwerk::fb
