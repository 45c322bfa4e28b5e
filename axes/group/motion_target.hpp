#pragma once
// What a command's position means for the members, and whether they may go there, as far as that is known without the whole way. Pure, real-time safe.

#include "axes/group/group_equipment.hpp"
#include "axes/group/group_members.hpp"

namespace taktwerk::axes {

class Kinematics;

/// Members 1, 2, ... are all joints of the arm, and there are no others.
[[nodiscard]] bool has_all_joints(const Kinematics* arm, const GroupMembers& members) noexcept;

/// Whether the group can read positions in the command's frame: no_kinematics (arcs need one in ACS too: there is no plane), not_supported.
[[nodiscard]] ErrorId refuse_frame(const GroupCommand& command, const Kinematics* arm, const GroupMembers& members) noexcept;

/// Where the members go from `here`; in other frames than ACS where they are.
[[nodiscard]] JointVector target_of(const GroupCommand& command, const JointVector& here, const GroupMembers& members) noexcept;

/// An absolute position that says no turn (RX, RY, RZ are 0), to an arm that cannot turn: its tool stays turned as it is, however the frame is turned.
[[nodiscard]] bool keeps_turn(const GroupCommand& command, const Kinematics& arm) noexcept;

/// Whether the arm reaches an absolute position, whichever way it stands then: out_of_reach, beyond_software_limit.
[[nodiscard]] ErrorId refuse_reach(const GroupCommand& command, const CommandPlace& place, const JointVector& here,
                                   const Kinematics* arm) noexcept;

/// Of a command that was refused with this when it was given: whose limit, which member, where its target is.
[[nodiscard]] PathHindrance hindrance_of(ErrorId error, const GroupCommand& command, const CommandPlace& place, const JointVector& here,
                                         const Kinematics* arm, const GroupMembers& members) noexcept;

/// It is there already: in ACS.
[[nodiscard]] bool goes_nowhere(const GroupCommand& command, const JointVector& here, const GroupMembers& members) noexcept;

/// Whether they may: invalid_position, not_homed (an absolute one), beyond_software_limit. In the members' coordinates a straight line whose ends are
/// inside is inside.
[[nodiscard]] ErrorId refuse_target(const GroupCommand& command, const JointVector& target, const GroupMembers& members) noexcept;

}  // namespace taktwerk::axes
