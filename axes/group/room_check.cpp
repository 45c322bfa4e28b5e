#include "axes/group/room_check.hpp"

#include "axes/pose_math.hpp"

namespace taktwerk::axes {
namespace {

/// By how much a point of an arm may become faster until the next look.
constexpr double swing = 2;

double speed_of(const std::array<double, 6>& velocity) noexcept { return Eigen::Vector3d(velocity[0], velocity[1], velocity[2]).norm(); }

}  // namespace

double inside_until(double most, const MemberVector& from, const MemberVector& rate, const Pose& tool, const MoveSpace& space) {
    if (space.workspace == nullptr || space.arm == nullptr || !(most > 0)) return most;
    const auto at = [&](double t) {
        MemberVector q = from;
        for (std::size_t k = 0; k < space.members; ++k) q[k] += rate[k] * t;
        return joints_of(q);
    };
    if (!space.arm->forward(at(0), tool).miss.ok()) return most;  // of axes that have no pose nobody knows where the tool is
    return jog_inside_until(
        *space.workspace, most, [&](double t) { return space.arm->forward(at(t), tool).pose.position; },
        [&](double t) { return swing * speed_of(space.arm->moving(at(t), joints_of(rate), tool).velocity); });
}

PathHindrance room_at(const Workspace& workspace, const std::array<double, 3>& point) noexcept {
    PathHindrance at;
    at.room = static_cast<std::uint8_t>(std::min<std::size_t>(workspace.nearest_wall(point), PathHindrance::none));
    at.in_space = true;
    at.point = point;
    return at;
}

std::optional<PathHindrance> leaves_rooms(const PathSection& section, const RunSection& at, const MoveSpace& space) {
    if (space.workspace == nullptr || space.arm == nullptr) return std::nullopt;
    const double length = section.length;
    const auto look = [&](const auto& point, const auto& fastest) -> std::optional<PathHindrance> {
        const double inside = inside_until(*space.workspace, length, point, fastest);
        if (!(inside < length)) return std::nullopt;
        PathHindrance wall = room_at(*space.workspace, point(inside));
        wall.on_path = true;
        wall.part = inside / length;
        return wall;
    };
    if (at.through_arm) {
        // Of a path of poses s is the way of the point, and of its turns beside it.
        const auto point = [&](double s) {
            const auto p = section.at(section.begin + s).at;
            return std::array<double, 3>{p[0], p[1], p[2]};
        };
        return look(point, [](double) { return 1.0; });
    }
    const auto along = [&](double s) { return way_point(section, at, section.begin + s, space.arm, space.members, {}, 1); };
    if (!space.arm->forward(joints_of(along(0).q), at.carried.tool).miss.ok()) return std::nullopt;
    return look([&](double s) { return space.arm->forward(joints_of(along(s).q), at.carried.tool).pose.position; },
                [&](double s) {
                    const auto w = along(s);
                    return swing * speed_of(space.arm->moving(joints_of(w.q), joints_of(w.first), at.carried.tool).velocity);
                });
}

}  // namespace taktwerk::axes
