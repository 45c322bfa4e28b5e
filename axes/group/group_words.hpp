#pragma once
// What a group does and what limits it, as people read it: stable words, as they are spelled in traces and JSON.

#include <string_view>

#include "axes/group/group_command.hpp"
#include "axes/group/group_view.hpp"

namespace taktwerk::axes {

/// "none", "command", "axis_limit", "override_factor": as of an axis' velocity.
[[nodiscard]] std::string_view name(PathLimiter limiter) noexcept;
[[nodiscard]] std::string_view name(JogEnd end) noexcept;
/// "acs", "mcs", "pcs", "pcs_2".
[[nodiscard]] std::string_view name(MC_CoordSystem frame) noexcept;
/// "belt", "table"; "none".
[[nodiscard]] std::string_view name(FrameTrack::Kind kind) noexcept;
/// The name of its block: "MC_MoveLinearAbsolute"; "none".
[[nodiscard]] std::string_view name(GroupCommandKind kind) noexcept;

}  // namespace taktwerk::axes
