#include <algorithm>
#include <cmath>

#include "axes/planner/families.hpp"
#include "axes/planner/precision.hpp"
#include "axes/planner/turning_point.hpp"

namespace taktwerk::axes {

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

/// Beyond this trough the crossing of velocity 0 holds the climb up, and what falls last falls above velocity 0: the rate is positive.
double TroughFamily::holding_trough() const noexcept {
    if (problem_.limits.convex()) return problem_.a1;
    const double fall = problem_.limits.down.ease;
    const double beyond = std::min(problem_.limits.up.speeding_up, problem_.limits.up.slowing_down);
    const double end = released_velocity(problem_.v1, -problem_.a1, problem_.limits.reversed().mirrored());
    const double square = (beyond * beyond * fall - 2 * end) / (problem_.limits.up.ease + fall);
    return std::min(problem_.a1, std::sqrt(std::max(square, 0.0)) * (1 - 8 * epsilon));
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
    return std::clamp(std::min(trough, holding_trough()), problem_.a1 - widest_, problem_.a1);
}

Found TroughFamily::over_way(double known_to, double longest) const noexcept {
    if (!exists_) return {};
    Found last{true};  // member looked at, as a result
    const auto look = [&](double u) noexcept -> Turn {
        const Motion m = at(u);
        last.parameter = u;
        last.duration = m.duration();
        ++last.looked_at;
        return {u, m.travel() - problem_.way, rate(m), last.duration, time_slope(m), m.path()};
    };
    const auto none = [&]() noexcept -> Found { return {false, 0, 0, infinity, last.looked_at}; };
    const auto at_end = [&](const Turn& t) noexcept -> Found { return {true, t.parameter, 0, t.time, last.looked_at}; };
    const auto between = [&](const Turn& below, const Turn& above) noexcept -> Found {
        const auto miss = [&](double u) noexcept -> RootSample {
            const Turn t = look(u);
            return {t.miss, t.time_slope * t.rate, 2 * epsilon * (std::abs(problem_.way) + t.path)};
        };
        const double guess = below.parameter - (above.parameter - below.parameter) * (below.miss / (above.miss - below.miss));
        const double u = bracketed_root(miss, below.parameter, above.parameter, guess, true);
        if (u != last.parameter) look(u);
        return last;
    };

    const Turn start = look(0);
    if (start.time >= longest) return none();
    const double rounding = known_to + 4 * epsilon * start.path;
    if (std::abs(start.miss) <= rounding) return at_end(start);
    const Turn end = look(widest_);
    const auto not_before_end = [&]() noexcept -> Found { return std::abs(end.miss) <= rounding ? at_end(end) : none(); };
    // Whose way begins beyond the target can only come back to it (mathematics.md, "Why these are all").
    if (start.miss > 0) return not_before_end();
    // Before the valley of the rate the way lies below its first tangent, behind it below its end.
    const double highest = start.miss + std::max(start.rate, 0.0) * (end.time - start.time);
    if (problem_.limits.convex() && end.miss < 0 && highest < -rounding) return not_before_end();
    const Turn valley = look(problem_.a1 - slowest_trough());
    if (!(valley.rate < 0)) return end.miss >= 0 ? between(start, end) : not_before_end();
    if (valley.miss >= 0) return between(start, valley);
    const double held = std::min(problem_.a1 - holding_trough(), valley.parameter);
    const Turn first = held > 0 ? look(held) : start;
    if (first.miss >= 0) return between(start, first);
    if (const auto top = top_beyond_zero(look, first, valley, rounding)) return between(first, *top);
    return end.miss >= 0 ? between(valley, end) : not_before_end();
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
