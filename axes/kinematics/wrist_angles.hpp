#pragma once
// The three angles of a spherical wrist: Rz(first) Ry(second) Rz(third). Pure, real-time safe.

#include <cmath>
#include <numbers>

#include "axes/kinematics/angle_of.hpp"
#include "axes/kinematics/frame.hpp"

namespace taktwerk::axes {

/// Below this sine of the middle angle the outer two are one rotation: the first keeps what is handed in, and the third takes the rest. The
/// orientation is wrong by at most twice this, rad.
inline constexpr double wrist_held_below = 1e-12;

struct WristAngles {
    double first = 0, second = 0, third = 0;
};

/// Both ways, second >= 0 first; angles within two turns. The third angle is taken from what the first two leave, so that all three together
/// are right to rounding although the outer ones, near the singularity, are not.
inline void wrist_angles(const Frame<double>& turn, double held_first, WristAngles (&ways)[2]) noexcept {
    constexpr double pi = std::numbers::pi;
    const double x = turn.axis[2][0], y = turn.axis[2][1], sine = std::sqrt(x * x + y * y);
    const bool held = sine < wrist_held_below;
    const double c = held ? std::cos(held_first) : x / sine, s = held ? std::sin(held_first) : y / sine;
    WristAngles& w = ways[0];
    w.first = held ? held_first : angle_of(s, c);
    w.second = angle_of(held ? std::abs(c * x + s * y) : sine, turn.axis[2][2]);
    w.third = angle_of(c * turn.axis[0][1] - s * turn.axis[0][0], c * turn.axis[1][1] - s * turn.axis[1][0]);
    // The other way: the outer two half a turn on. Held, the first one stays.
    ways[1] = held ? WristAngles{w.first, -w.second, w.third} : WristAngles{w.first + pi, -w.second, w.third + pi};
}

}  // namespace taktwerk::axes
