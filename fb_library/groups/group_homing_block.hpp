#pragma once
// MC_GroupHome: PLCopen Part 4 v2.0. Real-time safe.

#include <string_view>

#include "fb_library/groups/group_block.hpp"

namespace taktwerk::fb {

/// In GroupStandby. One member after the other, by IdentInGroup, each as MC_Home would: by its own configuration.
struct MC_GroupHome : GroupCommandBlock<MC_GroupHome> {
    GroupRef AxesGroup{};
    bool Execute = false;
    MC_POS_REF Position{};
    MC_CoordSystem CoordSystem = mcACS;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAccepted = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Homes all members of the group, one after the other.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            grouped<&Self::AxesGroup, &Self::Execute>(),
            in<&Self::Position>("", "A: the coordinate of each member at its reference; NaN = the axis' configured offset"),
            in<&Self::CoordSystem>("", "mcACS; references are the axes' own"),
            in<&Self::BufferMode>("", "mcAborting or mcBuffered: in GroupStandby there is nothing to wait for"),
            out<&Self::Done>("", "all members are homed"),
            grouped<&Self::Busy, &Self::Active, &Self::CommandAccepted, &Self::CommandAborted, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept {
        return {.kind = axes::GroupCommandKind::home, .frame = CoordSystem, .buffer_mode = BufferMode, .target = Position.A.Axes};
    }
};

}  // namespace taktwerk::fb
