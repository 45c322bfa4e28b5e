#pragma once
// What the axes and the path allow along a curve at a point, while it runs straight there.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "axes/path_time/curve.hpp"
#include "core/math.hpp"

namespace taktwerk::axes {

/// Where nothing is limited.
inline constexpr double unlimited = std::numeric_limits<double>::infinity();

/// u/s, u/s2, u/s3 of s.
struct AlongLimits {
    double velocity, acceleration, deceleration, jerk;
};

/// x^(2/3): v2 goes so with a jerk.
[[nodiscard]] inline double two_thirds(double x) noexcept {
    const double root = math::cbrt(x);
    return root * root;
}

[[nodiscard]] inline AlongLimits along_limits(const TimedCurvePoint& p, std::span<const PathAxisLimits> limits,
                                              double velocity_factor) noexcept {
    AlongLimits l{p.path.velocity * velocity_factor, p.path.acceleration, p.path.deceleration, p.path.jerk};
    for (std::size_t i = 0; i < limits.size(); ++i) {
        const double q = std::fabs(p.first[i]);
        if (q < 1e-12) continue;
        l.velocity = std::min(l.velocity, limits[i].velocity / q);
        l.acceleration = std::min(l.acceleration, limits[i].acceleration / q);
        l.deceleration = std::min(l.deceleration, limits[i].acceleration / q);
        l.jerk = std::min(l.jerk, limits[i].jerk / q);
    }
    return l;
}

}  // namespace taktwerk::axes
