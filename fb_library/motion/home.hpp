#pragma once
// MC_Home: PLCopen Part 1 v2.0, 3.2. The sequence itself is the axis' configuration. Real-time safe.

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

    static constexpr auto kind = axes::CommandKind::home;
    static constexpr std::string_view summary = "Runs the axis' configured search for its reference.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis, &Self::Execute>(), in<&Self::Position>("u", "coordinate of the reference"),
                         shared<&Self::BufferMode>(), out<&Self::Done>("", "reference known and set, axis in Standstill"),
                         shared<&Self::Busy, &Self::Active, &Self::CommandAborted>(),
                         out<&Self::Error>("", "refused, or the reference was not found"), shared<&Self::ErrorID>());
    }
};

}  // namespace taktwerk::fb
