#include "axes/axis/retained_coordinates.hpp"

#include <algorithm>
#include <cmath>

#include "axes/axis/conduct.hpp"

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

void RetainedCoordinates::restore(const RetainedPosition& position, const Gearing& gearing) noexcept {
    if (!measured_.absolute_encoder() || !position.homed || !std::isfinite(position.shift)) return;
    if (!same_coordinates(gearing, body_.config.gearing)) {
        conduct_.fail(AxisAlarm::retained_gearing_differs);
        return;
    }
    kept_ = position;
}

void RetainedCoordinates::apply() noexcept {
    if (!kept_.homed) return;
    const auto there = unwrapped_near(kept_.counts, measured_.counts, measured_.encoder_range());
    const double way = static_cast<double>(there - kept_.counts) / body_.units.counts_per_unit();
    const double moved = std::abs(way),
                 permitted = believable_way(kept_, body_.config, body_.units.counts_per_unit(), measured_.encoder_range(), way);
    if (moved > permitted) conduct_.fail(AxisAlarm::moved_while_off, moved, permitted);
    else {
        body_.units.shift_by(kept_.shift + static_cast<double>(there - measured_.counts) / body_.units.counts_per_unit());
        body_.homed = true;
    }
    kept_ = {};
}

void RetainedCoordinates::lose_reference() noexcept {
    if (!body_.homed && !kept_.homed) return;
    body_.homed = false;
    kept_ = {};
    conduct_.fail(AxisAlarm::reference_lost, measured_.feedback.error_code);
}

RetainedPosition RetainedCoordinates::now(bool at_rest) const noexcept {
    if (!measured_.seeded) return kept_;  // what was kept stays until something better is known
    return {.homed = body_.homed && measured_.absolute_encoder(),
            .shift = body_.units.shift(),
            .counts = measured_.counts,
            .at_rest = at_rest && measured_.stands()};
}

}  // namespace taktwerk::axes
