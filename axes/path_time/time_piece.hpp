#pragma once
// A piece of s(t) whose acceleration is linear in s: s'' = a0 + c s. Then the square of the velocity is quadratic in s,
//     v2(s) = v0^2 + 2 a0 s + c s^2,
// which is what the optimisation works with: a plan is carried out as it was found, nothing is fitted in between. docs/motion/path.md.

#include <cmath>

#include "core/math.hpp"

namespace taktwerk::axes {

/// Where on the path, and how it moves along it. u, u/s, u/s2, u/s3.
struct PathMotion {
    double s = 0;
    double velocity = 0;
    double acceleration = 0;
    double jerk = 0;
};

/// (sinh(x)/x - 1)/x^2 and (cosh(x) - 1)/x^2 as functions of z = x^2, where z < 0 is the sine and cosine of sqrt(-z).
struct PathWave {
    double sine = 0;    ///< sinh(x)/x
    double cosine = 0;  ///< (cosh(x) - 1)/x^2
};

[[nodiscard]] inline PathWave path_wave(double z) noexcept {
    if (std::fabs(z) < 0.5) {
        // Taylor: the term left out is below 1e-17.
        const double sine = 1 + z / 6 * (1 + z / 20 * (1 + z / 42 * (1 + z / 72 * (1 + z / 110 * (1 + z / 156 * (1 + z / 210))))));
        const double cosine =
            0.5 * (1 + z / 12 * (1 + z / 30 * (1 + z / 56 * (1 + z / 90 * (1 + z / 132 * (1 + z / 182 * (1 + z / 240)))))));
        return {sine, cosine};
    }
    if (z > 0) {
        const double x = std::sqrt(z), grown = math::exp(x), shrunk = 1 / grown;
        return {(grown - shrunk) / (2 * x), ((grown + shrunk) / 2 - 1) / z};
    }
    const double x = std::sqrt(-z), half = math::sin(x / 2);
    return {math::sin(x) / x, 2 * half * half / -z};
}

/// artanh(x)/x as a function of z = x^2 < 1, where z < 0 is the arctangent of sqrt(-z). Halves the argument until a series does.
[[nodiscard]] inline double path_wave_time(double z) noexcept {
    double factor = 1;
    while (std::fabs(z) > 0.01) {
        const double half = 1 + std::sqrt(1 - z);
        factor *= 2 / half;
        z /= half * half;
    }
    return factor * (1 + z * (1.0 / 3 + z * (1.0 / 5 + z * (1.0 / 7 + z * (1.0 / 9 + z * (1.0 / 11 + z * (1.0 / 13 + z / 15)))))));
}

/// One piece. Real-time safe.
struct TimePiece {
    enum class Kind : unsigned char { moving, from_rest, to_rest, waiting };

    double begin_time = 0;  ///< s since the plan's beginning
    double duration = 0;    ///< s
    double begin = 0;       ///< s at its beginning, u
    double length = 0;      ///< u
    double velocity = 0;    ///< at its beginning, u/s
    double slope = 0;       ///< moving: acceleration at its beginning, u/s2; from and to rest: the constant jerk, u/s3
    double curvature = 0;   ///< moving: c, 1/s2
    Kind kind = Kind::moving;

    [[nodiscard]] PathMotion at(double t) const noexcept {
        switch (kind) {
            case Kind::moving: {
                const PathWave wave = path_wave(curvature * t * t);
                const double x = t * (velocity * wave.sine + slope * t * wave.cosine);
                const double v = velocity * (1 + curvature * t * t * wave.cosine) + slope * t * wave.sine;
                return {begin + x, v, slope + curvature * x, curvature * v};
            }
            case Kind::from_rest: return {begin + slope * t * t * t / 6, slope * t * t / 2, slope * t, slope};
            case Kind::to_rest: {
                const double left = duration - t;
                return {begin + length - slope * left * left * left / 6, slope * left * left / 2, -slope * left, slope};
            }
            case Kind::waiting: break;
        }
        return {begin, 0, 0, 0};
    }

    /// From v2 = first to v2 = last over `length`, with `middle` between (Bernstein's coefficients of v2). All > 0.
    [[nodiscard]] static TimePiece moving(double begin, double length, double first, double middle, double last) noexcept {
        TimePiece p;
        p.begin = begin;
        p.length = length;
        p.velocity = std::sqrt(first);
        p.slope = (middle - first) / length;
        p.curvature = (first - 2 * middle + last) / (length * length);
        const double mean = 2 * length / (p.velocity + std::sqrt(last));  // the time at constant acceleration
        p.duration = mean * path_wave_time(p.curvature * mean * mean / 4);
        return p;
    }

    /// At constant jerk from rest to v2 = last, or from v2 = first to rest.
    [[nodiscard]] static TimePiece rest(Kind kind, double begin, double length, double square) noexcept {
        TimePiece p;
        p.kind = kind;
        p.begin = begin;
        p.length = length;
        const double v = std::sqrt(square);
        p.duration = 3 * length / v;
        p.velocity = kind == Kind::to_rest ? v : 0;
        p.slope = 2 * v / (p.duration * p.duration);
        return p;
    }
};

}  // namespace taktwerk::axes
