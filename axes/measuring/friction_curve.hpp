#pragma once
// Torque over velocity, from moves to and fro at several velocities (MeasureKind::friction). Not real-time.

#include <vector>

#include "axes/measuring/aligned_run.hpp"
#include "axes/measuring/quality.hpp"

namespace taktwerk::axes::measuring {

/// One velocity in one direction.
struct FrictionPoint {
    double velocity = 0;   ///< u/s, signed
    double torque = 0;     ///< rated torques, mean
    double deviation = 0;  ///< of the mean
    double ripple = 0;     ///< standard deviation of the torque itself
};

struct FrictionCurve {
    Doubt doubt = Doubt::none;
    std::vector<FrictionPoint> points;  ///< velocity rises
    Estimate gravity;                   ///< rated torques: what is there in both directions
    // torque - gravity = sign(v) * coulomb + v * viscous, for each direction by itself.
    Estimate coulomb_positive, coulomb_negative;      ///< rated torques, both > 0 for friction
    Estimate viscous_positive, viscous_negative;      ///< rated torques per u/s
    Estimate coulomb, viscous;                        ///< of both together
    Estimate breakaway_positive, breakaway_negative;  ///< rated torques beyond gravity, before it moves from rest
};

/// `limit`: rated torques at which the drive ends; infinity = unknown.
[[nodiscard]] FrictionCurve friction_curve(const AlignedRun& run, const ExcitationPlan& plan, double limit);

}  // namespace taktwerk::axes::measuring
