// The coordinates of an axis with an absolute encoder over a time without power: what is to be kept, and what is made of it.

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

namespace {

/// How far it may be from where it was written, in the direction in which it is [u]. At rest: what the configuration calls normal. In motion it
/// may have gone on for as far as it is written about (an eighth of the encoder's range, and as much again on the way to the disk) and then
/// have coasted; but never beyond its travel. Coasting: twice its braking distance, for nobody brakes it.
double believable_way(const RetainedPosition& kept, const AxisConfig& config, double counts_per_unit, std::int64_t range,
                      double sense) noexcept {
    if (kept.at_rest) return config.memory.moved_while_off;
    const auto& limits = config.limits;
    const double coasting = limits.velocity * limits.velocity / limits.deceleration;
    const double written_within = static_cast<double>(range) / 4 / std::abs(counts_per_unit);
    if (config.modulo > 0) return written_within + coasting;
    const double from = kept.shift + static_cast<double>(kept.counts) / counts_per_unit;
    const double room = sense < 0 ? from - limits.position_min : limits.position_max - from;
    return std::max(std::min(room, written_within) + coasting, 0.0);
}

}  // namespace

RetainedPosition AxisCore::retained() const noexcept {
    if (!seeded_) return retained_;  // what was kept stays until something better is known
    return {.homed = view_.homed && seeded_ && absolute_encoder(),
            .shift = units_.shift(),
            .counts = actual_counts_,
            .at_rest = !moves() && drive_stands()};
}

void AxisCore::restore(const RetainedPosition& position, const Gearing& gearing) noexcept {
    if (!absolute_encoder() || !position.homed || !std::isfinite(position.shift)) return;
    if (!same_coordinates(gearing, config_.gearing)) {
        fail(AxisAlarm::retained_gearing_differs);
        return;
    }
    retained_ = position;
}

/// At the first position after power-on.
void AxisCore::apply_retained() noexcept {
    if (!retained_.homed) return;
    const auto there = unwrapped_near(retained_.counts, actual_counts_, encoder_range());
    const double way = static_cast<double>(there - retained_.counts) / units_.counts_per_unit();
    const double moved = std::abs(way), permitted = believable_way(retained_, config_, units_.counts_per_unit(), encoder_range(), way);
    if (moved > permitted) fail(AxisAlarm::moved_while_off, moved, permitted);
    else {
        units_.shift_by(retained_.shift + static_cast<double>(there - actual_counts_) / units_.counts_per_unit());
        view_.homed = true;
    }
    retained_ = {};
}

}  // namespace taktwerk::axes
