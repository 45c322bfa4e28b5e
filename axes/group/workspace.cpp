#include "axes/group/workspace.hpp"

#include <cmath>
#include <limits>

#include "axes/pose_math.hpp"

namespace taktwerk::axes {
namespace {

/// From the point to the room's surface; below 0 inside.
double distance_to(const WorkspaceRoom& room, const std::array<double, 3>& point) noexcept {
    const Eigen::Vector3d away = Eigen::Vector3d(point[0], point[1], point[2]) - position_of(room.middle);
    const Eigen::Vector3d p = orientation_of(room.middle).conjugate() * away;
    if (room.shape == WorkspaceRoom::Shape::cylinder) {
        const double out = std::hypot(p.x(), p.y()) - room.half[0], over = std::abs(p.z()) - room.half[2];
        return std::min(std::max(out, over), 0.0) + std::hypot(std::max(out, 0.0), std::max(over, 0.0));
    }
    const Eigen::Vector3d beyond = p.cwiseAbs() - Eigen::Vector3d(room.half[0], room.half[1], room.half[2]);
    return std::min(beyond.maxCoeff(), 0.0) + beyond.cwiseMax(0.0).norm();
}

}  // namespace

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

double wall_digits(const std::array<double, 3>& point) noexcept {
    constexpr double digits = 1e-9;
    return digits * std::max({1.0, std::abs(point[0]), std::abs(point[1]), std::abs(point[2])});
}

}  // namespace taktwerk::axes
