#pragma once
// What is set of a group at once beside its motion. Plain data, trivially copyable.

#include <array>
#include <cstdint>

#include "axes/group/group_types.hpp"
#include "axes/kinematics/joints.hpp"
#include "axes/kinematics/tools.hpp"

namespace taktwerk::axes {

/// MC_GroupSelectTool: of the commands that are accepted from now on.
struct SelectTool {
    std::uint8_t number = 0;
};
/// MC_GroupSelectPayload, likewise.
struct SelectPayload {
    std::uint8_t number = 0;
};
/// MC_GroupWritePayloadData.
struct WritePayload {
    std::uint8_t number = 0;
    RigidBody body{};
};
/// MC_GroupWriteRigidBodyDynamic: all of them, the first `count`.
struct WriteBodies {
    std::uint8_t count = 0;
    std::array<RigidBody, most_moved_members> bodies{};
};
/// Of set_position: from then on the group is there, without motion.
struct SetGroupPosition {
    MC_CoordSystem frame = mcACS;
    bool relative = false;
    JointVector target{};    ///< as a command's
    Configuration wanted{};  ///< of the arm, in other frames than ACS
};

}  // namespace taktwerk::axes
