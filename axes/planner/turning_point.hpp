#pragma once
// Does a curve that turns before it reaches zero reach it after all? Internal to the planner.

#include <cmath>
#include <optional>

#include "axes/planner/plan_limits.hpp"

namespace taktwerk::axes {

/// A point of a curve over time: by how much the way misses the target, and how fast that changes.
struct Turn {
    double parameter = 0;  ///< rises with time
    double miss = 0;
    double rate = 0;  ///< d miss / d time
    double time = 0;
    double time_slope = 0;  ///< d time / d parameter
    double path = 0;        ///< scale of the rounding errors in miss
};

/// Between `low` and `high`, whose misses are below 0, the way grows from the one, shrinks to the other and is concave in time between them. A
/// point at which it is not short by more than `rounding`, if there is one. The two tangents meet above the top: where they meet below 0,
/// nothing is there to be found. Usually none to three evaluations; where the top just touches zero the interval is narrowed to `flat` of itself, over
/// which the curve differs from its top by less than rounding.
template <typename Look>
[[nodiscard]] std::optional<Turn> top_beyond_zero(Look&& look, Turn low, Turn high, double rounding) noexcept {
    constexpr double flat = 1e-8;
    for (int i = 0; i < max_root_steps; ++i) {
        const double growth = low.rate;
        const double shrinking = -high.rate;
        if (!(growth > 0 && shrinking > 0)) return std::nullopt;  // no top between them
        const double to_meeting = (shrinking * (high.time - low.time) - (low.miss - high.miss)) / (growth + shrinking);
        if (low.miss + growth * to_meeting < -rounding) return std::nullopt;
        // Where a straight line says that it turns; every other time the middle, so that the interval surely shrinks.
        const double width = high.parameter - low.parameter;
        const double share = i % 2 == 0 ? growth / (growth + shrinking) : 0.5;
        const double next = low.parameter + width * share;
        if (!(next > low.parameter && next < high.parameter) || width <= flat * high.parameter) return std::nullopt;
        const Turn between = look(next);
        if (between.miss >= -rounding) return between;
        (between.rate > 0 ? low : high) = between;
    }
    return std::nullopt;
}

}  // namespace taktwerk::axes
