#pragma once
// What a command's position means for the members, and whether they may go there. Pure, real-time safe.

#include "axes/group/group_command.hpp"
#include "axes/group/group_members.hpp"

namespace taktwerk::axes {

/// Whether the group can read positions in this frame: no_kinematics, not_supported.
[[nodiscard]] ErrorId refuse_frame(MC_CoordSystem frame, GroupKinematics kinematics, const GroupMembers& members) noexcept;

/// Where the members go from `here`.
[[nodiscard]] JointVector target_of(const GroupCommand& command, const JointVector& here, const GroupMembers& members) noexcept;

/// Whether they may: invalid_position, not_homed (an absolute one), beyond_software_limit. In the members' coordinates a straight line whose ends are
/// inside is inside.
[[nodiscard]] ErrorId refuse_target(const GroupCommand& command, const JointVector& target, const GroupMembers& members) noexcept;

}  // namespace taktwerk::axes
