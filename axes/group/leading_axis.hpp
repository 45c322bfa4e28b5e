#pragma once
// An axis that leads a group, as the group has to see it: it is planned behind the group, or measured. Real-time safe.

#include <optional>

#include "axes/coupling/master_track.hpp"

namespace taktwerk::axes {

class Axis;

/// Set-points of an axis with a drive, measured positions of an encoder.
[[nodiscard]] MasterTrack::Reading leading_reading(const Axis& axis) noexcept;

/// Where it will be one period [s] on, when the set-points of this cycle act. A set-point goes on with its acceleration; what is measured has been
/// filtered, and is as old as its latch. Nothing: it has no position, or that jumped.
[[nodiscard]] std::optional<EndlessMotion> next_of_leading(MasterTrack& track, const Axis& axis, Instant now, double period) noexcept;

}  // namespace taktwerk::axes
