#pragma once
// What a slave keeps while it follows.

#include <algorithm>

#include "axes/planner/motion.hpp"

namespace taktwerk::axes {

struct FollowerLimits {
    MotionLimits axis;      ///< never exceeded (but for the jerk)
    MotionLimits approach;  ///< of the difference motion; its velocity is not used
    double forward = axis.velocity,
           backward = axis.velocity;  ///< velocity in each sense, u/s, >= 0: less where something else moves the axis too

    [[nodiscard]] double room(double sense) const noexcept { return sense < 0 ? backward : forward; }
    [[nodiscard]] double inside(double velocity) const noexcept { return std::clamp(velocity, -backward, forward); }
};

}  // namespace taktwerk::axes
