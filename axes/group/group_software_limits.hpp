#pragma once
// The software limits of all members at once: those of the axes, there are no others (G-024). Real-time safe.

#include "axes/group/group_command.hpp"
#include "axes/group/group_members.hpp"

namespace taktwerk::axes {

/// All of them, or none and the first reason: invalid_parameter (not a number, the lower one not below the upper one), beyond_software_limit (a homed
/// member stands outside), member_moves, and what an axis says.
[[nodiscard]] ErrorId write_limits(const WriteSoftwareLimits& limits, GroupMembers& members, Owner owner) noexcept;

}  // namespace taktwerk::axes
