#pragma once
// A command as a curve: from where the move before it ends, checked along its whole length before anything moves. Pure; service side.

#include <optional>
#include <vector>

#include "axes/group/group_link.hpp"
#include "axes/group/workspace.hpp"
#include "core/result.hpp"

namespace taktwerk::axes {

/// Where a chain of moves has come to.
struct MoveEnd {
    MemberVector members{};
    Configuration configuration;  ///< of the arm there, turns left open
};

struct MoveShape {
    ErrorId error = ErrorId::none;
    bool empty = false;  ///< it is there already
    PathElement element;
    PathChart chart{};
    bool through_arm = false;
    std::optional<PathFeed> feed;       ///< instead of the command's
    std::vector<MemberVector> members;  ///< along it, at even distances
    MoveEnd end;
    JogEnd jog_end = JogEnd::none;  ///< of a jog that stands: why
    PathHindrance at{};             ///< of `error`, of `jog_end`: members by rank
};

struct MoveSpace {
    const Kinematics* arm = nullptr;
    std::size_t members = 0;
    std::array<MemberLimits, max_path_axes> limits{};
    double tool_velocity = unlimited;      ///< u/s of the tool's point
    const Workspace* workspace = nullptr;  ///< where the tool's point may be; nullptr: anywhere
};

/// Errors: out_of_reach, singular_path, beyond_software_limit, outside_workspace, invalid_arc, half_turn, no_kinematics.
[[nodiscard]] MoveShape shape_of(const GroupOrder& move, const MoveEnd& from, const MoveSpace& space);

/// Everywhere along its element, in so many steps: reached by the same way of the arm, inside the limits, not singular; and inside the workspace. Fills `members` and `end`, or `error`.
void walk_along(MoveShape& shape, const CarriedTool& carried, const MoveEnd& from, const MoveSpace& space, int steps);

/// Of a path that begins with this pose.
[[nodiscard]] PathChart chart_at(const Pose& pose, const Kinematics& arm) noexcept;

/// A blend's points, likewise. none: it can be gone.
[[nodiscard]] ErrorId refuse_blend(const PathSection& blend, const RunSection& at, const MoveEnd& near, const MoveSpace& space);

}  // namespace taktwerk::axes
