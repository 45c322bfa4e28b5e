#pragma once
// What a climb comes to, without its stretches: what a search looks at, a dozen times per plan. Internal to the planner.

#include <algorithm>
#include <cmath>

#include "axes/planner/motion_frame.hpp"
#include "axes/planner/ramp.hpp"

namespace taktwerk::axes {

struct MeasuredClimb {
    double travel;
    double path;
    double duration;
    double peak;
};

/// travel(), path(), duration() and peak() of Ramp{c, limits}, to the same bits, for a climb that ends without acceleration: the operations of
/// Ramp::leg with a1 = 0. (plan_search_unit.cpp compares the two.)
[[gnu::always_inline]] [[nodiscard]] inline MeasuredClimb measured(const Climb& c, const FrameLimits& limits) noexcept {
    if (!Ramp::is_one_leg(c, limits)) {
        const Ramp ramp{c, limits};
        return {ramp.travel(), ramp.path(), ramp.duration(), ramp.peak()};
    }
    const double bound = Ramp::bound_of(c, limits);
    const double square = std::max(c.fall_square, 0.0);
    const bool held = square > bound * bound;
    const double peak = held ? bound : std::sqrt(square);
    const double climb = c.a0 > 0 && !held ? std::max(c.rise_square, 0.0) / (peak + c.a0) : peak - c.a0;
    const double rise_duration = std::max(climb * limits.up.ease, 0.0);
    const double rise_way = rise_duration * (c.v0 + rise_duration * ((c.a0 + c.a0 + peak) * (1.0 / 6)));
    double travel = rise_way;
    double path = std::abs(rise_way);
    double duration = rise_duration;
    double v = c.v0 + rise_duration * ((c.a0 + peak) / 2);
    if (held) {
        const double hold = (square - bound * bound) * (limits.up.ease + limits.down.ease) / (2 * bound);
        const double way = hold * (v + hold * ((bound + bound + bound) * (1.0 / 6)));
        v += hold * ((bound + bound) / 2);
        travel += way;
        path += std::abs(way);
        duration += hold;
    }
    const double fall_duration = peak * limits.down.ease;
    const double fall_way = fall_duration * (v + fall_duration * ((peak + peak) * (1.0 / 6)));
    return {travel + fall_way, path + std::abs(fall_way), duration + fall_duration, peak};
}

}  // namespace taktwerk::axes
