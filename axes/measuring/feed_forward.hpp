#pragma once
// What the following error is made of, and what the torque: moves of different velocity and acceleration (MeasureKind::following). Not real-time.

#include "axes/measuring/aligned_run.hpp"
#include "axes/measuring/torque_model.hpp"

namespace taktwerk::axes::measuring {

/// following error = offset + lag * v + per_acceleration * a + per_direction * sign(v)
struct FeedForward {
    Doubt doubt = Doubt::none;
    Estimate lag;               ///< s: what velocity feed-forward would take away
    Estimate per_acceleration;  ///< s2: what torque feed-forward would take away
    Estimate per_direction;     ///< u: what friction leaves
    Estimate offset;            ///< u
    double rms = 0;             ///< u, of the following error while it moved
    double rms_left = 0;        ///< u, without those four
    double explained = 0;       ///< part of its variance
    TorqueModel torque;
};

/// `torque_limit`: rated torques at which the drive ends; infinity = unknown.
[[nodiscard]] FeedForward feed_forward(const AlignedRun& run, double torque_limit);

}  // namespace taktwerk::axes::measuring
