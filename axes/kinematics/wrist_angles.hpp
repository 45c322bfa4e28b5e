#pragma once
// The three angles of a spherical wrist: Rz(first) Ry(second) Rz(third). Pure, real-time safe.

#include <cmath>

#include "axes/kinematics/frame.hpp"

namespace taktwerk::axes {

/// Below this sine of the middle angle the outer two are one rotation: the first keeps what is handed in, and the third takes the rest. The
/// orientation is wrong by at most twice this, rad.
inline constexpr double wrist_held_below = 1e-12;

struct WristAngles {
    double first = 0, second = 0, third = 0;
};

/// Both ways, second >= 0 first. The third angle is taken from what the first two leave, so that all three together are right to rounding
/// although the outer ones, near the singularity, are not.
inline void wrist_angles(const Frame<double>& turn, double held_first, WristAngles (&ways)[2]) noexcept {
    const double x = turn.axis[2][0], y = turn.axis[2][1], sine = std::hypot(x, y);
    for (int way = 0; way < 2; ++way) {
        WristAngles& w = ways[way];
        double c = 1, s = 0;
        if (sine < wrist_held_below) {
            w.first = held_first;
            c = std::cos(held_first);
            s = std::sin(held_first);
        } else {
            c = way == 0 ? x / sine : -x / sine;
            s = way == 0 ? y / sine : -y / sine;
            w.first = std::atan2(s, c);
        }
        const double middle = c * x + s * y;
        w.second = std::atan2(sine < wrist_held_below && way == 1 ? -std::abs(middle) : middle, turn.axis[2][2]);
        w.third = std::atan2(c * turn.axis[0][1] - s * turn.axis[0][0], c * turn.axis[1][1] - s * turn.axis[1][0]);
    }
}

}  // namespace taktwerk::axes
