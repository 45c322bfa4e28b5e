#pragma once
// Which inputs the planner takes. Internal to the planner.

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/planner/brake.hpp"
#include "axes/planner/plan.hpp"

namespace taktwerk::axes {

[[nodiscard]] inline PlanError check_number(double x) noexcept {
    if (std::abs(x) <= PlanBounds::largest) return PlanError::none;
    return std::isfinite(x) ? PlanError::out_of_bounds : PlanError::invalid_input;
}

[[nodiscard]] inline PlanError check_limit(double x) noexcept {
    if (!(x > 0)) return PlanError::invalid_input;
    return (x >= PlanBounds::smallest_limit && x <= PlanBounds::largest) || std::isinf(x) ? PlanError::none : PlanError::out_of_bounds;
}

/// The worse of the two: what is no number at all comes before what is out of bounds.
[[nodiscard]] inline PlanError worse(PlanError a, PlanError b) noexcept {
    if (a == PlanError::none) return b;
    return b == PlanError::invalid_input ? b : a;
}

[[nodiscard]] inline PlanError check_state(const MotionState& s) noexcept {
    return worse(worse(check_number(s.position), check_number(s.velocity)), check_number(s.acceleration));
}

/// All of them finite and within the bounds: then there is nothing else to ask.
[[nodiscard]] inline bool are_usual(const SignLimits& l) noexcept {
    const double least = std::min(std::min(l.velocity, l.speeding_up), std::min(l.slowing_down, l.jerk));
    const double sum = (l.velocity + l.speeding_up) + (l.slowing_down + l.jerk);  // NaN where one of them is
    return least >= PlanBounds::smallest_limit && sum <= PlanBounds::largest;
}

[[nodiscard]] inline PlanError check_limits(const SignedLimits& l) noexcept {
    if (are_usual(l.positive) && are_usual(l.negative)) return PlanError::none;
    PlanError error = PlanError::none;
    for (const SignLimits* s : {&l.positive, &l.negative})
        for (const double x : {s->velocity, s->speeding_up, s->slowing_down, s->jerk}) error = worse(error, check_limit(x));
    if (error != PlanError::none) return error;
    const bool jerk_free = std::isinf(l.positive.jerk) && std::isinf(l.negative.jerk);
    const auto nothing_limits = [&](const SignLimits& push, const SignLimits& brake) noexcept {
        return jerk_free && std::isinf(push.velocity) && std::isinf(push.speeding_up) && std::isinf(brake.slowing_down);
    };
    return nothing_limits(l.positive, l.negative) || nothing_limits(l.negative, l.positive) ? PlanError::invalid_input : PlanError::none;
}

[[nodiscard]] inline double without_negligible(double x) noexcept { return std::abs(x) < PlanBounds::negligible ? 0 : x; }

/// Velocity and acceleration themselves inside their limits, whatever they lead to.
[[nodiscard]] inline bool is_inside(double v, double a, const FrameLimits& l, double slack) noexcept {
    const double most = 1 + slack;
    if (v > l.up.velocity * most || -v > l.down.velocity * most) return false;
    const double up = v < 0 ? l.up.slowing_down : l.up.speeding_up;
    const double down = v > 0 ? l.down.slowing_down : l.down.speeding_up;
    return a <= up * most && -a <= down * most;
}

/// The first error of all arguments of a plan to a moving state.
[[nodiscard]] inline PlanError check_plan(const MotionState& from, const MotionState& target, const SignedLimits& limits) noexcept {
    const double sum = (std::abs(from.position) + std::abs(from.velocity) + std::abs(from.acceleration)) +
                       (std::abs(target.position) + std::abs(target.velocity) + std::abs(target.acceleration));
    if (sum <= PlanBounds::largest && are_usual(limits.positive) && are_usual(limits.negative)) return PlanError::none;
    return worse(worse(check_state(from), check_state(target)), check_limits(limits));
}

}  // namespace taktwerk::axes
