#include "axes/tables/cam_table.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {

namespace {

/// The points in rising order of the master, however they were written; segment i leads from point i to point i + 1.
class Rising {
public:
    explicit Rising(std::span<const CamPoint> points) noexcept
        : points_(points), falling_(points.size() > 1 && points[1].master < points[0].master) {}

    [[nodiscard]] std::size_t segments() const noexcept { return points_.size() - 1; }
    [[nodiscard]] const CamPoint& point(std::size_t i) const noexcept { return falling_ ? points_[points_.size() - 1 - i] : points_[i]; }
    [[nodiscard]] CamSegment kind(std::size_t i) const noexcept {
        return falling_ ? points_[points_.size() - 2 - i].segment : points_[i].segment;
    }
    [[nodiscard]] double width(std::size_t i) const noexcept { return point(i + 1).master - point(i).master; }
    [[nodiscard]] double slope(std::size_t i) const noexcept { return (point(i + 1).slave - point(i).slave) / width(i); }

private:
    std::span<const CamPoint> points_;
    bool falling_;
};

/// NaN as a velocity means a free end: only at the first or last point, where a spline begins or ends.
bool usable(const Rising& cam) noexcept {
    const std::size_t last = cam.segments();
    for (std::size_t i = 0; i <= last; ++i) {
        const auto& point = cam.point(i);
        if (!std::isfinite(point.master) || !std::isfinite(point.slave) || !std::isfinite(point.acceleration)) return false;
        if (i < last && !(cam.width(i) > 0)) return false;
        const bool open_end = (i == 0 && cam.kind(0) == CamSegment::spline) || (i == last && cam.kind(last - 1) == CamSegment::spline);
        if (!std::isfinite(point.velocity) && !(std::isnan(point.velocity) && open_end)) return false;
    }
    return true;
}

void make_linear(const Rising& cam, std::size_t i, double (&c)[6]) noexcept {
    c[0] = cam.point(i).slave;
    c[1] = cam.slope(i);
    c[2] = c[3] = c[4] = c[5] = 0;
}

LawEnd end_of(const CamPoint& point) noexcept {
    return {.slave = point.slave, .velocity = point.velocity, .acceleration = point.acceleration};
}

/// From the value and two derivatives at both ends.
void make_quintic(const Rising& cam, std::size_t i, double (&c)[6]) noexcept {
    const auto& from = cam.point(i);
    const auto& to = cam.point(i + 1);
    const double h = cam.width(i);
    // What the parabola out of the first point leaves open at the second one.
    const double position = to.slave - from.slave - h * (from.velocity + h * from.acceleration / 2);
    const double velocity = h * (to.velocity - from.velocity - h * from.acceleration);
    const double acceleration = h * h * (to.acceleration - from.acceleration);
    const double h3 = h * h * h;
    c[0] = from.slave;
    c[1] = from.velocity;
    c[2] = from.acceleration / 2;
    c[3] = (10 * position - 4 * velocity + acceleration / 2) / h3;
    c[4] = (-15 * position + 7 * velocity - acceleration) / (h3 * h);
    c[5] = (6 * position - 3 * velocity + acceleration / 2) / (h3 * h * h);
}

void make_cubic(const Rising& cam, std::size_t i, double begin_slope, double end_slope, double (&c)[6]) noexcept {
    const double h = cam.width(i), mean = cam.slope(i);
    c[0] = cam.point(i).slave;
    c[1] = begin_slope;
    c[2] = (3 * mean - 2 * begin_slope - end_slope) / h;
    c[3] = (begin_slope + end_slope - 2 * mean) / (h * h);
    c[4] = c[5] = 0;
}

}  // namespace

PreparedCam::PreparedCam(std::size_t room) : segments_(room > 1 ? room - 1 : 1) {}

// The slopes m of a cubic spline obey, at each inner point, m[i-1]/h[i-1] + 2 m[i] (1/h[i-1] + 1/h[i]) + m[i+1]/h[i] =
// 3 (s[i-1]/h[i-1] + s[i]/h[i]) with the widths h and mean slopes s: a tridiagonal system, solved by elimination and back substitution
// (Thomas). While it runs, a segment's coefficients hold what belongs to its first point: [1] the right side, later the slope; [2] the
// eliminated upper entry; [3] the second right side of a closed run.

void PreparedCam::solve_open_run(std::span<const CamPoint> points, std::size_t first, std::size_t count) noexcept {
    const Rising cam(points);
    const auto at = [&](std::size_t i) -> double(&)[6] { return segments_[first + i].coefficients; };
    const auto h = [&](std::size_t i) { return cam.width(first + i); };
    const auto s = [&](std::size_t i) { return cam.slope(first + i); };
    // The end of the run has the slope of a straight neighbour, else the one given at the point.
    const double begin = first > 0 && cam.kind(first - 1) == CamSegment::linear ? cam.slope(first - 1) : cam.point(first).velocity;
    const std::size_t past = first + count;
    const double end = past < cam.segments() && cam.kind(past) == CamSegment::linear ? cam.slope(past) : cam.point(past).velocity;

    const bool free_begin = std::isnan(begin), free_end = std::isnan(end);
    at(0)[1] = free_begin ? 3 * s(0) / 2 : begin;  // free: no second derivative, 2 m[0] + m[1] = 3 s[0]
    at(0)[2] = free_begin ? 0.5 : 0;
    for (std::size_t i = 1; i < count; ++i) {
        const double lower = 1 / h(i - 1), upper = 1 / h(i);
        const double pivot = 2 * (lower + upper) - lower * at(i - 1)[2];
        at(i)[1] = (3 * (s(i - 1) * lower + s(i) * upper) - lower * at(i - 1)[1]) / pivot;
        at(i)[2] = upper / pivot;
    }
    double next = free_end ? (3 * s(count - 1) - at(count - 1)[1]) / (2 - at(count - 1)[2]) : end;
    for (std::size_t i = count; i-- > 0;) {
        const double slope = at(i)[1] - at(i)[2] * next;
        make_cubic(cam, first + i, slope, next, at(i));
        next = slope;
    }
}

/// The run is the whole of a periodic cam: its end runs into its beginning, so the system has two corners (Sherman and Morrison).
void PreparedCam::solve_closed_run(std::span<const CamPoint> points) noexcept {
    const Rising cam(points);
    const std::size_t count = cam.segments();
    const auto at = [&](std::size_t i) -> double(&)[6] { return segments_[i].coefficients; };
    const auto before = [&](std::size_t i) { return i == 0 ? count - 1 : i - 1; };
    const double corner = 1 / cam.width(count - 1);
    const double shift = -2 * (corner + 1 / cam.width(0));  // taken off the first pivot, in proportion off the last

    for (std::size_t i = 0; i < count; ++i) {
        const double lower = 1 / cam.width(before(i)), upper = 1 / cam.width(i);
        double pivot = 2 * (lower + upper);
        if (i == 0) pivot -= shift;
        if (i == count - 1) pivot -= corner * corner / shift;
        double right = 3 * (cam.slope(before(i)) * lower + cam.slope(i) * upper);
        double second = (i == 0 ? shift : 0) + (i == count - 1 ? corner : 0);
        if (i > 0) {
            pivot -= lower * at(i - 1)[2];
            right -= lower * at(i - 1)[1];
            second -= lower * at(i - 1)[3];
        }
        at(i)[1] = right / pivot;
        at(i)[2] = i + 1 < count ? upper / pivot : 0;
        at(i)[3] = second / pivot;
    }
    for (std::size_t i = count - 1; i-- > 0;) {
        at(i)[1] -= at(i)[2] * at(i + 1)[1];
        at(i)[3] -= at(i)[2] * at(i + 1)[3];
    }
    const double part = corner / shift;
    const double share = (at(0)[1] + part * at(count - 1)[1]) / (1 + at(0)[3] + part * at(count - 1)[3]);
    for (std::size_t i = 0; i < count; ++i) at(i)[1] -= share * at(i)[3];
    const double closing = at(0)[1];
    for (std::size_t i = 0; i < count; ++i) make_cubic(cam, i, at(i)[1], i + 1 < count ? at(i + 1)[1] : closing, at(i));
}

ErrorId PreparedCam::prepare(std::span<const CamPoint> points, bool periodic, bool master_absolute, bool slave_absolute) noexcept {
    count_ = 0;
    length_ = stroke_ = 0;
    if (points.size() < 2 || points.size() - 1 > segments_.size()) return ErrorId::invalid_table;
    const Rising cam(points);
    if (!usable(cam)) return ErrorId::invalid_table;

    const std::size_t count = cam.segments();
    std::fill_n(segments_.begin(), count, Segment{});
    for (std::size_t i = 0; i < count;) {
        std::size_t run = 1;
        switch (cam.kind(i)) {
            case CamSegment::linear: make_linear(cam, i, segments_[i].coefficients); break;
            case CamSegment::quintic: make_quintic(cam, i, segments_[i].coefficients); break;
            case CamSegment::spline:
                while (i + run < count && cam.kind(i + run) == CamSegment::spline) ++run;
                if (periodic && run == count) solve_closed_run(points);
                else solve_open_run(points, i, run);
                break;
            default:
                if (!segments_[i].law.set(cam.kind(i), cam.width(i), end_of(cam.point(i)), end_of(cam.point(i + 1))))
                    return ErrorId::invalid_table;
        }
        i += run;
    }
    for (std::size_t i = 0; i < count; ++i) {
        segments_[i].begin = cam.point(i).master - cam.point(0).master;
        for (const double coefficient : segments_[i].coefficients)
            if (!std::isfinite(coefficient)) return ErrorId::invalid_table;  // points too close together to be told apart
    }
    count_ = count;
    begin_ = cam.point(0).master;
    length_ = cam.point(count).master - begin_;
    stroke_ = cam.point(count).slave - cam.point(0).slave;
    periodic_ = periodic;
    master_absolute_ = master_absolute;
    slave_absolute_ = slave_absolute;
    return ErrorId::none;
}

CamValue PreparedCam::at(double master) const noexcept {
    if (count_ == 0) return {};
    const auto first = segments_.begin();
    const auto after = std::upper_bound(first + 1, first + static_cast<std::ptrdiff_t>(count_), master,
                                        [](double value, const Segment& segment) { return value < segment.begin; });
    const auto& segment = *(after - 1);
    const auto& c = segment.coefficients;
    const double x = master - segment.begin;
    if (segment.law) {
        const auto value = segment.law.at(x);
        return {.position = value.position, .first = value.velocity, .second = value.acceleration};
    }
    return {.position = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5])))),
            .first = c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * 5 * c[5]))),
            .second = 2 * c[2] + x * (6 * c[3] + x * (12 * c[4] + x * 20 * c[5]))};
}

bool PreparedCam::same_as(const PreparedCam& other) const noexcept {
    return count_ == other.count_ && begin_ == other.begin_ && length_ == other.length_ && stroke_ == other.stroke_ &&
           periodic_ == other.periodic_ && master_absolute_ == other.master_absolute_ && slave_absolute_ == other.slave_absolute_ &&
           std::equal(segments_.begin(), segments_.begin() + static_cast<std::ptrdiff_t>(count_), other.segments_.begin());
}

}  // namespace taktwerk::axes
