#include "axes/planner/reach.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/planner/bracketed_root.hpp"
#include "axes/planner/plan.hpp"
#include "axes/planner/plan_checks.hpp"
#include "axes/planner/precision.hpp"
#include "axes/planner/ramp.hpp"
#include "core/math.hpp"

namespace taktwerk::axes {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// In coordinates where the distance is positive.
double highest_velocity(double distance, double v, double a, const FrameLimits& limits) noexcept {
    if (limits.jerk_free()) a = 0;
    const double released = released_velocity(v, a, limits);
    const double most = limits.up.velocity - released;
    if (!(most >= 0)) return nothing;
    const double ease = limits.up.ease + limits.down.ease;
    // x as in the family of peaks: the peak of the acceleration from rest, or the gain of velocity itself.
    const auto excess = [&](double x) noexcept { return ease > 0 ? x * (x * ease / 2) : x; };
    const auto parameter = [&](double e) noexcept { return ease > 0 ? std::sqrt(2 * e / ease) : e; };
    const auto climb = [&](double x) noexcept { return Ramp{climb_above_release(v, a, released, excess(x), limits), limits}; };

    // From a negative velocity the way back to standstill comes first: it never uses distance up.
    const double low = released < 0 ? parameter(std::min(-released, most)) : 0;
    const Ramp least = climb(low);
    if (least.travel() > distance + 4 * epsilon * least.path()) return nothing;
    const double missing = distance - least.travel();
    if (limits.jerk_free() && std::isinf(limits.up.speeding_up)) return limits.up.velocity;  // it jumps
    if (!(missing > 0)) return released + excess(low);
    double high = parameter(most);
    // More is certainly not reached (PeakFamily::step_over).
    double enough = parameter(std::sqrt(2 * limits.up.speeding_up * missing));
    if (limits.down.ease > 0) enough = std::min(enough, math::cbrt(3 * missing / (ease * std::sqrt(ease * limits.down.ease))));
    const double sum = (ease > 0 ? std::sqrt(low * low + enough * enough) : low + enough) * (1 + 4 * epsilon);
    if (sum < high) high = sum;
    else if (climb(high).travel() <= distance) return limits.up.velocity;
    const double x = bracketed_root(
        [&](double at) noexcept -> RootSample {
            const Ramp ramp = climb(at);
            const double c = released + excess(at);
            const double slope = (ease > 0 ? at * ease : 1) * (c / ramp.peak() + ramp.fall_duration() / 2);
            return {ramp.travel() - distance, slope, 2 * epsilon * (distance + ramp.path())};
        },
        low, high, low + (high - low) / 2, true);
    return std::min(released + excess(x), limits.up.velocity);
}

}  // namespace

Stopping stopping(double velocity, double acceleration, const SignedLimits& limits) noexcept {
    const Plan plan = plan_stop({0, velocity, acceleration}, limits);
    if (plan.error != PlanError::none) return {nothing, nothing};
    return {plan.profile.end().position, plan.profile.duration()};
}

double highest_reachable_velocity(double distance, double velocity, double acceleration, const SignedLimits& limits) noexcept {
    if (check_plan({0, velocity, acceleration}, {distance, 0, 0}, limits) != PlanError::none) return nothing;
    const FrameLimits l = frame_limits(limits);
    if (!keeps_limits(velocity, l.jerk_free() ? 0 : acceleration, l, 0)) return nothing;
    if (distance < 0) return -highest_velocity(-distance, -velocity, -acceleration, l.mirrored());
    return highest_velocity(distance, velocity, acceleration, l);
}

double highest_entry_velocity(double distance, double end_velocity, const SignedLimits& limits) noexcept {
    if (check_plan({0, end_velocity, 0}, {distance, 0, 0}, limits) != PlanError::none) return nothing;
    const FrameLimits back = frame_limits(limits).reversed().mirrored();
    if (!keeps_limits(end_velocity, 0, back, 0)) return nothing;
    if (distance < 0) return -highest_velocity(-distance, -end_velocity, 0, back.mirrored());
    return highest_velocity(distance, end_velocity, 0, back);
}

}  // namespace taktwerk::axes
