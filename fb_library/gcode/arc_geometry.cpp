#include "fb_library/gcode/arc_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace taktwerk::gcode {
namespace {

using std::numbers::pi;

PlanePoint operator-(PlanePoint a, PlanePoint b) noexcept { return {a.first - b.first, a.second - b.second}; }
PlanePoint operator+(PlanePoint a, PlanePoint b) noexcept { return {a.first + b.first, a.second + b.second}; }
PlanePoint operator*(double k, PlanePoint a) noexcept { return {k * a.first, k * a.second}; }
double dot(PlanePoint a, PlanePoint b) noexcept { return a.first * b.first + a.second * b.second; }
double cross(PlanePoint a, PlanePoint b) noexcept { return a.first * b.second - a.second * b.first; }
double norm(PlanePoint a) noexcept { return std::hypot(a.first, a.second); }

/// From the direction of `start` to that of `end`; the same direction is a full turn.
double swept(PlanePoint start, PlanePoint end, ArcTurn turn) noexcept {
    const double angle = std::atan2(cross(start, end), dot(start, end));
    if (turn == ArcTurn::counter_clockwise) return angle > 0 ? angle : angle + 2 * pi;
    return angle < 0 ? angle : angle - 2 * pi;
}

/// How far the circle strays from the ring that the words describe: at its middle, and where it is nearest to the centre that they give.
double strays(PlanePoint start, PlanePoint shift, double angle, double radius, double wanted) noexcept {
    const auto off_at = [&](PlanePoint spoke) { return std::fabs(norm(shift + spoke) - wanted); };
    const double half = angle / 2;
    double most = off_at(
        {std::cos(half) * start.first - std::sin(half) * start.second, std::sin(half) * start.first + std::cos(half) * start.second});
    const double length = norm(shift);
    if (length == 0) return most;
    // Across the shift, where the way to the given centre is shortest. (The farthest point lies opposite, is passed when this one is, and strays less: the moved circle is the smaller one.)
    const PlanePoint spoke = -radius / length * shift;
    const double at = swept(start, spoke, angle > 0 ? ArcTurn::counter_clockwise : ArcTurn::clockwise);
    if (std::fabs(at) < std::fabs(angle)) most = std::max(most, off_at(spoke));
    return most;
}

}  // namespace

double ArcTolerance::limit(double radius) const noexcept { return std::max(absolute_mm, std::min(relative * radius, 100 * absolute_mm)); }

ArcAnswer arc_about(PlanePoint from, PlanePoint to, PlanePoint centre, ArcTurn turn, const ArcTolerance& tolerance) noexcept {
    using Kind = ArcAnswer::Kind;
    const auto start = from - centre, end = to - centre;
    const double start_radius = norm(start), end_radius = norm(end), chord = norm(to - from);
    if (std::min(start_radius, end_radius) <= same_point_mm) return {Kind::zero_radius};
    if (chord <= same_point_mm) return {Kind::found, {centre, turn == ArcTurn::counter_clockwise ? 2 * pi : -2 * pi}};
    const double limit = tolerance.limit(std::max(start_radius, end_radius));
    if (std::fabs(start_radius - end_radius) > limit) return {Kind::radii, {}, start_radius, end_radius};

    const auto along = 1 / chord * (to - from);
    const auto shift = -dot(centre - 0.5 * (from + to), along) * along;
    const auto moved = centre + shift;
    const double radius = norm(from - moved), wanted = (start_radius + end_radius) / 2;
    const double angle = swept(from - moved, to - moved, turn), said = swept(start, end, turn);
    const double off =
        std::max(strays(from - moved, shift, angle, radius, wanted), std::fabs(std::fabs(angle) * radius - std::fabs(said) * wanted));
    if (radius <= same_point_mm || off > limit) return {Kind::ends, {}, chord, off};
    return {Kind::found, {moved, angle}};
}

ArcAnswer arc_with_radius(PlanePoint from, PlanePoint to, double radius, ArcTurn turn, const ArcTolerance& tolerance) noexcept {
    using Kind = ArcAnswer::Kind;
    const double chord = norm(to - from), half = chord / 2, wanted = std::fabs(radius);
    if (wanted <= same_point_mm) return {Kind::zero_radius};
    if (chord <= same_point_mm) return {Kind::same_point};
    if (half - wanted > tolerance.limit(wanted)) return {Kind::too_far, {}, chord, wanted};
    const double used = std::max(half, wanted);
    const double height = std::sqrt((used - half) * (used + half));
    const double less = 2 * std::asin(half / used);
    const bool left = (turn == ArcTurn::counter_clockwise) == (radius > 0);
    const auto along = 1 / chord * (to - from);
    const PlanePoint across{-along.second, along.first};  // to the left of the chord
    const double angle = radius > 0 ? less : 2 * pi - less;
    return {Kind::found, {0.5 * (from + to) + (left ? height : -height) * across, turn == ArcTurn::counter_clockwise ? angle : -angle}};
}

}  // namespace taktwerk::gcode
