#pragma once
// The curve at a joint of a path of axes and a path of poses, either way round (G-060). It lies in the axes: there both sides have places with two
// derivatives. It is a polynomial of a length that is the one path's where it leaves it and the other's where it joins it. Pure; service side.

#include <optional>

#include "axes/group/move_shape.hpp"

namespace taktwerk::axes {

/// One of both paths: where it comes to the corner, or leaves it.
struct CornerSide {
    PathSection section;  ///< its length is what may be taken of it
    RunSection run;
    MemberVector near{};  ///< the members at the corner
    double room = 0;      ///< of its length, from the corner
};

/// How far from the corner the curve begins and ends.
struct MixedRequest {
    double distance = 0;            ///< u of the tool's point; 0: not by it
    double deviation = 0;           ///< u of it, that the curve's middle may be off; 0: any
    double before = 0, behind = 0;  ///< of each path's own length; 0: not by it
};

struct MixedCorner {
    PathElement curve;
    double before = 0, behind = 0;  ///< what it takes of each path's length
    bool cut = false;               ///< there was less room than was asked for
};

/// `tool`: of the path of poses. Nothing: no curve can be passed, it has to be stood at.
[[nodiscard]] std::optional<MixedCorner> mixed_corner(const CornerSide& before, const CornerSide& behind, const MixedRequest& request,
                                                      const Pose& tool, const MoveSpace& space);

}  // namespace taktwerk::axes
