#pragma once
// What repeats with the position: torque, and what is left of it in following error and velocity (MeasureKind::cogging). Not real-time.

#include <vector>

#include "axes/measuring/aligned_run.hpp"
#include "axes/measuring/quality.hpp"

namespace taktwerk::axes::measuring {

/// So many waves in one period.
struct Harmonic {
    int order = 0;
    double torque = 0;    ///< rated torques, amplitude, what both directions have in common
    double error = 0;     ///< u, amplitude of the following error
    double velocity = 0;  ///< u/s, amplitude
};

struct CoggingResult {
    Doubt doubt = Doubt::none;
    double period = 0;                     ///< u
    double velocity = 0;                   ///< u/s
    std::size_t periods = 0;               ///< seen, in both directions together
    std::vector<Harmonic> harmonics;       ///< 1, 2, ... as far as there are four samples in a wave
    double peak_to_peak = 0;               ///< rated torques, of the curve
    double noise = 0;                      ///< rated torques: an amplitude below it is none
    std::vector<double> position, torque;  ///< u in the period; rated torques around their mean
};

[[nodiscard]] CoggingResult cogging(const AlignedRun& run, const ExcitationPlan& plan);

}  // namespace taktwerk::axes::measuring
