#include "fb_library/gcode_path/line_merger.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace taktwerk::gcode {
namespace {

double dot(const Point& a, const Point& b) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point minus(const Point& a, const Point& b) noexcept { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// An arc needs points that say where it is: fewer of them lie on many.
constexpr std::size_t least_lines_of_arc = 4;
/// More than that is not one arc any more: the way round would be a guess.
constexpr double most_angle = 3;  // rad
constexpr double none = std::numeric_limits<double>::infinity();
/// Points that scatter about a line fit an arc, too: it has to come so much nearer.
constexpr double nearer = 0.5;

}  // namespace

void LineMerger::begin(const Point& from, const Point& to) noexcept {
    from_ = from;
    ends_[0] = to;
    count_ = 1;
    bent_ = false;
}

bool LineMerger::extend(const Point& to, double tolerance) noexcept {
    if (count_ == most) return false;
    Arc arc;
    const double line = off_line(to), bent = count_ + 1 >= least_lines_of_arc ? off_arc(to, tolerance, arc) : none;
    // What is an arc shall not become a line with corners.
    const bool is_arc = bent <= tolerance && (line > tolerance || bent <= nearer * line);
    if (!is_arc && !(line <= tolerance)) return false;  // what fitted so far stays as it is
    bent_ = is_arc;
    if (is_arc) arc_ = arc;
    ends_[count_++] = to;
    return true;
}

double LineMerger::off_line(const Point& to) const noexcept {
    const Point way = minus(to, from_);
    const double square = dot(way, way);
    if (!(square > 0)) return none;
    double before = 0, most = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const Point at = minus(ends_[i], from_);
        const double along = dot(at, way) / square;
        const Point off = minus(at, {along * way[0], along * way[1], along * way[2]});
        // Backwards is another line, however near: what was to be gone twice is gone twice.
        if (along < before || along > 1) return none;
        most = std::max(most, dot(off, off));
        before = along;
    }
    return std::sqrt(most);
}

/// Through the first point, the middle one and the last; in a plane of two axes of the machine.
double LineMerger::off_arc(const Point& to, double tolerance, Arc& arc) const noexcept {
    std::uint8_t normal = 3;
    for (std::uint8_t n = 0; n < 3; ++n) {
        bool flat = to[n] == from_[n];
        for (std::size_t i = 0; flat && i < count_; ++i) flat = ends_[i][n] == from_[n];
        if (flat) normal = n;
    }
    if (normal == 3) return none;
    const std::size_t u = (normal + 1u) % 3, v = (normal + 2u) % 3;
    const Point& middle = ends_[count_ / 2];
    const double ax = middle[u] - from_[u], ay = middle[v] - from_[v], bx = to[u] - from_[u], by = to[v] - from_[v];
    const double cross = ax * by - ay * bx, a2 = ax * ax + ay * ay, b2 = bx * bx + by * by;
    // A sagitta of less than a tenth of the tolerance is a line.
    if (std::fabs(cross) <= 0.2 * tolerance * std::sqrt(b2)) return none;
    const double cx = (by * a2 - ay * b2) / (2 * cross), cy = (ax * b2 - bx * a2) / (2 * cross);
    const double radius = std::hypot(cx, cy);
    // Around the centre, point by point: the same sense, each chord within the tolerance of its arc.
    double x = -cx, y = -cy, turned = 0, most = 0;
    for (std::size_t i = 0; i <= count_; ++i) {
        const Point& p = i < count_ ? ends_[i] : to;
        const double nx = p[u] - from_[u] - cx, ny = p[v] - from_[v] - cy;
        const double step = std::atan2(x * ny - y * nx, x * nx + y * ny);
        const double sagitta = radius * step * step / 8;
        if (step * cross <= 0) return none;
        most = std::max(most, std::fabs(std::hypot(nx, ny) - radius) + sagitta);
        turned += step;
        x = nx, y = ny;
    }
    if (std::fabs(turned) > most_angle) return none;
    arc.normal = normal;
    arc.angle = turned;
    arc.centre[u] = from_[u] + cx;
    arc.centre[v] = from_[v] + cy;
    arc.centre[normal] = from_[normal];
    return most;
}

}  // namespace taktwerk::gcode
