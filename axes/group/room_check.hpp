#pragma once
// Whether a piece of a path stays in the workspace of its group. Pure; service side.

#include <algorithm>
#include <optional>

#include "axes/group/move_shape.hpp"

namespace taktwerk::axes {

/// Where it ends to, and why; nothing: it stays inside. Of poses all of the piece is seen, of members' own lines it is looked at in steps (inside_until()).
[[nodiscard]] std::optional<PathHindrance> leaves_rooms(const PathSection& section, const RunSection& at, const MoveSpace& space);

/// Of a way that cannot go on from here.
[[nodiscard]] PathHindrance room_at(const Workspace& workspace, const std::array<double, 3>& point) noexcept;

/// inside_until() of a jog, in s. It has no end of its own where a member has none: of an hour a share would be no hair any more, and a way beside a wall
/// would miss what stands out of it. So it is looked at piece by piece.
template <class At, class Fastest>
[[nodiscard]] double jog_inside_until(const Workspace& space, double most, const At& at, const Fastest& fastest) {
    constexpr double first_piece = 1, longest_piece = 16;  // s
    double begin = 0;
    for (double piece = first_piece; begin < most; piece = std::min(2 * piece, longest_piece)) {
        const bool last = most - begin <= piece;
        const double length = last ? most - begin : piece;
        const double inside = inside_until(
            space, length, [&](double t) { return at(begin + t); }, [&](double t) { return fastest(begin + t); });
        if (inside < length) return begin + inside;
        begin = last ? most : begin + length;
    }
    return most;
}

/// Up to when the tool's point is where it may be, if the members go on at `rate` [u/s of each] from `from`; `most` at most, s.
[[nodiscard]] double inside_until(double most, const MemberVector& from, const MemberVector& rate, const Pose& tool,
                                  const MoveSpace& space);

}  // namespace taktwerk::axes
