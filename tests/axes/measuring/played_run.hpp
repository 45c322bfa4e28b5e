#pragma once
// Samples of a measurement as an axis would give them that is known exactly.

#include <cmath>
#include <functional>
#include <random>

#include "axes/excitation/excitation.hpp"
#include "axes/measuring/aligned_run.hpp"

namespace taktwerk::axes::measuring {

/// 1 ms; 200 u/s, 5000 u/s2, 100000 u/s3; 10 u a turn.
inline ExcitationBounds plain_bounds() {
    ExcitationBounds b;
    b.start = 100;
    b.velocity = 200, b.usual_velocity = 50;
    b.acceleration = b.stop = 5000;
    b.jerk = 100000;
    b.revolution = 10;
    b.cycle = 1e-3;
    return b;
}

struct Answer {
    double position = 0, velocity = 0, torque = 0;
};

/// `axis` is asked for each set-point in effect what the axis does then; `delay` cycles lie between the set-point and its effect.
/// `resolution`: of the encoder, u; `torque_step`: of the torque.
inline SampleRun play(const MeasureOrder& order, double delay, const std::function<Answer(const MotionState&, double)>& axis,
                      double resolution = 0, double torque_step = 0, const ExcitationBounds& bounds = plain_bounds()) {
    SampleRun run{ExcitationPlan(order, bounds), {}};
    Excitation excitation(run.plan);
    std::vector<MotionState> set;
    MotionState next;
    const auto rounded = [](double value, double step) { return step > 0 ? std::round(value / step) * step : value; };
    for (bool on = run.plan.refusal() == ExcitationRefusal::none; on;) {
        on = excitation.step(next);
        set.push_back(next);
        const double at = static_cast<double>(set.size() - 1) - delay;
        MotionState in_effect{bounds.start, 0, 0};
        if (at >= 0) {
            const auto before = static_cast<std::size_t>(at);
            const double part = at - static_cast<double>(before);
            const auto& a = set[before];
            const auto& b = set[std::min(before + 1, set.size() - 1)];
            in_effect = {a.position + part * (b.position - a.position), a.velocity + part * (b.velocity - a.velocity),
                         a.acceleration + part * (b.acceleration - a.acceleration)};
        }
        const auto answer = axis(in_effect, at * bounds.cycle);
        MeasureSample sample;
        sample.cycle = 1000 + set.size();
        sample.run = 1;
        sample.leg = static_cast<std::uint16_t>(excitation.leg());
        sample.holds = excitation.holds();
        sample.fresh = true;
        sample.set_position = next.position, sample.set_velocity = next.velocity, sample.set_acceleration = next.acceleration;
        sample.actual_position = rounded(answer.position, resolution);
        sample.actual_velocity = answer.velocity;
        sample.following_error = in_effect.position - sample.actual_position;
        sample.torque = rounded(answer.torque, torque_step);
        run.samples.push_back(sample);
    }
    return run;
}

}  // namespace taktwerk::axes::measuring
