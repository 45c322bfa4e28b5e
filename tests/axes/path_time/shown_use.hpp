#pragma once
// What share of its limits a motion uses, written down once more for the tests: the planner's own limit_use() would agree with itself.
// q. = q' v, q.. = q' a + q'' v^2, q... = q' j + 3 q'' v a + q''' v^3 (docs/motion/path.md, equation 1).

#include <cmath>
#include <span>

#include "axes/path_time/limit_use.hpp"

namespace taktwerk::axes {

[[nodiscard]] inline LimitUse shown_use(const TimedCurvePoint& p, std::span<const PathAxisLimits> limits, double velocity_factor,
                                        const PathMotion& m) {
    LimitUse use;
    use.velocity = m.velocity / velocity_factor / p.path.velocity;
    use.acceleration = m.acceleration < 0 ? -m.acceleration / p.path.deceleration : m.acceleration / p.path.acceleration;
    use.jerk = std::fabs(m.jerk) / p.path.jerk;
    const double square = m.velocity * m.velocity;
    for (std::size_t i = 0; i < limits.size(); ++i) {
        const double first = p.first[i], second = p.second[i], third = p.third[i];
        const double speed = first * m.velocity, faster = first * m.acceleration + second * square;
        const double jerk = first * m.jerk + 3 * (second * (m.velocity * m.acceleration)) + third * (square * m.velocity);
        use.widen({std::fabs(speed) / limits[i].velocity, std::fabs(faster) / limits[i].acceleration, std::fabs(jerk) / limits[i].jerk});
    }
    return use;
}

}  // namespace taktwerk::axes
