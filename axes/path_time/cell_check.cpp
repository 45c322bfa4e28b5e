#include "axes/path_time/cell_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "axes/path_time/curve_samples.hpp"

namespace taktwerk::axes {
namespace {

constexpr std::size_t per_quarter = 3;
constexpr std::size_t verified_points = 4 * per_quarter;  // per cell, and its beginning
// What interpolation may miss over twice the length that it is used for: then it misses a sixteenth of that (q'''), a thirty-second (q'').
constexpr double may_miss_velocity = 4e-6, may_miss_acceleration = 4e-6, may_miss_jerk = 2e-4;
// The error of such a polynomial is as t^3 (1 - t)^3, whose slope vanishes in the middle: its greatest slope by its middle value.
constexpr double greatest_slope = 3.44;
constexpr int deepest_look = 6;  // halvings of a cell, until its points say what is between them

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

/// What interpolation from a to b misses in the middle m.
LimitUse missed(const TimedCurvePoint& a, const TimedCurvePoint& m, const TimedCurvePoint& b, std::size_t axis, double length,
                const PathAxisLimits& limits) {
    const Hermite whole(a, b, axis, length);
    const double first = std::fabs(whole.first(0.5) - m.first[axis]);
    const double second = std::max(std::fabs(whole.second(0.5) - m.second[axis]), greatest_slope / length * first);
    return {first / limits.velocity, second / limits.acceleration, std::fabs(whole.third(0.5) - m.third[axis]) / limits.jerk};
}

/// The greatest velocity and acceleration that limits leave along the curve.
struct MostAlong {
    double velocity, acceleration;
};

MostAlong most_along(const TimedCurvePoint& p, std::span<const PathAxisLimits> limits) {
    MostAlong most{p.path.velocity, std::max(p.path.acceleration, p.path.deceleration)};
    for (std::size_t i = 0; i < limits.size(); ++i) {
        const double first = std::fabs(p.first[i]);
        if (first > 0)
            most = {std::min(most.velocity, limits[i].velocity / first), std::min(most.acceleration, limits[i].acceleration / first)};
    }
    return most;
}

/// However short a cell is in which q' hardly changes: what a bend adds goes with q'' v2 and q''' v3, which know nothing of that.
bool adds_nothing(double second, double third, const MostAlong& most, const PathAxisLimits& limits) {
    constexpr double nothing = 1e-7;
    if (second <= 0 && third <= 0) return true;
    const double v = most.velocity;
    return second * v * v < nothing * limits.acceleration && (third * v * v + 3 * second * most.acceleration) * v < nothing * limits.jerk;
}

using Points = std::array<TimedCurvePoint, verified_points + 1>;

/// v2 over a cell at the points, its root, and its slope, which is the acceleration.
struct Motion {
    Samples square{}, v{}, slope{};
    double change = 0;  ///< of the acceleration, by s

    Motion(const CellSquares& q, double length) : change{(q.first - 2 * q.middle + q.last) / (length * length)} {
        for (std::size_t k = 0; k <= verified_points; ++k) {
            const double u = static_cast<double>(k) / verified_points, w = 1 - u;
            square[k] = w * w * q.first + 2 * u * w * q.middle + u * u * q.last;
            v[k] = std::sqrt(square[k]);
            slope[k] = (w * (q.middle - q.first) + u * (q.last - q.middle)) / length;
        }
    }
};

/// What is used at the points, of one axis or of the path.
struct Looks {
    Samples x{}, y{}, z{};  ///< velocity, acceleration, jerk

    void of_path(std::size_t k, const PathLimits& path, const Motion& m, double velocity_factor) {
        x[k] = m.v[k] / (path.velocity * velocity_factor);
        y[k] = m.slope[k] > 0 ? m.slope[k] / path.acceleration : -m.slope[k] / path.deceleration;
        z[k] = m.change * m.v[k] / path.jerk;
    }
    /// `over`: one over its limits.
    void of_axis(std::size_t k, const PathAxisLimits& over, const Motion& m, double first, double second, double third) {
        x[k] = first * m.v[k] * over.velocity;
        y[k] = (first * m.slope[k] + second * m.square[k]) * over.acceleration;
        z[k] = (first * m.change + 3 * second * m.slope[k] + third * m.square[k]) * m.v[k] * over.jerk;
    }
    void add_to(CellUse& use) const;
    [[nodiscard]] bool unsure() const { return peak_is_unsure(x) || peak_is_unsure(y); }
};

/// Near its limit a jerk changes in ways that a parabola through three points does not follow.
bool cubic_between(const Samples& x) {
    constexpr double looks_closer = 0.9, counts = 3e-4;
    for (std::size_t i = 3; i < x.size(); ++i) {
        const double most = std::max({std::fabs(x[i - 3]), std::fabs(x[i - 2]), std::fabs(x[i - 1]), std::fabs(x[i])});
        if (most > looks_closer && cubic_part * std::fabs(x[i] - 3 * (x[i - 1] - x[i - 2]) - x[i - 3]) > counts) return true;
    }
    return false;
}

PathAxisLimits reciprocal(const PathAxisLimits& l) { return {1 / l.velocity, 1 / l.acceleration, 1 / l.jerk}; }

bool stands(const TimedCurvePoint& p, std::size_t axis) { return p.first[axis] == 0 && p.second[axis] == 0 && p.third[axis] == 0; }

double at_nodes(const Samples& x) { return std::max(std::fabs(x.front()), std::fabs(x.back())); }

void Looks::add_to(CellUse& use) const {
    use.peak.widen({sampled_peak(x), sampled_peak(y), sampled_peak(z)});
    use.nodes.widen({at_nodes(x), at_nodes(y), at_nodes(z)});
}

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
    const MostAlong most = most_along(m, limits_);
    for (std::size_t i = 0; i < limits_.size(); ++i) {
        const double size = std::max(std::fabs(a.first[i]), 1e-9);
        for (const TimedCurvePoint* p : {&a, &m, &b})
            t.straight = t.straight && std::fabs(p->second[i]) * t.length < 1e-9 * size &&
                         std::fabs(p->third[i]) * t.length * t.length < 1e-9 * size &&
                         adds_nothing(std::fabs(p->second[i]), std::fabs(p->third[i]), most, limits_[i]);
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

/// The curve is evaluated at all points, and at ever nearer ones while it turns between them.
CellUse CellCheck::look_directly(double begin, double length, const TimedCurvePoint& first, const TimedCurvePoint& last,
                                 const CellSquares& q, double velocity_factor, int depth) const {
    Points points;
    points.front() = first;
    points.back() = last;
    for (std::size_t k = 1; k < verified_points; ++k)
        points[k] = curve_->at(begin + length * static_cast<double>(k) / verified_points, CurveSide::after);
    bool closer = turns_between(points, limits_.size());
    const Motion m(q, length);
    CellUse use;
    Looks looks;
    for (std::size_t k = 0; k <= verified_points; ++k) looks.of_path(k, points[k].path, m, velocity_factor);
    looks.add_to(use);
    closer = closer || looks.unsure();
    for (std::size_t i = 0; i < limits_.size(); ++i) {
        const PathAxisLimits over = reciprocal(limits_[i]);
        for (std::size_t k = 0; k <= verified_points; ++k)
            looks.of_axis(k, over, m, points[k].first[i], points[k].second[i], points[k].third[i]);
        looks.add_to(use);
        closer = closer || cubic_between(looks.z) || looks.unsure();
    }
    if (depth < deepest_look && closer) {
        const double half = (q.first + 2 * q.middle + q.last) / 4;
        const TimedCurvePoint& middle = points[verified_points / 2];
        const CellUse one =
            look_directly(begin, length / 2, first, middle, {q.first, (q.first + q.middle) / 2, half}, velocity_factor, depth + 1);
        CellUse both = look_directly(begin + length / 2, length / 2, middle, last, {half, (q.middle + q.last) / 2, q.last}, velocity_factor,
                                     depth + 1);
        both.peak.widen(one.peak);
        both.nodes.widen(one.nodes);
        return both;
    }
    return use;
}

CellUse CellCheck::use(std::size_t cell, const CellSquares& q, double velocity_factor) {
    const Traits& t = traits_[cell];
    if (t.straight) return straight_use(cell, q, velocity_factor);
    const Motion m(q, t.length);
    const Between way = between(cell, *std::max_element(m.v.begin(), m.v.end()));
    const auto directly = [&] { return look_directly(t.begin, t.length, begins_[cell], ends_[cell], q, velocity_factor, 0); };
    if (way == Between::nothing) return directly();
    CellUse use;
    Looks looks;
    for (std::size_t k = 0; k <= verified_points; ++k) looks.of_path(k, begins_[cell].path, m, velocity_factor);
    if (looks.unsure()) return directly();
    looks.add_to(use);
    for (std::size_t i = 0; i < limits_.size(); ++i) {
        if (stands(begins_[cell], i) && stands(middles_[cell], i) && stands(ends_[cell], i) &&
            (way == Between::halves || (stands(quarters_[cell], i) && stands(three_quarters_[cell], i))))
            continue;
        const PathAxisLimits over = reciprocal(limits_[i]);
        const auto exact = [&](std::size_t k, const TimedCurvePoint& p) { looks.of_axis(k, over, m, p.first[i], p.second[i], p.third[i]); };
        const auto part = [&](std::size_t from, std::size_t count, const TimedCurvePoint& a, const TimedCurvePoint& b) {
            const Hermite curve(a, b, i, t.length * static_cast<double>(count) / verified_points);
            exact(from, a);
            for (std::size_t k = 1; k < count; ++k) {
                const double u = static_cast<double>(k) / static_cast<double>(count);
                looks.of_axis(from + k, over, m, curve.first(u), curve.second(u), curve.third(u));
            }
        };
        if (way == Between::quarters) {
            part(0, per_quarter, begins_[cell], quarters_[cell]);
            part(per_quarter, per_quarter, quarters_[cell], middles_[cell]);
            part(2 * per_quarter, per_quarter, middles_[cell], three_quarters_[cell]);
            part(3 * per_quarter, per_quarter, three_quarters_[cell], ends_[cell]);
        } else {
            part(0, 2 * per_quarter, begins_[cell], middles_[cell]);
            part(2 * per_quarter, 2 * per_quarter, middles_[cell], ends_[cell]);
        }
        exact(verified_points, ends_[cell]);
        if (looks.unsure()) return directly();
        looks.add_to(use);
    }
    return use;
}

}  // namespace taktwerk::axes
