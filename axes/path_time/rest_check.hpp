#pragma once
// How fast the piece at constant jerk may be that begins a run from rest, or ends it.

#include <cmath>
#include <span>
#include <vector>

#include "axes/path_time/curve.hpp"
#include "axes/path_time/limit_use.hpp"

namespace taktwerk::axes {

class RestCheck {
public:
    /// The greatest v2 at the moving end of such a piece, which lies over `length` behind (after) or in front of (before) `at`. Service side.
    [[nodiscard]] double greatest_square(const TimedCurve& curve, std::span<const PathAxisLimits> limits, double velocity_factor, double at,
                                         double length, CurveSide side);
    /// Of the greatest jerk that anything has in that piece, the part that something has at every moment of it. It does not depend on how fast the
    /// piece is: all jerk goes with v3.
    [[nodiscard]] double jerk_throughout(const TimedCurve& curve, std::span<const PathAxisLimits> limits, double at, double length,
                                         CurveSide side);

private:
    void sample(const TimedCurve& curve, double at, double length, CurveSide side, std::size_t samples);
    [[nodiscard]] LimitUse use(std::span<const PathAxisLimits> limits, double velocity_factor, double length, double sign, double square);

    std::vector<TimedCurvePoint> points_;  // at equal times, from rest
    std::vector<double> x_, y_, z_;
    std::vector<double> most_jerk_;  // of anything, at the points
};

}  // namespace taktwerk::axes
