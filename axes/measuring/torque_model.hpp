#pragma once
// What the torque of moves is made of: gravity, Coulomb and viscous friction, inertia. The acceleration is not differentiated from the encoder:
// both sides of Newton's law are weighted with smooth windows, and the two derivatives go to the window (weak form). So quantisation and noise
// average out, and nothing lags. Not real-time.

#include "axes/measuring/aligned_run.hpp"
#include "axes/measuring/quality.hpp"

namespace taktwerk::axes::measuring {

/// torque = gravity + coulomb * sign(v) + viscous * v + inertia * a. Rated torques; per u/s; per u/s2.
struct TorqueModel {
    Doubt doubt = Doubt::none;
    Estimate gravity, coulomb, viscous, inertia;
    double residual = 0;   ///< rated torques, of a window's mean
    double explained = 0;  ///< part of the variance of the torque
    double highest = 0;    ///< rated torques seen
};

/// `limit`: rated torques at which the drive ends; infinity = unknown.
[[nodiscard]] TorqueModel torque_model(const AlignedRun& run, double limit);

}  // namespace taktwerk::axes::measuring
