#include "axes/measuring/feed_forward.hpp"

#include <algorithm>
#include <cmath>

#include "axes/measuring/least_squares.hpp"
#include "axes/measuring/step_response.hpp"

namespace taktwerk::axes::measuring {

namespace {

constexpr double correlated = 20;  // samples after which the loops have forgotten
constexpr std::size_t least_moving = 100;

}  // namespace

FeedForward feed_forward(const AlignedRun& run, double torque_limit) {
    FeedForward out;
    out.torque = torque_model(run, torque_limit);
    if (run.size() == 0) {
        out.doubt = Doubt::no_samples;
        return out;
    }
    // What a loop leaves behind at a ramp takes its time to die out: velocity and friction are read where that is over.
    LeastSquares<3> steady;
    for (std::size_t leg = 0; leg <= run.leg.back(); ++leg) {
        const auto part = steady_part(run, range_of(run, leg));
        for (std::size_t i = part.begin; i < part.end; ++i)
            steady.add({1, run.velocity[i], run.velocity[i] > 0 ? 1.0 : -1.0}, run.reference[i] - run.actual[i]);
    }
    const auto solved = steady.solve(1e-4);
    if (steady.rows() < least_moving || !solved.solved) {
        out.doubt = Doubt::too_little_motion;
        return out;
    }
    const auto& c = solved.c;
    LeastSquares<1> moving;
    double squares = 0, sum = 0, n = 0;
    const auto each_moving = [&](auto&& take) {
        for (std::size_t i = 0; i < run.size(); ++i)
            if (run.velocity[i] != 0) take(i, run.reference[i] - run.actual[i]);
    };
    const auto left = [&](std::size_t i, double error) {
        return error - c[0].value - c[1].value * run.velocity[i] - c[2].value * (run.velocity[i] > 0 ? 1.0 : -1.0);
    };
    each_moving([&](std::size_t i, double error) {
        squares += error * error, sum += error, ++n;
        moving.add({run.acceleration[i]}, left(i, error));
    });
    const auto by_acceleration = moving.solve();
    const auto widened = [](Estimate e) {
        e.deviation *= std::sqrt(correlated);
        return e;
    };
    out.offset = widened(c[0]);
    out.lag = widened(c[1]);
    out.per_direction = widened(c[2]);
    if (by_acceleration.solved) out.per_acceleration = widened(by_acceleration.c[0]);
    double squares_left = 0;
    each_moving([&](std::size_t i, double error) {
        const double rest = left(i, error) - out.per_acceleration.value * run.acceleration[i];
        squares_left += rest * rest;
    });
    out.rms = std::sqrt(squares / n);
    out.rms_left = std::sqrt(squares_left / n);
    const double spread = squares - sum * sum / n;
    out.explained = spread > 0 ? std::max(0.0, 1 - squares_left / spread) : 0;
    if (out.rms < resolution_of(run)) out.doubt = Doubt::nothing_to_see;
    else if (run.lost * 100 > run.size()) out.doubt = Doubt::lost_samples;
    else if (out.torque.doubt == Doubt::saturated) out.doubt = Doubt::saturated;
    return out;
}

}  // namespace taktwerk::axes::measuring
