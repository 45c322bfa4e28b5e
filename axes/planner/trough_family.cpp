#include <algorithm>
#include <array>
#include <cmath>

#include "axes/planner/families.hpp"

namespace taktwerk::axes {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

}  // namespace

TroughFamily::TroughFamily(const Problem& problem) noexcept : problem_{problem} {
    if (!(problem.a1 > 0) || problem.limits.jerk_free()) return;
    const double rise = problem.limits.up.ease;
    const double fall = problem.limits.down.ease;
    const double a0 = problem.a0;
    const double a1 = problem.a1;
    const double difference = (a1 - a0) * (a1 + a0);
    square_ = (2 * (problem.v1 - problem.v0) - difference * rise) / (rise + fall);
    // A start on the parabola into the end is on it also when rounding says it is beside it.
    const double rounding = 4 * epsilon * (2 * (std::abs(problem.v0) + std::abs(problem.v1)) / (rise + fall) + a1 * a1 + a0 * a0);
    if (square_ < -rounding) return;
    if (square_ <= rounding) square_ = 0;
    widest_ = a1;
    if (a0 > 0) {
        // The peak is not below the start: trough^2 >= a0^2 - square.
        const double least_square = a0 * a0 - square_;
        if (least_square > 0) {
            const double room = difference + square_;
            if (room < -rounding) return;
            // Not where the end has more of it: between them lies at least the time of the rise.
            if (difference <= 0 && std::abs(room) <= rounding) square_ = -difference;
            widest_ = std::max(difference + square_, 0.0) / (a1 + std::sqrt(std::max(a0 * a0 - square_, 0.0)));
            widest_ = std::min(widest_, a1);
        }
    }
    exists_ = true;
}

TroughFamily::Motion TroughFamily::at(double u) const noexcept {
    const Problem& p = problem_;
    const double trough = std::max(p.a1 - u, 0.0);
    const double ease = p.limits.up.ease;
    const double v = p.v1 - u * (p.a1 + trough) * ease / 2;
    const double from_start = p.a1 - p.a0 - u;  // trough - a0
    const double rise_square = from_start * (trough + p.a0) + square_;
    const Stretch last{u * ease, trough, p.limits.up.jerk, 0};
    const double t = last.duration;
    const double way = t > 0 ? t * (v + t * (trough / 2 + t * (last.jerk / 6))) : 0;
    return {Ramp{{p.v0, p.a0, v, trough, p.a0 < 0 ? p.released0 : p.v0, square_, rise_square}, p.limits}, last, trough, way};
}

double TroughFamily::rate(const Motion& m) const noexcept { return m.up.turn_velocity() + m.up.peak() * m.up.fall_duration() / 2; }

double TroughFamily::time_slope(const Motion& m) const noexcept {
    const double ease = problem_.limits.up.ease + problem_.limits.down.ease;
    const double peak = m.up.peak();
    return peak > 0 ? ease * std::max(peak - m.trough, 0.0) / peak : 0;
}

/// The trough at which the rate is lowest (mathematics.md, "troughs").
double TroughFamily::slowest_trough() const noexcept {
    const double rise = problem_.limits.up.ease;
    const double fall = problem_.limits.down.ease;
    const double both = rise + fall;
    const double bound = problem_.limits.up.slowing_down;  // the rate is negative only below velocity 0
    double trough = problem_.a1;
    if (rise > 0) trough = std::sqrt(square_ / 2 * (std::sqrt(1 + fall * fall / (rise * (both + fall))) - 1));
    if (square_ + trough * trough > bound * bound) {
        const double reached = std::sqrt(std::max(bound * bound - square_, 0.0));
        trough = std::max(reached, bound * fall / (2 * both));
    }
    if (!problem_.limits.convex()) {
        // Beyond this trough the crossing of velocity 0 holds the climb up, and what falls last falls above velocity 0.
        const double beyond = std::min(problem_.limits.up.speeding_up, problem_.limits.up.slowing_down);
        const double end = released_velocity(problem_.v1, -problem_.a1, problem_.limits.reversed().mirrored());
        const double square = (beyond * beyond * fall - 2 * end) / both;
        trough = std::min(trough, std::sqrt(std::max(square, 0.0)) * (1 - 8 * epsilon));
    }
    return std::clamp(trough, problem_.a1 - widest_, problem_.a1);
}

Found TroughFamily::over_way(double known_to) const noexcept {
    if (!exists_) return {};
    const double way = problem_.way;
    const auto rate_at = [&](double u) noexcept -> RootSample {
        const Motion m = at(u);
        const double part = m.up.peak() * m.up.fall_duration() / 2;
        return {rate(m), 0, 4 * epsilon * (std::abs(m.up.turn_velocity()) + part)};
    };
    const auto difference = [&](double u) noexcept -> RootSample {
        const Motion m = at(u);
        return {m.travel() - way, time_slope(m) * rate(m), 2 * epsilon * (std::abs(way) + m.path())};
    };

    // Where the way stops growing or shrinking with the parameter.
    std::array<double, 4> ends{0, widest_, widest_, widest_};
    std::size_t count = 1;
    const double valley = problem_.a1 - slowest_trough();
    if (rate_at(valley).value < 0) {
        if (rate_at(0).value > 0) ends[count++] = bracketed_root(rate_at, 0, valley, 0, false);
        if (rate_at(widest_).value > 0) ends[count++] = bracketed_root(rate_at, valley, widest_, 0, true);
    }
    ends[count++] = widest_;

    double here = 0;
    Motion first = at(here);
    double before = first.travel();
    const double rounding = known_to + 4 * epsilon * first.path();
    if (std::abs(before - way) <= rounding) return {true, 0, 0, first.duration()};
    for (std::size_t i = 1; i < count; ++i) {
        const double there = ends[i];
        const Motion m = at(there);
        const double after = m.travel();
        if ((before < way && after >= way) || (before > way && after <= way)) {
            const double u = bracketed_root(difference, here, there, here + (there - here) / 2, before < after);
            return {true, u, 0, at(u).duration()};
        }
        if (std::abs(after - way) <= rounding) return {true, there, 0, m.duration()};
        here = there;
        before = after;
    }
    return {};
}

Found TroughFamily::in_time(double time, double slack) const noexcept {
    if (!exists_) return {};
    const double shortest = at(0).duration();
    const double longest = at(widest_).duration();
    if (time < shortest - slack || time > longest + slack) return {};
    if (time <= shortest) return {true, 0, 0, time};
    if (time >= longest) return {true, widest_, 0, time};
    const double u = bracketed_root(
        [&](double x) noexcept -> RootSample {
            const Motion m = at(x);
            return {m.duration() - time, time_slope(m), 2 * epsilon * time};
        },
        0, widest_, widest_ / 2, true);
    return {true, u, 0, time};
}

}  // namespace taktwerk::axes
