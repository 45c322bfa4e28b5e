#pragma once
// A path as a curve of axes: straight to them, or through a kinematics that is there for the tests (an arm of two links in the plane, whose
// inverse bends every line).

#include <algorithm>
#include <cmath>
#include <vector>

#include "axes/path/path.hpp"
#include "axes/path_time/curve.hpp"

namespace taktwerk::axes {

/// A number with its first three derivatives by s.
struct Jet {
    double v = 0, d1 = 0, d2 = 0, d3 = 0;

    friend Jet operator+(const Jet& a, const Jet& b) { return {a.v + b.v, a.d1 + b.d1, a.d2 + b.d2, a.d3 + b.d3}; }
    friend Jet operator-(const Jet& a, const Jet& b) { return {a.v - b.v, a.d1 - b.d1, a.d2 - b.d2, a.d3 - b.d3}; }
    friend Jet operator*(const Jet& a, const Jet& b) {
        return {a.v * b.v, a.d1 * b.v + a.v * b.d1, a.d2 * b.v + 2 * a.d1 * b.d1 + a.v * b.d2,
                a.d3 * b.v + 3 * a.d2 * b.d1 + 3 * a.d1 * b.d2 + a.v * b.d3};
    }
    friend Jet operator*(double f, const Jet& a) { return {f * a.v, f * a.d1, f * a.d2, f * a.d3}; }
};

/// f(a) for a function whose value and derivatives at a.v are given.
inline Jet chain(const Jet& a, double f, double f1, double f2, double f3) {
    return {f, f1 * a.d1, f2 * a.d1 * a.d1 + f1 * a.d2, f3 * a.d1 * a.d1 * a.d1 + 3 * f2 * a.d1 * a.d2 + f1 * a.d3};
}
inline Jet inverse(const Jet& a) {
    const double r = 1 / a.v;
    return chain(a, r, -r * r, 2 * r * r * r, -6 * r * r * r * r);
}
inline Jet root(const Jet& a) {
    const double r = std::sqrt(a.v);
    return chain(a, r, 0.5 / r, -0.25 / (r * a.v), 0.375 / (r * a.v * a.v));
}
/// The angle of (x, y): its first derivative is (x y' - y x') / (x^2 + y^2).
inline Jet angle(const Jet& y, const Jet& x) {
    const Jet x1{x.d1, x.d2, x.d3, 0}, y1{y.d1, y.d2, y.d3, 0};
    const Jet rate = (x * y1 - y * x1) * inverse(x * x + y * y);
    return {std::atan2(y.v, x.v), rate.v, rate.d1, rate.d2};
}

struct PathAxes {
    std::array<double, max_path_axes> q{};
    TimedCurvePoint point{};
};

class PathCurve : public TimedCurve {
public:
    enum class Machine { cartesian, arm };
    explicit PathCurve(const Path& path, int axes = 3, Machine machine = Machine::cartesian)
        : path_(path), axes_(axes), machine_(machine) {}

    /// Links of the arm; its shoulder stands at the origin.
    static constexpr double upper = 400, lower = 300, in_front = 450;  // of it the path's origin

    [[nodiscard]] int axes() const noexcept override { return axes_; }
    [[nodiscard]] double begin() const noexcept override { return 0; }
    [[nodiscard]] double end() const noexcept override { return path_.length(); }
    [[nodiscard]] double next_break(double s) const noexcept override {
        const auto& all = path_.sections();
        std::size_t i = path_.index_at(s);
        return all[i].end() > s ? all[i].end() : end();
    }
    [[nodiscard]] double next_stop(double s) const noexcept override {
        for (std::size_t i = path_.index_at(s) + 1; i < path_.sections().size(); ++i)
            if (path_.sections()[i].stop_before && path_.sections()[i].begin > s) return path_.sections()[i].begin;
        return end();
    }
    [[nodiscard]] double feature(double s, CurveSide side) const noexcept override {
        const PathSection& section = section_at(s, side);
        const double own = section.element.feature(section.from + s - section.begin);
        if (machine_ == Machine::cartesian) return own;
        const PathVector at = section.at(s).at;  // the arm's own curvature: of its distance from the shoulder and from being straight
        const double reach = std::hypot(at[0] + in_front, at[1]);
        return std::min(own, 0.2 * std::max(1.0, std::min({reach, upper + lower - reach, reach - (upper - lower)})));
    }
    [[nodiscard]] TimedCurvePoint at(double s, CurveSide side) const noexcept override { return axes_at(s, side).point; }

    [[nodiscard]] PathAxes axes_at(double s, CurveSide side) const noexcept { return axes_on(section_at(s, side), s); }
    [[nodiscard]] std::uint32_t part_at(double s) const noexcept override { return static_cast<std::uint32_t>(path_.index_at(s)); }
    [[nodiscard]] PathAxes axes_in(std::uint32_t part, double s) const noexcept { return axes_on(path_.sections()[part], s); }

    [[nodiscard]] PathAxes axes_on(const PathSection& section, double s) const noexcept {
        const PathPoint p = section.at(s);
        PathAxes a;
        const auto set = [&](int axis, const Jet& j) {
            const auto k = static_cast<std::size_t>(axis);
            a.q[k] = j.v;
            a.point.first[k] = j.d1;
            a.point.second[k] = j.d2;
            a.point.third[k] = j.d3;
        };
        std::array<Jet, max_path_axes> x;
        for (int k = 0; k < path_dimensions; ++k) x[static_cast<std::size_t>(k)] = {p.at[k], p.first[k], p.second[k], p.third[k]};
        const int first = machine_ == Machine::arm ? 2 : 0;
        for (int k = first; k < axes_; ++k) set(k, x[static_cast<std::size_t>(k)]);
        if (machine_ == Machine::arm) {
            x[0].v += in_front;
            // Law of cosines: the elbow's cosine is a polynomial of x and y, its sine the positive root.
            const Jet square = x[0] * x[0] + x[1] * x[1];
            const Jet cosine = (0.5 / (upper * lower)) * (square - Jet{upper * upper + lower * lower});
            const Jet sine = root(Jet{1} - cosine * cosine);
            set(1, angle(sine, cosine));
            set(0, angle(x[1], x[0]) - angle(lower * sine, Jet{upper} + lower * cosine));
        }
        const double linear = p.first.head<3>().norm();  // of the tool, per length of the path
        const double share = linear > 1e-9 ? 1 / linear : 1;
        a.point.path = {section.feed.velocity * share, section.feed.acceleration * share, section.feed.deceleration * share,
                        section.feed.jerk * share};
        return a;
    }

private:
    [[nodiscard]] const PathSection& section_at(double s, CurveSide side) const noexcept {
        std::size_t i = path_.index_at(s);
        if (side == CurveSide::before && i > 0 && path_.sections()[i].begin >= s) --i;
        return path_.sections()[i];
    }

    const Path& path_;
    int axes_;
    Machine machine_;
};

}  // namespace taktwerk::axes
