#pragma once
// A jog as a curve: the straight line from where the members stand to where it cannot go on - a limit of a member or of the arm, the arm's reach, the
// neighbourhood of a singularity, the distance that was asked for. Its release is a halt on that line. Pure; service side.

#include "axes/group/move_shape.hpp"

namespace taktwerk::axes {

/// Nearer to a singularity than this measure no jog of the pose goes; from nearer it leads away only. A path of commands goes as near as 0.01.
inline constexpr double jog_margin = 0.02;

/// `empty`: it stands at the end already. Errors: beyond_software_limit (a member stands outside its limits), invalid_position (a distance that is shorter than any way);
/// of the pose singular_path (nearer than a measure of 0.01), out_of_reach (the members stand as no pose has them: a beam that is askew).
[[nodiscard]] MoveShape jog_shape(const GroupOrder& move, const MoveEnd& from, const MoveSpace& space);

}  // namespace taktwerk::axes
