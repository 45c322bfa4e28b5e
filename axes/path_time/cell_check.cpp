#include "axes/path_time/cell_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace taktwerk::axes {
namespace {

constexpr std::size_t per_quarter = 3;
constexpr std::size_t verified_points = 4 * per_quarter;  // per cell, and its beginning
// What interpolation may miss over twice the length that it is used for: then it misses a sixteenth of that (q'''), a thirty-second (q'').
constexpr double may_miss_velocity = 4e-6, may_miss_acceleration = 4e-6, may_miss_jerk = 2e-4;
// The error of such a polynomial is as t^3 (1 - t)^3, whose slope vanishes in the middle: its greatest slope by its middle value.
constexpr double greatest_slope = 3.44;
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

/// The greatest magnitude, with what a parabola through each three samples reaches between them, and what it may be wrong by: a cubic's part.
double peak_of(const Samples& x) {
    constexpr double cubic = 0.065;  // the greatest |t (t^2 - 1)|/6 on [-1, 1]
    double most = 0;
    for (const double v : x) most = std::max(most, std::fabs(v));
    if (most < looks_closer) return most;
    for (std::size_t i = 2; i < x.size(); ++i) {
        const double bend = x[i] - 2 * x[i - 1] + x[i - 2], slope = x[i] - x[i - 2];
        if (std::fabs(slope) >= 2.2 * std::fabs(bend)) continue;
        double third = 0;
        if (i > 2) third = std::fabs(bend - (x[i - 1] - 2 * x[i - 2] + x[i - 3]));
        if (i + 1 < x.size()) third = std::max(third, std::fabs(x[i + 1] - 2 * x[i] + x[i - 1] - bend));
        most = std::max(most, std::fabs(x[i - 1] - slope * slope / (8 * bend)) + cubic * third);
    }
    return most;
}

/// What interpolation from a to b misses in the middle m.
LimitUse missed(const TimedCurvePoint& a, const TimedCurvePoint& m, const TimedCurvePoint& b, std::size_t axis, double length,
                const PathAxisLimits& limits) {
    const Hermite whole(a, b, axis, length);
    const double first = std::fabs(whole.first(0.5) - m.first[axis]);
    const double second = std::max(std::fabs(whole.second(0.5) - m.second[axis]), greatest_slope / length * first);
    return {first / limits.velocity, second / limits.acceleration, std::fabs(whole.third(0.5) - m.third[axis]) / limits.jerk};
}

double at_nodes(const Samples& x) { return std::max(std::fabs(x.front()), std::fabs(x.back())); }

}  // namespace

void CellCheck::sample(const TimedCurve& curve, std::span<const PathAxisLimits> limits, const std::vector<double>& nodes,
                       const std::vector<double>& breaks) {
    curve_ = &curve;
    limits_ = limits;
    const std::size_t n = nodes.size() - 1;
    begins_.resize(n);
    quarters_.resize(n);
    middles_.resize(n);
    three_quarters_.resize(n);
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
    const auto near = [](double x, double y) { return x == y || std::fabs(x - y) < 1e-10 * x; };
    const auto same = [&](const PathLimits& x, const PathLimits& y) {
        return near(x.velocity, y.velocity) && near(x.acceleration, y.acceleration) && near(x.deceleration, y.deceleration) &&
               near(x.jerk, y.jerk);
    };
    t.limits_stay = same(a.path, m.path) && same(a.path, b.path);
    t.straight = t.limits_stay;
    t.quartered = false;
    t.per_unit = t.missed = {};
    for (std::size_t i = 0; i < limits_.size(); ++i) {
        const double size = std::max(std::fabs(a.first[i]), 1e-9);
        for (const TimedCurvePoint* p : {&a, &m, &b})
            t.straight = t.straight && std::fabs(p->second[i]) * t.length < 1e-9 * size &&
                         std::fabs(p->third[i]) * t.length * t.length < 1e-9 * size;
        t.per_unit.widen({std::fabs(a.first[i]) / limits_[i].velocity, std::fabs(a.first[i]) / limits_[i].acceleration,
                          std::fabs(a.first[i]) / limits_[i].jerk});
        if (!t.straight) t.missed.widen(missed(a, m, b, i, t.length, limits_[i]));
    }
}

/// Points at its quarters, and what interpolation over its halves misses there.
void CellCheck::quarter(std::size_t cell) {
    Traits& t = traits_[cell];
    quarters_[cell] = curve_->at(t.begin + 0.25 * t.length, CurveSide::after);
    three_quarters_[cell] = curve_->at(t.begin + 0.75 * t.length, CurveSide::after);
    t.quartered = true;
    t.missed_of_half = {};
    for (std::size_t i = 0; i < limits_.size(); ++i) {
        t.missed_of_half.widen(missed(begins_[cell], quarters_[cell], middles_[cell], i, t.length / 2, limits_[i]));
        t.missed_of_half.widen(missed(middles_[cell], three_quarters_[cell], ends_[cell], i, t.length / 2, limits_[i]));
    }
}

/// Over which parts of the cell interpolation does at this velocity.
CellCheck::Between CellCheck::between(std::size_t cell, double velocity) {
    const Traits& t = traits_[cell];
    const auto does = [&](const LimitUse& missed) {
        return missed.velocity * velocity < may_miss_velocity && missed.acceleration * velocity * velocity < may_miss_acceleration &&
               missed.jerk * velocity * velocity * velocity < may_miss_jerk;
    };
    if (!t.limits_stay) return Between::nothing;
    if (does(t.missed)) return Between::halves;
    if (!t.quartered) quarter(cell);
    return does(t.missed_of_half) ? Between::quarters : Between::nothing;
}

CellUse CellCheck::straight_use(std::size_t cell, const CellSquares& q, double velocity_factor) const {
    const Traits& t = traits_[cell];
    const PathLimits& path = begins_[cell].path;
    double most = std::max(q.first, q.last);
    const double bend = q.first - 2 * q.middle + q.last, rise = q.middle - q.first;
    if (bend < 0 && rise > 0 && rise < -bend) most = std::max(most, q.first - rise * rise / bend);
    const double node = std::sqrt(std::max(q.first, q.last)), v = std::sqrt(most), c = std::fabs(bend) / (t.length * t.length);
    const double one = rise / t.length, two = (q.last - q.middle) / t.length, up = std::max(one, two), down = std::min(one, two);
    const double per_velocity = std::max(t.per_unit.velocity, 1 / (path.velocity * velocity_factor));
    CellUse use;
    use.peak = {v * per_velocity,
                std::max({std::max(up, -down) * t.per_unit.acceleration, up / path.acceleration, -down / path.deceleration}),
                c * v * std::max(t.per_unit.jerk, 1 / path.jerk)};
    use.nodes = {node * per_velocity, use.peak.acceleration, c * node * std::max(t.per_unit.jerk, 1 / path.jerk)};
    return use;
}

CellUse CellCheck::use(std::size_t cell, const CellSquares& q, double velocity_factor) {
    const Traits& t = traits_[cell];
    if (t.straight) return straight_use(cell, q, velocity_factor);
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
    const Between way = between(cell, most);
    CellUse use;
    const auto look = [&] {
        use.peak.widen({peak_of(x), peak_of(y), peak_of(z)});
        use.nodes.widen({at_nodes(x), at_nodes(y), at_nodes(z)});
    };
    std::array<TimedCurvePoint, verified_points + 1> points;
    if (way == Between::nothing)
        for (std::size_t k = 0; k <= verified_points; ++k)
            points[k] = k == 0 ? begins_[cell]
                        : k == verified_points
                            ? ends_[cell]
                            : curve_->at(t.begin + t.length * static_cast<double>(k) / verified_points, CurveSide::after);
    for (std::size_t k = 0; k <= verified_points; ++k) {
        const PathLimits& path = way == Between::nothing ? points[k].path : begins_[cell].path;
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
        const auto part = [&](std::size_t from, std::size_t count, const TimedCurvePoint& a, const TimedCurvePoint& b) {
            const Hermite curve(a, b, i, t.length * static_cast<double>(count) / verified_points);
            exact(from, a);
            for (std::size_t k = 1; k < count; ++k) {
                const double u = static_cast<double>(k) / static_cast<double>(count);
                set(from + k, curve.first(u), curve.second(u), curve.third(u));
            }
        };
        if (way == Between::nothing) {
            for (std::size_t k = 0; k <= verified_points; ++k) exact(k, points[k]);
        } else if (way == Between::quarters) {
            part(0, per_quarter, begins_[cell], quarters_[cell]);
            part(per_quarter, per_quarter, quarters_[cell], middles_[cell]);
            part(2 * per_quarter, per_quarter, middles_[cell], three_quarters_[cell]);
            part(3 * per_quarter, per_quarter, three_quarters_[cell], ends_[cell]);
            exact(verified_points, ends_[cell]);
        } else {
            part(0, 2 * per_quarter, begins_[cell], middles_[cell]);
            part(2 * per_quarter, 2 * per_quarter, middles_[cell], ends_[cell]);
            exact(verified_points, ends_[cell]);
        }
        look();
    }
    return use;
}

}  // namespace taktwerk::axes
