#include "axes/path/transition.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {

BlendRequest start_velocity_transition(double factor, const PathFeed& before, const PathFeed& behind) noexcept {
    const double v = std::min(before.velocity, behind.velocity), a = std::min(before.deceleration, behind.acceleration);
    const double j = std::min(before.jerk, behind.jerk);
    // Jerk-limited braking from v: where a is not reached, in 2 sqrt(v/j) at v/2 in the mean.
    const double way = v * j >= a * a ? v * v / (2 * a) + v * a / (2 * j) : v * std::sqrt(v / j);
    return {BlendRule::corner_distance, factor * way};
}

BlendRequest constant_velocity_transition(double factor, const PathFeed& feed_before, const PathFeed& feed_behind, const PathVector& before,
                                          const PathVector& behind) noexcept {
    const double v = factor * std::min(feed_before.velocity, feed_behind.velocity);
    const double a = std::min({feed_before.acceleration, feed_behind.acceleration, feed_before.deceleration, feed_behind.deceleration});
    // The curve of distance 1, whose greatest curvature a distance d divides.
    const PathElement first = PathElement::line(-before, PathVector::Zero()), second = PathElement::line(PathVector::Zero(), behind);
    const auto unit = blend(first, second, {BlendRule::corner_distance, 1}, 1, 1);
    if (!unit) return {};
    double curvature = 0;
    constexpr int samples = 64;
    for (int i = 0; i <= samples; ++i) curvature = std::max(curvature, unit->curve.at(unit->curve.length() * i / samples).second.norm());
    return {BlendRule::corner_distance, curvature * v * v / a};
}

}  // namespace taktwerk::axes
