#include "axes/group/group_words.hpp"

#include <array>

namespace taktwerk::axes {

std::string_view name(PathLimiter limiter) noexcept {
    constexpr std::array<std::string_view, 5> names{"none", "command", "axis_limit", "override_factor", "setup_velocity"};
    return names[static_cast<std::size_t>(limiter)];
}

std::string_view name(JogEnd end) noexcept {
    constexpr std::array<std::string_view, 7> names{"none", "distance", "axis_limit", "reach", "singularity", "workspace", "orientation"};
    return names[static_cast<std::size_t>(end)];
}

std::string_view name(MC_CoordSystem frame) noexcept {
    constexpr std::array<std::string_view, 13> names{"acs",   "mcs",   "wcs",   "pcs",   "fcs",   "tcs",  "pcs_2",
                                                     "pcs_3", "pcs_4", "pcs_5", "pcs_6", "pcs_7", "pcs_8"};
    static_assert(names.size() == mcPCS_8 + 1u);
    return names[frame];
}

std::string_view name(FrameTrack::Kind kind) noexcept {
    constexpr std::array<std::string_view, 3> names{"none", "belt", "table"};
    return names[static_cast<std::size_t>(kind)];
}

std::string_view name(GroupCommandKind kind) noexcept {
    constexpr std::array<std::string_view, 22> names{
        "none",
        "MC_MoveLinearAbsolute",
        "MC_MoveLinearRelative",
        "MC_MoveCircularAbsolute",
        "MC_MoveCircularRelative",
        "MC_MoveDirectAbsolute",
        "MC_MoveDirectRelative",
        "MC_MovePath",
        "MC_SyncGroupToAxis",
        "MC_GroupJog",
        "MC_GroupWaitTime",
        "MC_GroupHalt",
        "MC_GroupStop",
        "MC_GroupInterrupt",
        "MC_GroupContinue",
        "MC_GroupHome",
        "MC_GroupDisable",
        "MC_SetCoordinateTransform",
        "MC_GroupWriteToolData",
        "MC_TrackConveyorBelt",
        "MC_GroupSetPosition",
        "MC_GroupSetPosition",
    };
    static_assert(names.size() == static_cast<std::size_t>(GroupCommandKind::set_position_relative) + 1);
    return names[static_cast<std::size_t>(kind)];
}

}  // namespace taktwerk::axes
