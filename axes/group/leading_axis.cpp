#include "axes/group/leading_axis.hpp"

#include <algorithm>

#include "axes/axis/axis.hpp"

namespace taktwerk::axes {

MasterTrack::Reading leading_reading(const Axis& axis) noexcept {
    return axis.as_master(axis.config().encoder ? mcActualValue : mcSetValue);
}

std::optional<EndlessMotion> next_of_leading(MasterTrack& track, const Axis& axis, Instant now, double period) noexcept {
    auto reading = leading_reading(axis);
    if (!reading.planned) reading.age = std::max(0.0, to_seconds(now - reading.taken)) + period;
    if (!track.next(reading, period)) return std::nullopt;
    auto motion = track.motion();
    if (!reading.planned) return motion;
    motion.place.local += period * (motion.velocity + period * motion.acceleration / 2);
    motion.velocity += period * motion.acceleration;
    return motion;
}

}  // namespace taktwerk::axes
