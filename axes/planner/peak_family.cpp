#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "axes/planner/climb_polynomial.hpp"
#include "axes/planner/families.hpp"
#include "axes/planner/precision.hpp"
#include "core/math.hpp"

namespace taktwerk::axes {

namespace {

/// Of a positive number, within 0.1 %: a third of the exponent and one step of Halley's (math::cbrt takes four).
double rough_cbrt(double x) noexcept {
    const double t = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) / 3 + (std::uint64_t{682} << 52));
    const double cube = t * t * t;
    return t * ((cube + 2 * x) / (2 * cube + x));
}

}  // namespace

PeakFamily::PeakFamily(const Problem& problem) noexcept : problem_{problem}, back_limits_{problem.limits.reversed().mirrored()} {
    const double start = problem.released0;
    const double end = released_velocity(problem.v1, -problem.a1, back_limits_);
    // v1 - v0 first: where both are large and close, it is exact.
    const double release0 = release(problem.a0, problem.limits);
    const double release1 = release(-problem.a1, back_limits_);
    double gap = (problem.v1 - problem.v0) + (release1 - release0);
    if (problem.braked) gap = end - start;
    // Equal as far as the numbers can tell is equal: the root of a rounding error is not small.
    if (std::abs(gap) <= 4 * epsilon * (std::abs(problem.v0) + std::abs(problem.v1) + std::abs(release0) + std::abs(release1))) gap = 0;
    ease_ = problem.limits.up.ease + problem.limits.down.ease;
    if (ease_ > 0) square_per_excess_ = 2 / ease_;
    start_ = end_at(problem.v0, problem.a0, start, std::max(gap, 0.0));
    end_ = end_at(problem.v1, -problem.a1, end, std::max(-gap, 0.0));
    floor_velocity_ = std::max(start, end);
    widest_ = parameter(std::max(problem.limits.up.velocity - floor_velocity_, 0.0));
}

PeakFamily::End PeakFamily::end_at(double v, double a, double released, double excess) const noexcept {
    return {v, a, a < 0 ? released : v, a > 0 && ease_ > 0 ? a * a : 0, square_of(excess)};
}

PeakFamily::Motion PeakFamily::at(double x) const noexcept {
    const Top t = top(x);
    return {Ramp{climb(start_, t), problem_.limits}, Ramp{climb(end_, t), back_limits_}, t.velocity};
}

PeakFamily::Measured PeakFamily::measured(double x) const noexcept {
    const Top t = top(x);
    return {axes::measured(climb(start_, t), problem_.limits), axes::measured(climb(end_, t), back_limits_), t.velocity};
}

double PeakFamily::way_slope(double x, const Measured& m) const noexcept {
    const double p = m.up.peak;
    const double q = m.back.peak;
    const double ease = problem_.limits.down.ease;
    return excess_slope(x) * (m.peak_velocity * (1 / p + 1 / q) + (ease > 0 ? (p + q) * ease / 2 : 0));
}

/// Where the x lies whose halves cover `missing` from and to the floor's velocity c0 >= 0. With the eases r of the rise and f of the fall, q of
/// both and the highest acceleration A a climb by e from rest on top of the floor takes x^3 (r^2/6 + rf/2 + f^2/3) = x^3 q (r + 2f)/6
/// while x <= A, and e^2/2A + e f A/2 + A^3 (r^2 - f^2)/24 beyond: the guess, exact between two ends at rest.
/// Each half adds at least e^2/2A, and at least x^3 q sqrt(q f)/3: that is certainly enough. The second of these is the cube root above times that of
/// (r + 2f)/sqrt(q f), which is not more than a third of 2 + that.
PeakFamily::Step PeakFamily::step_over(double missing) const noexcept {
    if (!(missing > 0)) return {0, 0};
    const double rise = problem_.limits.up.ease;
    const double fall = problem_.limits.down.ease;
    const double first = problem_.limits.up.speeding_up;
    const double second = back_limits_.up.speeding_up;
    const double v = std::max(floor_velocity_, 0.0);
    double enough = parameter(std::sqrt(2 * std::min(first, second) * missing));
    if (ease_ > 0) {
        const double cube = 3 * missing / (ease_ * (rise + 2 * fall));
        double x = at_rest() ? math::cbrt(cube) : rough_cbrt(cube);  // from elsewhere it is only where to begin
        if (fall > 0) enough = std::min(enough, x * ((2 + (rise + 2 * fall) / std::sqrt(ease_ * fall)) / 3));
        if (v > 0) x = std::min(x, missing / (2 * v * ease_));
        if (x <= std::min(first, second)) return {x, enough};
    }
    const double square = 0.5 / first + 0.5 / second;
    const double linear = fall * (first + second) / 2 + v * (1 / first + 1 / second);
    const double rest =
        missing - (first * first * first + second * second * second) * (rise * rise - fall * fall) / 24 - v * ease_ * (first + second) / 2;
    return {parameter(2 * rest / (linear + std::sqrt(linear * linear + 4 * square * rest))), enough};
}

/// Where the two halves, as polynomials, cover the way, seen from `guess`. Nothing is lost but time where they do not tell.
double PeakFamily::looked_up(double guess, double low, double high) const noexcept {
    if (problem_.limits.jerk_free()) return guess;
    const ClimbPolynomial up{start_.v, start_.a, start_.square + start_.held_square, problem_.limits};
    const ClimbPolynomial back{end_.v, end_.a, end_.square + end_.held_square, back_limits_};
    constexpr int steps = 6;
    constexpr double near = 1e-7;  // a step of Newton's squares it
    double x = std::min(guess, high);
    for (int i = 0; i < steps; ++i) {
        const ClimbPolynomial::Way first = up.at(x * x);
        const ClimbPolynomial::Way second = back.at(x * x);
        const double change = (first.way + second.way - problem_.way) / (2 * x * (first.slope + second.slope));
        double next = x - change;
        if (next >= high && x < high) next = high;  // near the floor the way grows with the square of x: from above it is soon found
        else if (!(next > low && next < high)) return guess;
        else if (std::abs(change) <= near * x) return next;
        x = next;
    }
    return x;
}

Found PeakFamily::over_way(double known_to, double longest) const noexcept {
    const double way = problem_.way;
    Found last{true};  // member looked at, as a result
    const auto look = [&](double x) noexcept -> Measured {
        const Measured m = measured(x);
        last.parameter = x;
        last.duration = m.duration();
        ++last.looked_at;
        return m;
    };
    const auto none = [&]() noexcept -> Found { return {false, 0, 0, infinity, last.looked_at}; };
    const auto between = [&](double low, double high, double guess) noexcept -> Found {
        const auto miss = [&](double x) noexcept -> RootSample {
            const Measured m = look(x);
            return {m.travel() - way, way_slope(x, m), 2 * epsilon * (std::abs(way) + m.path())};
        };
        const double x = bracketed_root(miss, low, high, guess, true);
        if (x != last.parameter) look(x);
        return last;
    };

    double low = 0;
    const Measured lowest = look(0);
    if (last.duration >= longest) return none();
    double low_travel = lowest.travel();
    const double rounding = known_to + 2 * epsilon * lowest.path();
    if (std::abs(low_travel - way) <= rounding) return last;
    // With a peak below velocity 0 the way first shrinks with the time, but who is passed backwards was within reach before
    // (mathematics.md, "Why these are all").
    if (way < low_travel) return none();

    double high = widest_;
    // Where the lowest motion ends at negative velocity, the way back to 0 comes first (and may shrink before it grows).
    if (floor_velocity_ < 0) {
        const double stand = parameter(-floor_velocity_);
        if (stand > low && stand < widest_) {
            const double stand_travel = look(stand).travel();
            if (way <= stand_travel) return between(low, stand, looked_up((low + stand) / 2, low, stand));
            low = stand;
            low_travel = stand_travel;
        }
    }
    const Step step = step_over(way - low_travel);
    const auto above_low = [&](double x) noexcept -> double { return ease_ > 0 ? std::sqrt(low * low + x * x) : low + x; };
    const double sum = above_low(step.enough) * (1 + 4 * epsilon);
    if (sum >= widest_) {
        const Measured widest = look(widest_);
        const double rest = way - widest.travel();
        if (rest >= 0) {
            const double cruise = rest / widest.peak_velocity;
            return {true, widest_, cruise, widest.duration() + cruise, last.looked_at};
        }
    } else {
        high = sum;
    }
    const double guess = above_low(step.guess);
    return between(low, high, at_rest() ? guess : looked_up(guess, low, high));
}

Found PeakFamily::in_time(double time, double slack) const noexcept {
    const double shortest = measured(0).duration();
    if (time < shortest - slack) return {};
    if (time <= shortest) return {true, 0, 0, time};
    // A climb of e takes at least e/a, and at least sqrt(2 e / j).
    const double hardest = std::min(std::max(problem_.limits.up.speeding_up, problem_.limits.up.slowing_down),
                                    std::max(back_limits_.up.speeding_up, back_limits_.up.slowing_down));
    const double ease = problem_.limits.down.ease;
    double most = hardest * time;
    if (ease > 0) most = std::min(most, time * (time / (2 * ease)));
    const double high = std::min(widest_, parameter(most));
    const Measured widest = measured(high);
    if (time >= widest.duration()) return {true, high, time - widest.duration(), time};
    const double x_in_time = bracketed_root(
        [&](double x) noexcept -> RootSample {
            const Measured m = measured(x);
            return {m.duration() - time, excess_slope(x) * (1 / m.up.peak + 1 / m.back.peak), 2 * epsilon * time};
        },
        0, high, high / 2, true);
    return {true, x_in_time, 0, time};
}

}  // namespace taktwerk::axes
