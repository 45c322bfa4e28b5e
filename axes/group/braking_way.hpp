#pragma once
// Where the tool's point of a group goes while each member brakes by itself, on its own ramp, off the path. Real-time safe.

#include <array>

#include "axes/group/group_members.hpp"
#include "axes/group/workspace.hpp"
#include "axes/planner/motion.hpp"

namespace taktwerk::axes {

class Kinematics;

struct BrakingSpace {
    const Kinematics* arm = nullptr;
    const Workspace* workspace = nullptr;
    Pose tool{};
    double least = 0;  ///< u: as far as it may be beyond a wall, <= 0
};

/// If the members left the group in these states, `period` [s] apart: whether each of their set-points until they rest keeps the tool's point where it may
/// be. Away from walls that is one look; along one few, as far apart as the way is straight; only what nearly touches a wall is looked at in each of its
/// set-points, a stop of more than some 200 cycles at every second, third, ... of them. What the arm's levers are along the way is bounded by twice what they
/// are where it begins.
[[nodiscard]] bool brakes_inside(const std::array<MotionState, most_members>& from, const GroupMembers& members, double period,
                                 const BrakingSpace& space) noexcept;

}  // namespace taktwerk::axes
