#pragma once
// Where the tool's point of a group may be: rooms that it stays in, and rooms that it stays out of. Not safety-rated: what protects people
// belongs in hardware. Pure, real-time safe.
//
// A path is looked at before it starts, over its whole length and its blends: the way to the nearest forbidden place says how far on along the
// path nothing can happen, so few looks show all of it. Only along a wall itself it goes in steps (inside_until()).

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "axes/pose.hpp"

namespace taktwerk::axes {

/// A room in the machine (MCS); lengths in u of the group.
struct WorkspaceRoom {
    enum class Shape : std::uint8_t { box, cylinder };
    std::string name{};  ///< for people
    Shape shape = Shape::box;
    bool kept_free = false;  ///< the point stays out of it; else inside
    Pose middle{};           ///< a cylinder stands along its Z
    /// Of a box: half of its edges along its own X, Y, Z. Of a cylinder: radius, radius, half of its height.
    std::array<double, 3> half{};
};

/// Where a point is, seen from a room: u from its surface, below 0 inside; and the direction in which that grows, of length 1. Rooms are convex: the distance of
/// any other point is at least what it is along that direction.
struct RoomPlace {
    double distance = 0;
    std::array<double, 3> outwards{};
};
[[nodiscard]] RoomPlace place_at(const WorkspaceRoom& room, const std::array<double, 3>& point) noexcept;

/// Inside one of the rooms that are not kept free, where there are such, and outside of all that are.
struct Workspace {
    std::vector<WorkspaceRoom> rooms{};

    /// u from the point to the nearest forbidden place at least; below 0: it is forbidden, that far from the nearest allowed one at least. Never
    /// changes by more than the point moves. Infinite without rooms. Some 10 ns a room.
    [[nodiscard]] double clearance(const std::array<double, 3>& point) const noexcept;
    /// Whose wall that is: a room that is kept free, or the one that is left there; its place in `rooms`.
    [[nodiscard]] std::size_t nearest_wall(const std::array<double, 3>& point) const noexcept;
};

/// A hair of a wall that a point may be beyond: of a way through the arm and back.
[[nodiscard]] double wall_digits(const std::array<double, 3>& point) noexcept;

/// Up to where a way from 0 to `length` is allowed; all of it: `length`. `at(s)`: the tool's point; `fastest(s)`: u that it goes for one of s,
/// from there on. One that begins where it is forbidden may only lead out of there. Looks 32 times at least. Beside a wall the steps grow from a
/// hair to a 4096th of the length: what cuts a corner by less there may be missed; what the way runs into is not.
template <class At, class Fastest>
[[nodiscard]] double inside_until(const Workspace& space, double length, const At& at, const Fastest& fastest) {
    constexpr double longest_look = 1.0 / 32, longest_hair = 1.0 / 4096;
    constexpr int bisections = 50;
    const auto start = at(0.0);
    double floor = std::min(0.0, space.clearance(start)), s = 0, inside = 0, hair = 0;
    for (;;) {
        const auto point = at(s);
        const double room = space.clearance(point), digits = wall_digits(point);
        if (room < floor - digits) break;
        floor = std::min(0.0, std::max(floor, room));
        inside = s;
        if (s >= length) return length;
        const double speed = fastest(s), free = std::max(room - floor, 0.0);
        double step = length * longest_look;
        if (speed * step > free) step = free / speed;
        if (step < length * longest_hair) {
            hair = std::min(hair > 0 ? 2 * hair : digits / speed, length * longest_hair);
            step = std::max(step, hair);
        } else {
            hair = 0;
        }
        s = std::min(length, s + step);
    }
    for (int i = 0; i < bisections; ++i) {
        const double middle = (inside + s) / 2;
        const auto point = at(middle);
        (space.clearance(point) < floor - wall_digits(point) ? s : inside) = middle;
    }
    return inside;
}

}  // namespace taktwerk::axes
