#include "fb_library/gcode_path/line_merger.hpp"

#include <cmath>

namespace taktwerk::gcode {
namespace {

double dot(const Point& a, const Point& b) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point minus(const Point& a, const Point& b) noexcept { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

}  // namespace

void LineMerger::begin(const Point& from, const Point& to) noexcept {
    from_ = from;
    ends_[0] = to;
    count_ = 1;
}

bool LineMerger::extend(const Point& to, double tolerance) noexcept {
    if (count_ == most) return false;
    const Point way = minus(to, from_);
    const double square = dot(way, way);
    if (!(square > 0)) return false;
    double before = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const Point at = minus(ends_[i], from_);
        const double along = dot(at, way) / square;
        const Point off = minus(at, {along * way[0], along * way[1], along * way[2]});
        // Backwards is another line, however near: what was to be gone twice is gone twice.
        if (along < before || along > 1 || dot(off, off) > tolerance * tolerance) return false;
        before = along;
    }
    ends_[count_++] = to;
    return true;
}

}  // namespace taktwerk::gcode
