#pragma once
// What became of moves to a position (MeasureKind::step) and at one velocity (MeasureKind::ramp).

#include <cstddef>
#include <vector>

#include "axes/measuring/aligned_run.hpp"
#include "axes/measuring/quality.hpp"

namespace taktwerk::axes::measuring {

/// One move. u, s.
struct MoveResponse {
    std::size_t leg = 0;
    double distance = 0;       ///< signed
    double overshoot = 0;      ///< furthest beyond the target, after the set-point has arrived; 0 = never beyond
    double settling_time = 0;  ///< from the set-point's arrival until it stays inside the window
    bool settled = false;      ///< false: it did not while it was watched
    double rise_time = 0;      ///< of the actual position, from 10 % to 90 % of the distance
    double largest_error = 0;  ///< following error, magnitude
    double rms_error = 0;      ///< while it moves
    double at_velocity = 0;    ///< mean following error at constant velocity, in the sense of the motion
    double ripple = 0;         ///< u/s, standard deviation of the actual velocity there
    std::size_t cruised = 0;   ///< samples of constant velocity
};

struct StepResponse {
    Doubt doubt = Doubt::none;
    double window = 0;      ///< u: settling
    double resolution = 0;  ///< u: the smallest step of the actual position
    std::vector<MoveResponse> moves;
    // Of all moves: mean, and how much they differ.
    Estimate overshoot, settling_time, rise_time, largest_error, at_velocity, ripple;
    bool all_settled = false;
    double lag = 0;  ///< s: following error per velocity
};

/// `window`: u > 0.
[[nodiscard]] StepResponse step_response(const AlignedRun& run, const ExcitationPlan& plan, double window);

/// The smallest difference between two actual positions that are not the same, u; 0: they are all the same.
[[nodiscard]] double resolution_of(const AlignedRun& run);

}  // namespace taktwerk::axes::measuring
