#include "axes/group/workspace.hpp"

#include <cmath>
#include <limits>

#include "axes/pose_math.hpp"

namespace taktwerk::axes {
namespace {

/// From the point to the room's surface; below 0 inside. `p`: seen from the room's middle.
double distance_to(const WorkspaceRoom& room, const Eigen::Vector3d& p) noexcept {
    if (room.shape == WorkspaceRoom::Shape::cylinder) {
        const double out = std::hypot(p.x(), p.y()) - room.half[0], over = std::abs(p.z()) - room.half[2];
        return std::min(std::max(out, over), 0.0) + std::hypot(std::max(out, 0.0), std::max(over, 0.0));
    }
    const Eigen::Vector3d beyond = p.cwiseAbs() - Eigen::Vector3d(room.half[0], room.half[1], room.half[2]);
    return std::min(beyond.maxCoeff(), 0.0) + beyond.cwiseMax(0.0).norm();
}

Eigen::Vector3d seen_from_room(const WorkspaceRoom& room, const std::array<double, 3>& point) noexcept {
    return orientation_of(room.middle).conjugate() * (Eigen::Vector3d(point[0], point[1], point[2]) - position_of(room.middle));
}

double distance_to(const WorkspaceRoom& room, const std::array<double, 3>& point) noexcept {
    return distance_to(room, seen_from_room(room, point));
}

/// How fast distance_to() grows there; on an edge one of those that there are.
Eigen::Vector3d outwards(const WorkspaceRoom& room, const Eigen::Vector3d& p) noexcept {
    const auto sign = [](double value) { return value < 0 ? -1.0 : 1.0; };
    if (room.shape == WorkspaceRoom::Shape::cylinder) {
        const double radius = std::hypot(p.x(), p.y());
        const Eigen::Vector3d away = radius > 0 ? Eigen::Vector3d(p.x() / radius, p.y() / radius, 0) : Eigen::Vector3d::UnitX();
        const Eigen::Vector3d up = sign(p.z()) * Eigen::Vector3d::UnitZ();
        const double out = radius - room.half[0], over = std::abs(p.z()) - room.half[2];
        if (out > 0 && over > 0) return (out * away + over * up) / std::hypot(out, over);
        return out >= over ? away : up;
    }
    const Eigen::Vector3d signs(sign(p.x()), sign(p.y()), sign(p.z()));
    const Eigen::Vector3d beyond = p.cwiseAbs() - Eigen::Vector3d(room.half[0], room.half[1], room.half[2]);
    const Eigen::Vector3d over = beyond.cwiseMax(0.0);
    if (const double far = over.norm(); far > 0) return over.cwiseProduct(signs) / far;
    Eigen::Index nearest = 0;
    (void)beyond.maxCoeff(&nearest);
    return signs[nearest] * Eigen::Vector3d::Unit(nearest);
}

}  // namespace

RoomPlace place_at(const WorkspaceRoom& room, const std::array<double, 3>& point) noexcept {
    const Eigen::Vector3d p = seen_from_room(room, point);
    const Eigen::Vector3d direction = orientation_of(room.middle) * outwards(room, p);
    return {distance_to(room, p), {direction.x(), direction.y(), direction.z()}};
}

double Workspace::clearance(const std::array<double, 3>& point) const noexcept {
    constexpr double endless = std::numeric_limits<double>::infinity();
    double inside = -endless, outside = endless;
    for (const auto& room : rooms) {
        const double d = distance_to(room, point);
        if (room.kept_free) outside = std::min(outside, d);
        else inside = std::max(inside, -d);
    }
    return inside == -endless ? outside : std::min(inside, outside);
}

std::size_t Workspace::nearest_wall(const std::array<double, 3>& point) const noexcept {
    std::size_t left = rooms.size(), entered = rooms.size();
    double inside = 0, outside = 0;
    for (std::size_t i = 0; i < rooms.size(); ++i) {
        const double d = distance_to(rooms[i], point);
        if (rooms[i].kept_free && (entered == rooms.size() || d < outside)) {
            outside = d;
            entered = i;
        }
        if (!rooms[i].kept_free && (left == rooms.size() || -d > inside)) {
            inside = -d;
            left = i;
        }
    }
    return left == rooms.size() || (entered < rooms.size() && outside <= inside) ? entered : left;
}

double wall_digits(const std::array<double, 3>& point) noexcept {
    constexpr double digits = 1e-9;
    return digits * std::max({1.0, std::abs(point[0]), std::abs(point[1]), std::abs(point[2])});
}

}  // namespace taktwerk::axes
