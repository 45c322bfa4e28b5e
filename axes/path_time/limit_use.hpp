#pragma once
// What share of its limits a motion uses.

#include <algorithm>
#include <cmath>
#include <span>

#include "axes/path_time/curve.hpp"
#include "axes/path_time/time_piece.hpp"

namespace taktwerk::axes {

/// What share of its limits a motion uses at most, over everything that was looked at: 1 is the limit.
struct LimitUse {
    double velocity = 0;
    double acceleration = 0;
    double jerk = 0;

    void widen(const LimitUse& other) noexcept {
        velocity = std::max(velocity, other.velocity);
        acceleration = std::max(acceleration, other.acceleration);
        jerk = std::max(jerk, other.jerk);
    }
    /// Whether it may be run: velocity and acceleration with a hair left for what lies between samples, jerk within what is promised.
    [[nodiscard]] bool inside() const noexcept { return velocity <= 1 - 2e-6 && acceleration <= 1 - 2e-6 && jerk <= 1 + 2e-4; }
};

/// The use of all limits at a point of the curve by a motion along it.
[[nodiscard]] inline LimitUse limit_use(const TimedCurvePoint& p, std::span<const PathAxisLimits> limits, double velocity_factor,
                                        const PathMotion& m) noexcept {
    const double v = m.velocity, a = m.acceleration, j = m.jerk;
    LimitUse use{v / (p.path.velocity * velocity_factor), std::max(a / p.path.acceleration, -a / p.path.deceleration),
                 std::fabs(j) / p.path.jerk};
    for (std::size_t i = 0; i < limits.size(); ++i) {
        use.velocity = std::max(use.velocity, std::fabs(p.first[i] * v) / limits[i].velocity);
        use.acceleration = std::max(use.acceleration, std::fabs(p.first[i] * a + p.second[i] * v * v) / limits[i].acceleration);
        use.jerk = std::max(use.jerk, std::fabs(p.first[i] * j + 3 * p.second[i] * v * a + p.third[i] * v * v * v) / limits[i].jerk);
    }
    return use;
}

}  // namespace taktwerk::axes
