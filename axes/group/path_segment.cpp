#include "axes/group/path_segment.hpp"

#include <algorithm>
#include <cmath>

#include "axes/pose_math.hpp"

namespace taktwerk::axes {
namespace {

PathVector as_path(const std::array<double, 3>& at) noexcept {
    PathVector v = PathVector::Zero();
    for (Eigen::Index i = 0; i < 3; ++i) v[i] = at[static_cast<std::size_t>(i)];
    return v;
}

PathElement arc_of(const PathItem& item, const PathVector& from, const PathVector& to) noexcept {
    const Eigen::Index n = item.normal;
    PathVector centre = as_path(item.centre), a = PathVector::Zero(), b = PathVector::Zero(), drift = PathVector::Zero();
    centre[n] = from[n];
    a.head<3>() = from.head<3>() - centre.head<3>();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    normal[n] = item.angle < 0 ? -1 : 1;
    b.head<3>() = normal.cross(a.head<3>());
    const double angle = std::abs(item.angle);
    drift[n] = (to[n] - from[n]) / angle;
    return PathElement::arc(centre, a, b, drift, angle);
}

}  // namespace

ErrorId place_of(const MoveEnd& from, const MoveSpace& space, SegmentPlace& out) {
    if (space.arm == nullptr) return ErrorId::no_kinematics;
    const ForwardResult here = space.arm->forward(joints_of(from.members), out.carried.tool);
    if (!here.miss.ok()) return ErrorId::out_of_reach;
    out.at = here.pose.position;
    out.chart = chart_at(here.pose, *space.arm);
    return ErrorId::none;
}

MoveShape segment_of(const PathItem& item, const SegmentPlace& place, const MoveEnd& from, const MoveSpace& space) {
    MoveShape shape;
    shape.through_arm = true;
    shape.chart = place.chart;
    shape.end = from;
    const PathVector a = as_path(place.at), b = as_path(item.to);
    if (item.kind == PathItem::Kind::line) {
        shape.empty = (b - a).norm() <= 1e-12 * std::max(1.0, a.norm());
        if (shape.empty) return shape;
        shape.element = PathElement::line(a, b);
    } else {
        shape.element = arc_of(item, a, b);
    }
    const double most = std::min(shape.element.feature(0), place.look);
    walk_along(shape, place.carried, from, space, static_cast<int>(std::clamp(shape.element.length() / most, 1.0, 2048.0)));
    return shape;
}

}  // namespace taktwerk::axes
