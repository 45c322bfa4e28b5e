#pragma once
// Forward kinematics of the arms of jog_arms.hpp once more, with nothing of what is tested.

#include "tests/axes/group/by_hand.hpp"
#include "tests/axes/group/jog_arms.hpp"

namespace taktwerk::axes::test {

using Spot = std::array<double, 3>;

inline double far(const Spot& a, const Spot& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// Where the flange of an arm is, by nothing of what is tested. Members in degrees where they turn.
inline Spot flange_by_hand(const JogArm& arm, const JointVector& q, const Spot& near) {
    constexpr double deg = one_degree;
    const auto turn = [](double z) { return hand_frame({0, 0, 0, 0, 0, z}); };
    const auto lean = [](double y) { return hand_frame({0, 0, 0, 0, y, 0}); };
    const auto shift = [](double x, double y, double z) { return hand_frame({x, y, z, 0, 0, 0}); };
    const auto three_rods = [&](const std::array<Spot, 3>& from, double rod) {
        Spot p = near;  // Newton's method on three spheres
        for (int i = 0; i < 30; ++i) {
            std::array<std::array<double, 4>, 3> m{};
            for (std::size_t r = 0; r < 3; ++r) {
                double square = -rod * rod;
                for (std::size_t c = 0; c < 3; ++c) m[r][c] = 2 * (p[c] - from[r][c]), square += (p[c] - from[r][c]) * (p[c] - from[r][c]);
                m[r][3] = -square;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                std::size_t best = k;
                for (std::size_t r = k; r < 3; ++r)
                    if (std::abs(m[r][k]) > std::abs(m[best][k])) best = r;
                std::swap(m[k], m[best]);
                for (std::size_t r = 0; r < 3; ++r) {
                    if (r == k) continue;
                    const double f = m[r][k] / m[k][k];
                    for (std::size_t c = k; c < 4; ++c) m[r][c] -= f * m[k][c];
                }
            }
            for (std::size_t c = 0; c < 3; ++c) p[c] += m[c][3] / m[c][c];
        }
        return p;
    };
    if (arm.name == "cartesian") return {q[0], q[1], q[2]};
    if (arm.name == "scara") {
        const double a = q[0] * deg, b = a + q[1] * deg;
        return {200 * std::cos(a) + 150 * std::cos(b), 200 * std::sin(a) + 150 * std::sin(b), q[2]};
    }
    if (arm.name == "rotary_delta" || arm.name == "linear_delta") {
        const bool rotary = arm.name == "rotary_delta";
        std::array<Spot, 3> from{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double at = 120 * deg * static_cast<double>(i);
            const double out = rotary ? 100 - 40 + 150 * std::cos(q[i] * deg) : 200 - 40;
            from[i] = {out * std::cos(at), out * std::sin(at), rotary ? -150 * std::sin(q[i] * deg) : q[i]};
        }
        return three_rods(from, rotary ? 350 : 300);
    }
    HandFrame f;
    if (arm.name == "six_with_wrist") {
        f = turn(q[0] * deg) * shift(0, 0, 290) * lean(q[1] * deg) * shift(0, 0, 270) * lean(q[2] * deg + std::numbers::pi / 2) *
            shift(-70, 0, 302);
        f = f * turn(q[3] * deg) * lean(q[4] * deg) * turn(q[5] * deg) * shift(0, 0, 72);
        return f.o;
    }
    const double right = std::numbers::pi / 2;
    const std::array<std::array<double, 3>, 6> ur{
        {{0, right, 162.5}, {-425, 0, 0}, {-392.2, 0, 0}, {0, right, 133.3}, {0, -right, 99.7}, {0, 0, 99.6}}};
    for (std::size_t i = 0; i < 6; ++i)
        f = f * turn(q[i] * deg) * shift(0, 0, ur[i][2]) * shift(ur[i][0], 0, 0) * hand_frame({0, 0, 0, ur[i][1], 0, 0});
    return f.o;
}

}  // namespace taktwerk::axes::test
