#pragma once
// Two links in a plane: the angles at which they reach a point. Sines and cosines come with the angles, consistent to rounding even where the
// links are stretched or folded: there the angle between them is known to the root of the rounding only, and the first one makes up for it.
// Pure, real-time safe.

#include <algorithm>
#include <cmath>

#include "axes/kinematics/angle_of.hpp"
#include "axes/kinematics/arm_solutions.hpp"

namespace taktwerk::axes {

/// Of x = first cos(a) + second cos(a + between), y = first sin(a) + second sin(a + between).
struct TwoLinks {
    double sine = 0, cosine = 1;                  ///< of a
    double between_sine = 0, between_cosine = 1;  ///< of the angle between the links, 0 when stretched

    [[nodiscard]] double angle() const noexcept { return angle_of(sine, cosine); }
    [[nodiscard]] double between() const noexcept { return angle_of(between_sine, between_cosine); }
    [[nodiscard]] TwoLinks with_end_turned() const noexcept {  ///< sine and cosine of a + between
        return {sine * between_cosine + cosine * between_sine, cosine * between_cosine - sine * between_sine, between_sine, between_cosine};
    }
};

/// Both ways, the one with between >= 0 first. Where the links fold onto their root, `fallback_angle` becomes a. Lengths > 0.
/// False: out of reach by `lacking` (unit of length).
[[nodiscard]] inline bool links_reach(double first, double second, double x, double y, double fallback_angle, TwoLinks (&ways)[2],
                                      double& lacking) noexcept {
    const double distance = std::sqrt(x * x + y * y);
    const double longest = first + second, shortest = std::abs(first - second);
    lacking = std::max(distance - longest, shortest - distance);
    if (!(lacking <= edge_rounding * longest)) return false;
    const double product = std::max(0.0, (longest - distance) * (distance - shortest)) * (longest + distance) * (distance + shortest);
    const double scale = 1 / (2 * first * second);
    const double sine = std::sqrt(product) * scale;
    const double cosine = std::clamp((distance * distance - first * first - second * second) * scale, -1.0, 1.0);
    const double along = first + second * cosine, across = second * sine, square = distance * distance;
    const bool folded = distance < edge_rounding * longest;
    for (int way = 0; way < 2; ++way) {
        const double side = way == 0 ? across : -across;
        TwoLinks& w = ways[way];
        w.between_sine = way == 0 ? sine : -sine;
        w.between_cosine = cosine;
        w.sine = folded ? std::sin(fallback_angle) : (along * y - side * x) / square;
        w.cosine = folded ? std::cos(fallback_angle) : (along * x + side * y) / square;
    }
    return true;
}

}  // namespace taktwerk::axes
