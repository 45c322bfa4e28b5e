#pragma once
// Step 7 for all axes of a machine: masters before their slaves, so that a slave follows this cycle's set-point of its master and a
// chain of any length has no dead time of its own.

#include <span>

#include "axes/axis/axis.hpp"

namespace taktwerk::axes {

/// Plans every axis once. In the order of the data flow, whatever their order in `axes`; axes without couplings keep it. Linear in
/// axes and couplings, no allocation. All axes must be bound to a scene of exactly these axes (or to none: then nothing is coupled).
void plan_axes(std::span<Axis> axes, Instant now, Duration period) noexcept;

}  // namespace taktwerk::axes
