#include "axes/kinematics/delta_arms.hpp"

#include <algorithm>

#include "axes/kinematics/level_turn.hpp"

namespace taktwerk::axes {
namespace {

using Centres = std::array<Triple<double>, 3>;

double gap_between(const Centres& centres, double rod) noexcept {
    double square = 0;
    (void)hung_from(centres, rod, square);
    if (square >= 0) return 0;
    return std::isfinite(square) ? std::sqrt(rod * rod - square) - rod : rod;
}

std::array<Triple<double>, 3> rods(const Centres& centres, const Triple<double>& platform, double rod) noexcept {
    std::array<Triple<double>, 3> u;
    for (std::size_t i = 0; i < 3; ++i) u[i] = plus({}, 1 / rod, minus(platform, centres[i]));
    return u;
}

double span(const std::array<Triple<double>, 3>& u) noexcept { return std::abs(dot(u[0], cross(u[1], u[2]))); }

/// Of a platform that hangs level: 0, or why not.
Miss orientation_miss(const Frame<double>& flange, bool turns, double& turn) noexcept {
    double tilt = 0;
    turn = turn_about(2, flange, tilt);
    if (!turns) {
        tilt = std::hypot(tilt, turn);
        turn = 0;
    }
    return tilt > tilt_rounding ? Miss{KinematicFault::orientation, -1, tilt} : Miss{};
}

}  // namespace

double RotaryDelta::gap(const Joints& joints) const noexcept { return gap_between(centres(joints), l_.rod); }
double LinearDelta::gap(const Joints& joints) const noexcept { return gap_between(centres(joints), l_.rod); }

ArmSolutions RotaryDelta::solve(const Frame<double>& flange, const Joints&) const noexcept {
    ArmSolutions found;
    Joints q{};
    found.miss = orientation_miss(flange, l_.turns, q[3]);
    double lacking = 0;
    for (std::size_t i = 0; i < 3 && found.miss.ok(); ++i) {
        // In the plane of the arm, from its axis: `out` and `z`; the rod's joint stands `aside` of that plane.
        const double out = flange.origin[0] * along_[i][0] + flange.origin[1] * along_[i][1] + l_.platform_radius - l_.base_radius;
        const double aside = flange.origin[1] * along_[i][0] - flange.origin[0] * along_[i][1], z = flange.origin[2];
        const double distance = std::hypot(out, z);
        const double nearest = std::hypot(distance - l_.upper, aside), furthest = std::hypot(distance + l_.upper, aside);
        lacking = std::max({lacking, nearest - l_.rod, l_.rod - furthest});
        // cos(q + direction) = cosine; the elbow outward is q = -direction - acos.
        const double scale = 1 / (2 * l_.upper * distance);
        const double cosine = std::clamp((distance * distance + l_.upper * l_.upper + aside * aside - l_.rod * l_.rod) * scale, -1.0, 1.0);
        const double sine =
            std::sqrt(std::max(0.0, (l_.rod - nearest) * (furthest - l_.rod)) * (l_.rod + nearest) * (furthest + l_.rod)) * scale;
        q[i] = std::atan2(-(z * cosine + out * sine), out * cosine - z * sine);
    }
    if (found.miss.ok() && !(lacking <= edge_rounding * (l_.upper + l_.rod))) found.missed(KinematicFault::out_of_reach, lacking);
    if (found.miss.ok()) found.add(q, {});
    return found;
}

Singularity RotaryDelta::singularity(const Joints& joints) const noexcept {
    const Centres c = centres(joints);
    const auto u = rods(c, forward(joints).origin, l_.rod);
    Singularity s;
    for (std::size_t i = 0; i < 3; ++i) {
        const Triple<double> way{-std::sin(joints[i]) * along_[i][0], -std::sin(joints[i]) * along_[i][1], -std::cos(joints[i])};
        s.consider(SingularityKind::inner, std::abs(dot(way, u[i])));
    }
    s.consider(SingularityKind::outer, span(u));
    return s;
}

ArmSolutions LinearDelta::solve(const Frame<double>& flange, const Joints&) const noexcept {
    ArmSolutions found;
    Joints q{};
    found.miss = orientation_miss(flange, l_.turns, q[3]);
    double lacking = 0;
    for (std::size_t i = 0; i < 3 && found.miss.ok(); ++i) {
        const double out = l_.base_radius - l_.platform_radius;
        const double level = std::hypot(out * along_[i][0] - flange.origin[0], out * along_[i][1] - flange.origin[1]);
        lacking = std::max(lacking, level - l_.rod);
        q[i] = flange.origin[2] + std::sqrt(std::max(0.0, (l_.rod - level) * (l_.rod + level)));
    }
    if (found.miss.ok() && !(lacking <= edge_rounding * l_.rod)) found.missed(KinematicFault::out_of_reach, lacking);
    if (found.miss.ok()) found.add(q, {});
    return found;
}

Singularity LinearDelta::singularity(const Joints& joints) const noexcept {
    const Centres c = centres(joints);
    const auto u = rods(c, forward(joints).origin, l_.rod);
    Singularity s;
    for (std::size_t i = 0; i < 3; ++i) s.consider(SingularityKind::inner, std::abs(u[i][2]));
    s.consider(SingularityKind::outer, span(u));
    return s;
}

}  // namespace taktwerk::axes
