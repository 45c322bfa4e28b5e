#pragma once
// A piece of a stored path as a curve, checked along its length. Pure; service side.

#include "axes/group/move_shape.hpp"
#include "axes/group/path_source.hpp"

namespace taktwerk::axes {

/// Where a stored path has come to.
struct SegmentPlace {
    std::array<double, 3> at{};  ///< of the tool's point, u
    PathChart chart{};           ///< the orientation stays
    CarriedTool carried{};       ///< as the command was accepted
    double look = 1;             ///< u: at least so often along the way the members are looked at
};

/// The place where the members stand, with `out.carried`. Errors: no_kinematics, out_of_reach, ...
[[nodiscard]] ErrorId place_of(const MoveEnd& from, const MoveSpace& space, SegmentPlace& out);

/// Errors as of shape_of(). Empty: it leads nowhere.
[[nodiscard]] MoveShape segment_of(const PathItem& item, const SegmentPlace& place, const MoveEnd& from, const MoveSpace& space);

}  // namespace taktwerk::axes
