#pragma once
// The samples of a measurement with everything of one instant side by side. A set-point takes effect later and an actual value was taken
// earlier: the dead time between the two is found from the samples themselves, by the following error, which knows it
// (axes/axis/following_error.hpp). Not real-time.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "axes/excitation/excitation_plan.hpp"
#include "axes/excitation/measure_sample.hpp"

namespace taktwerk::axes::measuring {

/// As it was recorded, oldest sample first. Positions of a modulo axis must be unwrapped.
struct SampleRun {
    ExcitationPlan plan;
    std::vector<MeasureSample> samples;
};

/// One entry per sample, in the instants at which the drive took its actual values. u, u/s, u/s2, rated torques.
struct AlignedRun {
    double cycle = 0;                                       ///< s
    double dead_time = 0;                                   ///< s, from a set-point's computation to the actual value that answers to it
    std::uint64_t lost = 0;                                 ///< cycles without a sample
    std::uint64_t stale = 0;                                ///< samples without an answer of the drive
    std::vector<double> time;                               ///< s since the first set-point
    std::vector<double> reference, velocity, acceleration;  ///< the set-point in effect
    std::vector<double> actual, actual_velocity, torque;
    std::vector<std::size_t> leg;  ///< of the set-point in effect
    std::vector<bool> holds;
    std::vector<double> leg_begin;  ///< s, of each leg: one cycle before its first set-point

    [[nodiscard]] std::size_t size() const noexcept { return time.size(); }
};

/// u per sample; unwraps the set and actual positions of a modulo axis.
void unwrap(std::vector<MeasureSample>& samples, double modulo);

/// Fewer samples than ten give an empty run.
[[nodiscard]] AlignedRun align(const SampleRun& run);

/// Samples [begin, end) of one leg.
struct LegRange {
    std::size_t begin = 0, end = 0;
};
/// Empty where there is none of this leg.
[[nodiscard]] LegRange range_of(const AlignedRun& run, std::size_t leg);

/// Of a leg: where the set-point in effect moves at one velocity, its later half, when what the ramp has stirred up is over. Empty where there is none.
[[nodiscard]] LegRange steady_part(const AlignedRun& run, LegRange leg);

}  // namespace taktwerk::axes::measuring
