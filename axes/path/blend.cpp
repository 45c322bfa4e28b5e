#include "axes/path/blend.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {
namespace {

constexpr double turn_back = 1e-2;      // |t0 + t1| below which the path turns back: no curve is passed well
constexpr double least_length = 1e-12;  // of a blend, as part of its elements

/// How much of the parameter one unit of length is worth: near a straight line the curve's speed is constant with 2; a sharper corner is
/// rounder with less. Between the least greatest curvature and the least change of it (docs/motion/path.md).
double stretch_of(const PathVector& before, const PathVector& behind) { return 2 - 0.1 * (behind - before).squaredNorm(); }

std::optional<Blend> curve_at(const PathElement& first, const PathElement& second, double distance) {
    const PathPoint from = first.at(first.length() - distance), to = second.at(distance);
    const PathVector corner = second.at(0).at;
    if ((from.first + to.first).norm() < turn_back) return std::nullopt;
    const Quintic curve(from, to, stretch_of(from.first, to.first) * distance);
    if (!curve.smooth()) return std::nullopt;
    Blend b;
    b.curve = PathElement::quintic(curve);
    b.before = b.behind = distance;
    b.deviation = (curve.point(0.5) - corner).norm();
    return b;
}

}  // namespace

std::optional<Blend> blend(const PathElement& first, const PathElement& second, const BlendRequest& request, double room_before,
                           double room_behind) noexcept {
    if (request.rule == BlendRule::none || !(request.parameter > 0)) return std::nullopt;
    const double most = std::min(room_before, room_behind);
    if (!(most > least_length * (first.length() + second.length()))) return std::nullopt;
    if (request.rule == BlendRule::corner_distance) return curve_at(first, second, std::min(request.parameter, most));

    // Deviation: between lines it is distance times a factor of the angle; curves need a few corrections of that.
    double distance = most;
    std::optional<Blend> found = curve_at(first, second, distance);
    for (int i = 0; i < 40; ++i) {
        if (!found) return std::nullopt;
        if (found->deviation <= request.parameter * (1 + 1e-12)) return found;
        distance *= request.parameter / found->deviation * (i == 0 ? 1 : 1 - 1e-9);
        found = curve_at(first, second, distance);
    }
    return found;
}

bool meet_smoothly(const PathElement& first, const PathElement& second) noexcept {
    const PathPoint a = first.at(first.length()), b = second.at(0);
    return (a.first - b.first).norm() < 1e-9 && (a.second - b.second).norm() * std::min(first.length(), second.length()) < 1e-9;
}

}  // namespace taktwerk::axes
