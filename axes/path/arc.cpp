#include "axes/path/arc.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace taktwerk::axes {
namespace {

using Eigen::Vector3d;

constexpr double same = 1e-9;  // of the size: points that coincide, directions that agree
constexpr double full_turn = 2 * std::numbers::pi;

Error wrong_points() {
    return {"path.arc_points", "", "the points of the arc coincide or lie on a line", "give three different points of a circle"};
}
Error wrong_plane(const char* what) { return {"path.arc_plane", "", what, "give the normal of its plane"}; }

/// The angle from a to b about the unit normal, in (0, 2 pi].
double turn(const Vector3d& a, const Vector3d& b, const Vector3d& normal) {
    const double angle = std::atan2(normal.dot(a.cross(b)), a.dot(b));
    return angle <= 0 ? angle + full_turn : angle;
}

PathElement make(const PathVector& from, const PathVector& to, const Vector3d& centre, const Vector3d& normal, double angle) {
    const Vector3d radius = from.head<3>() - centre;
    PathVector middle = from, a = PathVector::Zero(), b = PathVector::Zero(), drift = (to - from) / angle;
    middle.head<3>() = centre;
    a.head<3>() = radius;
    b.head<3>() = normal.cross(radius);
    drift.head<3>().setZero();
    return PathElement::arc(middle, a, b, drift, angle);
}

}  // namespace

Result<PathElement> arc_over_border(const PathVector& from, const Vector3d& border, const PathVector& to) {
    const Vector3d first = border - from.head<3>(), second = to.head<3>() - from.head<3>();
    const Vector3d across = first.cross(second);
    const double size = std::max(first.norm(), second.norm());
    if (!(across.norm() > same * size * size) || !((second - first).norm() > same * size)) return wrong_points();
    // The centre of the circle about the triangle, from its first corner.
    const Vector3d to_centre =
        (second.squaredNorm() * across.cross(first) + first.squaredNorm() * second.cross(across)) / (2 * across.squaredNorm());
    const Vector3d centre = from.head<3>() + to_centre, normal = across.normalized();
    return make(from, to, centre, normal, turn(-to_centre, to.head<3>() - centre, normal));
}

Result<PathElement> arc_about_centre(const PathVector& from, const Vector3d& centre, const PathVector& to, const Vector3d& normal,
                                     ArcSense sense, double tolerance) {
    const Vector3d start = from.head<3>(), end = to.head<3>();
    const double first = (start - centre).norm(), second = (end - centre).norm();
    if (!(first > 0) || !(second > 0)) return wrong_points();
    if (std::fabs(first - second) > std::max(tolerance, 1e-12 * first))
        return Error{"path.arc_radii", "", "begin and end of the arc are not equally far from its centre",
                     "correct the centre, or allow the difference by a tolerance"};
    Vector3d unit = normal;
    if (normal.norm() > 0) {
        unit.normalize();
    } else {
        unit = (start - centre).cross(end - centre);
        if (!(unit.norm() > same * first * second)) return wrong_plane("a half or full circle does not say in which plane it lies");
        unit.normalize();
    }
    if (sense == ArcSense::clockwise) unit = -unit;
    if (std::fabs(unit.dot(start - centre)) > std::max(tolerance, 1e-6 * first) ||
        std::fabs(unit.dot(end - centre)) > std::max(tolerance, 1e-6 * first))
        return wrong_plane("the arc does not lie in the plane that its normal says");
    if ((end - start).norm() <= std::max(tolerance, same * first)) {
        PathVector closed = to;
        closed.head<3>() = start;
        return make(from, closed, centre, unit, full_turn);
    }
    // The difference of the radii is spread: the centre goes to the perpendicular of the chord, in the plane.
    const Vector3d chord = end - start, middle = (start + end) / 2;
    Vector3d axis = unit - unit.dot(chord) / chord.squaredNorm() * chord;  // across the chord, which may lean a little
    axis.normalize();
    const Vector3d up = axis.cross(chord).normalized();
    const Vector3d moved = middle + up.dot(centre - middle) * up;
    return make(from, to, moved, axis, turn(start - moved, end - moved, axis));
}

Result<PathElement> arc_of_radius(const PathVector& from, const PathVector& to, const Vector3d& normal, ArcSense sense) {
    const Vector3d chord = to.head<3>() - from.head<3>();
    const double radius = normal.norm(), half = chord.norm() / 2;
    if (!(half > 0) || !(radius > 0)) return wrong_points();
    if (half > radius * (1 + same))
        return Error{"path.arc_radius", "", "the radius is less than half the distance between begin and end", "give a larger one"};
    const Vector3d unit = (sense == ArcSense::clockwise ? -normal : normal) / radius;
    if (std::fabs(unit.dot(chord)) > 1e-6 * half) return wrong_plane("the arc's end does not lie in the plane that its normal says");
    const double height = std::sqrt(std::max(0.0, radius * radius - half * half));
    const Vector3d centre = (from.head<3>() + to.head<3>()) / 2 + height * unit.cross(chord).normalized();
    return make(from, to, centre, unit, turn(from.head<3>() - centre, to.head<3>() - centre, unit));
}

}  // namespace taktwerk::axes
