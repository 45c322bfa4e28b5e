// The coordinates of an axis with an absolute encoder over a time without power: what is to be kept, and what is made of it.

#include <cmath>

#include "axes/axis/axis.hpp"

namespace taktwerk::axes {

RetainedPosition Axis::retained() const noexcept {
    if (!seeded_) return retained_;  // what was kept stays until something better is known
    return {.homed = view_.homed && seeded_ && absolute_encoder(),
            .shift = units_.shift(),
            .counts = actual_counts_,
            .at_rest = !moves() && drive_stands()};
}

void Axis::restore(const RetainedPosition& position, const Gearing& gearing) noexcept {
    if (!absolute_encoder() || !position.homed) return;
    if (!same_coordinates(gearing, config_.gearing)) {
        fail(AxisAlarm::retained_gearing_differs);
        return;
    }
    retained_ = position;
}

/// At the first position after power-on.
void Axis::apply_retained() noexcept {
    if (!retained_.homed) return;
    const auto there = unwrapped_near(retained_.counts, actual_counts_, encoder_range());
    const double moved = std::abs(static_cast<double>(there - retained_.counts) / units_.counts_per_unit());
    const bool told = retained_.at_rest && moved > config_.memory.moved_while_off;
    if (told) fail(AxisAlarm::moved_while_off, moved, config_.memory.moved_while_off);
    else {
        units_.shift_by(retained_.shift + static_cast<double>(there - actual_counts_) / units_.counts_per_unit());
        view_.homed = true;
    }
    retained_ = {};
}

}  // namespace taktwerk::axes
