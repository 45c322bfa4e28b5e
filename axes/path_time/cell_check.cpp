#include "axes/path_time/cell_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace taktwerk::axes {
namespace {

constexpr std::size_t verified_points = 10;  // per cell, and its beginning
// What interpolation over the whole cell may miss at its middle; over half a cell it misses a sixteenth of that (q''), an eighth (q''').
constexpr double may_miss_velocity = 4e-6, may_miss_acceleration = 3e-6, may_miss_jerk = 8e-4;
constexpr double looks_closer = 0.9;  // of a limit, from which on peaks between points count

/// q', q'', q''' over an interval through their values at its ends: a polynomial of the fifth degree for q'.
class Hermite {
public:
    Hermite(const TimedCurvePoint& a, const TimedCurvePoint& b, std::size_t axis, double length) : over_(1 / length) {
        const double slope = a.second[axis] * length, bend = a.third[axis] * length * length;
        const double w = b.first[axis] - a.first[axis] - slope - bend / 2, s = b.second[axis] * length - slope - bend,
                     u = b.third[axis] * length * length - bend;
        c_ = {a.first[axis], slope, bend / 2, 10 * w - 4 * s + u / 2, -15 * w + 7 * s - u, 6 * w - 3 * s + u / 2};
    }
    [[nodiscard]] double first(double t) const { return c_[0] + t * (c_[1] + t * (c_[2] + t * (c_[3] + t * (c_[4] + t * c_[5])))); }
    [[nodiscard]] double second(double t) const {
        return over_ * (c_[1] + t * (2 * c_[2] + t * (3 * c_[3] + t * (4 * c_[4] + t * (5 * c_[5])))));
    }
    [[nodiscard]] double third(double t) const {
        return over_ * over_ * (2 * c_[2] + t * (6 * c_[3] + t * (12 * c_[4] + t * (20 * c_[5]))));
    }

private:
    double over_;
    std::array<double, 6> c_;
};

using Samples = std::array<double, verified_points + 1>;

/// The greatest magnitude, with what a parabola through each three samples reaches between them.
double peak_of(const Samples& x) {
    double most = 0;
    for (const double v : x) most = std::max(most, std::fabs(v));
    if (most < looks_closer) return most;
    for (std::size_t i = 2; i < x.size(); ++i) {
        const double bend = x[i] - 2 * x[i - 1] + x[i - 2], slope = x[i] - x[i - 2];
        if (std::fabs(slope) < 2.2 * std::fabs(bend)) most = std::max(most, std::fabs(x[i - 1] - slope * slope / (8 * bend)));
    }
    return most;
}

double at_nodes(const Samples& x) { return std::max(std::fabs(x.front()), std::fabs(x.back())); }

}  // namespace

void CellCheck::sample(const TimedCurve& curve, std::span<const PathAxisLimits> limits, const std::vector<double>& nodes,
                       const std::vector<double>& breaks) {
    curve_ = &curve;
    limits_ = limits;
    const std::size_t n = nodes.size() - 1;
    begins_.resize(n);
    middles_.resize(n);
    ends_.resize(n);
    traits_.resize(n);
    std::size_t next = 0;
    for (std::size_t c = 0; c < n; ++c) {
        Traits& t = traits_[c];
        t.begin = nodes[c];
        t.length = nodes[c + 1] - nodes[c];
        while (next < breaks.size() && breaks[next] < nodes[c]) ++next;
        t.breaks_before = c == 0 || (next < breaks.size() && breaks[next] == nodes[c]);
        begins_[c] = c > 0 && !t.breaks_before ? ends_[c - 1] : curve.at(nodes[c], CurveSide::after);
        middles_[c] = curve.at(nodes[c] + t.length / 2, CurveSide::after);
        ends_[c] = curve.at(nodes[c + 1], CurveSide::before);
        judge(c);
    }
}

void CellCheck::judge(std::size_t cell) {
    Traits& t = traits_[cell];
    const TimedCurvePoint &a = begins_[cell], &m = middles_[cell], &b = ends_[cell];
    const auto same = [](const PathLimits& x, const PathLimits& y) {
        return x.velocity == y.velocity && x.acceleration == y.acceleration && x.deceleration == y.deceleration && x.jerk == y.jerk;
    };
    t.interpolates = same(a.path, m.path) && same(a.path, b.path);
    t.straight = t.interpolates;
    t.missed = {};
    LimitUse per_unit;
    for (std::size_t i = 0; i < limits_.size(); ++i) {
        const double size = std::max(std::fabs(a.first[i]), 1e-9);
        for (const TimedCurvePoint* p : {&a, &m, &b})
            t.straight = t.straight && std::fabs(p->second[i]) * t.length < 1e-9 * size &&
                         std::fabs(p->third[i]) * t.length * t.length < 1e-9 * size;
        per_unit.widen({std::fabs(a.first[i]) / limits_[i].velocity, std::fabs(a.first[i]) / limits_[i].acceleration,
                        std::fabs(a.first[i]) / limits_[i].jerk});
        const Hermite whole(a, b, i, t.length);
        t.missed.widen({std::fabs(whole.first(0.5) - m.first[i]) / limits_[i].velocity,
                        std::fabs(whole.second(0.5) - m.second[i]) / limits_[i].acceleration,
                        std::fabs(whole.third(0.5) - m.third[i]) / limits_[i].jerk});
    }
    if (t.straight) t.missed = per_unit;
}

CellUse CellCheck::straight_use(std::size_t cell, const CellSquares& q, double velocity_factor) const {
    const Traits& t = traits_[cell];
    const PathLimits& path = begins_[cell].path;
    double most = std::max(q.first, q.last);
    const double bend = q.first - 2 * q.middle + q.last, rise = q.middle - q.first;
    if (bend < 0 && rise > 0 && rise < -bend) most = std::max(most, q.first - rise * rise / bend);
    const double node = std::sqrt(std::max(q.first, q.last)), v = std::sqrt(most), c = std::fabs(bend) / (t.length * t.length);
    const double one = rise / t.length, two = (q.last - q.middle) / t.length, up = std::max(one, two), down = std::min(one, two);
    const double per_velocity = std::max(t.missed.velocity, 1 / (path.velocity * velocity_factor));
    CellUse use;
    use.peak = {v * per_velocity,
                std::max({std::max(up, -down) * t.missed.acceleration, up / path.acceleration, -down / path.deceleration}),
                c * v * std::max(t.missed.jerk, 1 / path.jerk)};
    use.nodes = {node * per_velocity, use.peak.acceleration, c * node * std::max(t.missed.jerk, 1 / path.jerk)};
    return use;
}

CellUse CellCheck::use(std::size_t cell, const CellSquares& q, double velocity_factor) const {
    const Traits& t = traits_[cell];
    if (t.straight) return straight_use(cell, q, velocity_factor);
    constexpr std::size_t half = verified_points / 2;
    Samples square{}, v{}, slope{}, x{}, y{}, z{};
    double most = 0;
    for (std::size_t k = 0; k <= verified_points; ++k) {
        const double u = static_cast<double>(k) / verified_points, w = 1 - u;
        square[k] = w * w * q.first + 2 * u * w * q.middle + u * u * q.last;
        v[k] = std::sqrt(square[k]);
        slope[k] = (w * (q.middle - q.first) + u * (q.last - q.middle)) / t.length;  // the acceleration
        most = std::max(most, v[k]);
    }
    const double c = (q.first - 2 * q.middle + q.last) / (t.length * t.length);
    const bool interpolates = t.interpolates && t.missed.velocity * most < may_miss_velocity &&
                              t.missed.acceleration * most * most < may_miss_acceleration &&
                              t.missed.jerk * most * most * most < may_miss_jerk;
    CellUse use;
    const auto look = [&] {
        use.peak.widen({peak_of(x), peak_of(y), peak_of(z)});
        use.nodes.widen({at_nodes(x), at_nodes(y), at_nodes(z)});
    };
    std::array<TimedCurvePoint, verified_points + 1> points;
    if (!interpolates)
        for (std::size_t k = 0; k <= verified_points; ++k)
            points[k] = k == 0                ? begins_[cell]
                        : k == half           ? middles_[cell]
                        : k < verified_points ? curve_->at(t.begin + t.length * static_cast<double>(k) / verified_points, CurveSide::after)
                                              : ends_[cell];
    for (std::size_t k = 0; k <= verified_points; ++k) {
        const PathLimits& path = interpolates ? begins_[cell].path : points[k].path;
        x[k] = v[k] / (path.velocity * velocity_factor);
        y[k] = slope[k] > 0 ? slope[k] / path.acceleration : -slope[k] / path.deceleration;
        z[k] = c * v[k] / path.jerk;
    }
    look();
    for (std::size_t i = 0; i < limits_.size(); ++i) {
        const double over_v = 1 / limits_[i].velocity, over_a = 1 / limits_[i].acceleration, over_j = 1 / limits_[i].jerk;
        const auto set = [&](std::size_t k, double first, double second, double third) {
            x[k] = first * v[k] * over_v;
            y[k] = (first * slope[k] + second * square[k]) * over_a;
            z[k] = (first * c + 3 * second * slope[k] + third * square[k]) * v[k] * over_j;
        };
        const auto exact = [&](std::size_t k, const TimedCurvePoint& p) { set(k, p.first[i], p.second[i], p.third[i]); };
        if (interpolates) {
            const TimedCurvePoint &a = begins_[cell], &m = middles_[cell], &b = ends_[cell];
            exact(0, a);
            exact(half, m);
            exact(verified_points, b);
            const Hermite one(a, m, i, t.length / 2), two(m, b, i, t.length / 2);
            for (std::size_t k = 1; k < half; ++k) {
                const double u = static_cast<double>(k) / half;
                set(k, one.first(u), one.second(u), one.third(u));
                set(half + k, two.first(u), two.second(u), two.third(u));
            }
        } else {
            for (std::size_t k = 0; k <= verified_points; ++k) exact(k, points[k]);
        }
        look();
    }
    return use;
}

}  // namespace taktwerk::axes
