#pragma once
// Whether a piece of a path stays in the workspace of its group. Pure; service side.

#include "axes/group/move_shape.hpp"

namespace taktwerk::axes {

/// outside_workspace, or none. Of poses it shows all of the piece, of members' own lines it looks in steps (inside_until()).
[[nodiscard]] ErrorId refuse_room(const PathSection& section, const RunSection& at, const MoveSpace& space);

/// Up to when the tool's point is where it may be, if the members go on at `rate` [u/s of each] from `from`; `most` at most, s.
[[nodiscard]] double inside_until(double most, const MemberVector& from, const MemberVector& rate, const Pose& tool,
                                  const MoveSpace& space);

}  // namespace taktwerk::axes
