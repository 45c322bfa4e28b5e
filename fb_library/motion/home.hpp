#pragma once
// MC_Home: PLCopen Part 1 v2.0, 3.2. The sequence itself is the axis' configuration. Real-time safe.

#include <array>
#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

struct MC_Home : CommandBlock<MC_Home> {
    AxisRef Axis{};
    bool Execute = false;
    double Position = 0;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Runs the axis' configured search for its reference.";
    static consteval auto pins() {
        return std::array{
            in_out<&Self::Axis>("", "axis acted on"),
            in<&Self::Execute>("", "a rising edge starts"),
            in<&Self::Position>("u", "coordinate of the reference"),
            in<&Self::BufferMode>("", "when the command takes effect"),
            out<&Self::Done>("", "reference known and set, axis in Standstill"),
            out<&Self::Busy>("", "not finished"),
            out<&Self::Active>("", "this command controls the axis"),
            out<&Self::CommandAborted>("", "another command took over, or power went off"),
            out<&Self::Error>("", "refused, or the reference was not found"),
            out<&Self::ErrorID>("", "why"),
        };
    }

    [[nodiscard]] axes::AxisCommand command() const noexcept {
        return {.kind = axes::CommandKind::home, .buffer_mode = BufferMode, .position = Position};
    }
};

}  // namespace taktwerk::fb
