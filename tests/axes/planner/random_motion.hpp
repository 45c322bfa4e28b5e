#pragma once
// Random motions over all scales, and what rounding may cost them. Shared by the property tests of the planner.

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <random>

#include "axes/planner/plan.hpp"

namespace taktwerk::axes {

struct MotionCase {
    MotionState from;
    double target = 0;
    MotionLimits limits;

    friend std::ostream& operator<<(std::ostream& out, const MotionCase& c) {
        out.precision(17);
        return out << "{{" << c.from.position << ", " << c.from.velocity << ", " << c.from.acceleration << "}, " << c.target << ", {"
                   << c.limits.velocity << ", " << c.limits.acceleration << ", " << c.limits.deceleration << ", " << c.limits.jerk << "}}";
    }
};

class RandomMotion {
public:
    explicit RandomMotion(std::uint64_t seed) : random_{seed} {}

    double uniform(double low, double high) { return low + (high - low) * std::generate_canonical<double, 53>(random_); }
    double decades(double low, double high) { return std::pow(10.0, uniform(low, high)); }
    int one_of(int n) { return static_cast<int>(random_() % static_cast<std::uint64_t>(n)); }

    /// Lengths from 1e-6 to 1e9 u, time scales from 1 ms to 1000 s, ratios over several decades, starts of every kind.
    MotionCase next() {
        const double length = decades(-6, 9);
        const double time = decades(-3, 3);
        MotionCase c;
        c.limits.velocity = length / time * decades(-2, 2);
        c.limits.acceleration = length / (time * time) * decades(-2, 2);
        c.limits.deceleration = one_of(4) == 0 ? c.limits.acceleration : c.limits.acceleration * decades(-1.5, 1.5);
        c.limits.jerk = one_of(8) == 0 ? std::numeric_limits<double>::infinity() : length / (time * time * time) * decades(-2, 4);
        c.from = {length * uniform(-1, 1), state_of(c.limits.velocity), state_of(std::max(c.limits.acceleration, c.limits.deceleration))};
        if (one_of(3) == 0) c.from.velocity = c.from.acceleration = 0;
        switch (one_of(6)) {
            case 0: c.target = c.from.position; break;
            case 1: c.target = c.from.position + stopping_distance(c.from, c.limits); break;
            case 2: c.target = c.from.position + stopping_distance(c.from, c.limits) * uniform(0.5, 1.5); break;
            case 3: c.target = c.from.position + sign() * length * decades(-9, 0); break;
            default: c.target = c.from.position + sign() * length * decades(-2, 2); break;
        }
        return c;
    }

private:
    double sign() { return one_of(2) == 0 ? -1 : 1; }

    double state_of(double limit) {
        switch (one_of(8)) {
            case 0: return 0;
            case 1: return sign() * limit;
            case 2: return sign() * limit * (1 + uniform(-1e-12, 1e-12));
            case 3: return sign() * limit * uniform(1, 3);
            case 4: return sign() * limit * decades(-12, 0);
            default: return limit * uniform(-1, 1);
        }
    }

    std::mt19937_64 random_;
};

/// Rounding, in backward form: a few units in the last place of the largest numbers that take part, the time included.
struct Rounding {
    double position = 0;
    double velocity = 0;
    double acceleration = 0;
    double time = 0;  ///< what correcting errors of this size costs, plus 1e-9 of the duration

    Rounding(const MotionCase& c, const Profile& profile) {
        constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
        const MotionLimits& l = c.limits;
        const double t = profile.duration();
        const double a = std::max({l.acceleration, l.deceleration, std::abs(c.from.acceleration)});
        const double least = std::min(l.acceleration, l.deceleration);
        const double v = profile.max_speed();
        position = rounding * (std::abs(c.from.position) + std::abs(c.target) + v * t);
        velocity = rounding * v;
        acceleration = std::isinf(l.jerk) ? 0 : rounding * std::min(a, l.jerk * t);
        if (!std::isinf(l.jerk)) acceleration += rounding * l.jerk * t;
        velocity += rounding * a * t;
        time = 1e-9 * t + 4 * position / l.velocity + 4 * std::sqrt(position / least) + 4 * velocity / least;
        if (!std::isinf(l.jerk)) time += 8 * std::cbrt(position / l.jerk) + 8 * std::sqrt(velocity / l.jerk) + 4 * acceleration / l.jerk;
    }
};

/// Inside the limits and able to stay there: the velocity that remains when the acceleration is taken away counts as well, and so does
/// the acceleration with which velocity 0 is inevitably crossed.
inline bool inside_limits(const MotionState& s, const MotionLimits& l, double dv = 0, double da = 0) {
    const bool jerk_limited = !std::isinf(l.jerk);
    const double v = std::abs(s.velocity);
    const double a = std::abs(s.acceleration);
    if (v > l.velocity + dv) return false;
    if (jerk_limited && std::abs(s.velocity + s.acceleration * a / (2 * l.jerk)) > l.velocity + dv + a * da / l.jerk) return false;
    if (dv > 0 && v <= dv) return a <= std::max(l.acceleration, l.deceleration) + da;
    if (s.velocity * s.acceleration >= 0) return a <= l.acceleration + da;
    if (a > l.deceleration + da) return false;
    const double crossing = l.acceleration + da;
    return !jerk_limited || a * a - 2 * l.jerk * (v + dv) <= crossing * crossing;
}

}  // namespace taktwerk::axes
