#include "axes/measuring/feed_forward.hpp"

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
    LeastSquares<4> equations;
    double squares = 0;
    for (std::size_t i = 0; i < run.size(); ++i) {
        if (run.velocity[i] == 0) continue;
        const double error = run.reference[i] - run.actual[i];
        squares += error * error;
        equations.add({1, run.velocity[i], run.acceleration[i], run.velocity[i] > 0 ? 1.0 : -1.0}, error);
    }
    if (run.size() == 0) out.doubt = Doubt::no_samples;
    else if (equations.rows() < least_moving) out.doubt = Doubt::too_little_motion;
    if (out.doubt != Doubt::none) return out;
    out.rms = std::sqrt(squares / static_cast<double>(equations.rows()));
    const auto solved = equations.solve(1e-4);
    if (!solved.solved) {
        out.doubt = Doubt::too_little_motion;
        return out;
    }
    const auto widened = [](Estimate e) {
        e.deviation *= std::sqrt(correlated);
        return e;
    };
    out.offset = widened(solved.c[0]);
    out.lag = widened(solved.c[1]);
    out.per_acceleration = widened(solved.c[2]);
    out.per_direction = widened(solved.c[3]);
    out.rms_left = solved.residual;
    out.explained = solved.explained;
    if (out.rms < resolution_of(run)) out.doubt = Doubt::nothing_to_see;
    else if (run.lost * 100 > run.size()) out.doubt = Doubt::lost_samples;
    else if (out.torque.doubt == Doubt::saturated) out.doubt = Doubt::saturated;
    return out;
}

}  // namespace taktwerk::axes::measuring
