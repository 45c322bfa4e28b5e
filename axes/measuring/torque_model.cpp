#include "axes/measuring/torque_model.hpp"

#include <algorithm>
#include <cmath>

#include "axes/measuring/least_squares.hpp"
#include "axes/measuring/step_response.hpp"

namespace taktwerk::axes::measuring {

namespace {

constexpr double window_time = 0.04;      // s: long against a cycle, short against a ramp
constexpr std::size_t least_window = 12;  // samples
constexpr std::size_t least_windows = 30;

/// (1 - s^2)^3 on [-1, 1], with its first two derivatives over s.
struct Weight {
    double value, first, second;
};
Weight weight(double s) {
    const double q = 1 - s * s;
    return {q * q * q, -6 * s * q * q, -6 * q * q + 24 * s * s * q};
}

}  // namespace

TorqueModel torque_model(const AlignedRun& run, double limit) {
    TorqueModel out;
    if (run.size() < least_window * 4) {
        out.doubt = Doubt::no_samples;
        return out;
    }
    for (const double torque : run.torque) out.highest = std::max(out.highest, std::abs(torque));
    const auto length = std::max(least_window, static_cast<std::size_t>(std::lround(window_time / run.cycle / 2) * 2));
    const double half = static_cast<double>(length) / 2;
    LeastSquares<4> equations;
    double travelled = 0;
    for (std::size_t begin = 0; begin + length < run.size(); begin += length / 4) {
        // Where it stands the friction may be anything below its limit; where it turns round it has two signs.
        // From the middle: there what the sums of a window leave of a constant and of a straight line is nothing.
        const double at = run.actual[begin + length / 2], from = run.velocity[begin];
        bool moves = run.time[begin + length] - run.time[begin] < (static_cast<double>(length) + 0.5) * run.cycle;
        for (std::size_t i = begin; moves && i <= begin + length; ++i) moves = run.velocity[i] * from > 0;
        if (!moves) continue;
        // Divided by what the same sums make of s and s^2 / 2: exact for a parabola, however few samples a window has.
        double torque = 0, velocity = 0, acceleration = 0, one = 0, straight = 0, curved = 0;
        for (std::size_t i = begin; i <= begin + length; ++i) {
            const double s = (static_cast<double>(i - begin) - half) / half;
            const auto w = weight(s);
            const double position = run.actual[i] - at;
            one += w.value;
            straight -= w.first * s;
            curved += w.second * s * s / 2;
            torque += w.value * run.torque[i];
            velocity -= w.first * position / (half * run.cycle);
            acceleration += w.second * position / (half * half * run.cycle * run.cycle);
        }
        torque /= one, velocity /= straight, acceleration /= curved;
        travelled += std::abs(velocity);
        equations.add({1, velocity > 0 ? 1.0 : -1.0, velocity, acceleration}, torque);
    }
    const auto solved = equations.solve(1e-4);
    if (equations.rows() < least_windows || !solved.solved) {
        out.doubt = travelled > 0 ? Doubt::too_little_motion : Doubt::nothing_to_see;
        return out;
    }
    // Windows overlap four times: so many fewer are independent.
    const auto widened = [](Estimate e) {
        e.deviation *= 2;
        return e;
    };
    out.gravity = widened(solved.c[0]);
    out.coulomb = widened(solved.c[1]);
    out.viscous = widened(solved.c[2]);
    out.inertia = widened(solved.c[3]);
    out.residual = solved.residual;
    out.explained = solved.explained;
    // A ramp that takes less torque than what is left unexplained says nothing of the inertia.
    out.inertia.known = out.inertia.known && std::abs(out.inertia.value) > 3 * out.inertia.deviation && out.inertia.value > 0;
    if (out.highest == 0) out.doubt = Doubt::nothing_to_see;
    else if (out.highest >= 0.98 * limit) out.doubt = Doubt::saturated;
    else if (run.lost * 100 > run.size()) out.doubt = Doubt::lost_samples;
    return out;
}

}  // namespace taktwerk::axes::measuring
