#include "axes/planner/plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/planner/brake.hpp"
#include "axes/planner/extremal.hpp"
#include "axes/planner/plan_checks.hpp"
#include "axes/planner/reduced_problem.hpp"

namespace taktwerk::axes {

namespace {

Plan refuse(const MotionState& from, PlanError error) noexcept { return {Profile{from}, error, 0}; }

/// The fastest change of velocity, after a brake of the acceleration alone.
struct VelocityChange {
    VelocityChange(const MotionState& from, double target, const SignedLimits& signed_limits) noexcept
        : limits{frame_limits(signed_limits)},
          brake{without_negligible(from.velocity), without_negligible(from.acceleration), at_any_velocity()} {
        const double a = brake.acceleration();
        const double excess = (target - brake.velocity()) - release(a, limits);
        sign = excess < 0 ? -1 : 1;
        if (sign < 0) limits = limits.mirrored();
    }

    [[nodiscard]] Ramp ramp(double target) const noexcept {
        const double v = sign * brake.velocity();
        const double a = sign * brake.acceleration();
        const double excess = std::max((sign * target - v) - release(a, limits), 0.0);
        return Ramp{climb_above_release(v, a, released_velocity(v, a, limits), excess, limits), limits};
    }

    FrameLimits limits;
    Brake brake;
    double sign = 1;

private:
    /// Only the acceleration is to be brought inside: the ramp itself leads to the velocity.
    [[nodiscard]] FrameLimits at_any_velocity() const noexcept {
        FrameLimits l = limits;
        l.up.velocity = l.down.velocity = std::numeric_limits<double>::infinity();
        return l;
    }
};

Plan to_velocity(const MotionState& from, double target, const SignedLimits& limits) noexcept {
    const VelocityChange change{from, without_negligible(target), limits};
    const Ramp ramp = change.ramp(without_negligible(target));
    // Only the last piece counts back from the end: it makes velocity and acceleration exact, the way is whatever it is.
    Chain all;
    for (const Stretch& s : change.brake.stretches()) all.add(s, 1);
    add_climb(all, ramp, change.sign);
    const auto stretches = all.stretches();
    const std::size_t forward = stretches.empty() ? 0 : stretches.size() - 1;
    const double end = from.position + (change.brake.travel() + change.sign * ramp.travel());
    return {Profile{from, stretches.first(forward), stretches.subspan(forward), {end, target, 0}}, PlanError::none};
}

}  // namespace

Plan plan_to_velocity(const MotionState& from, double target_velocity, const SignedLimits& limits) noexcept {
    const PlanError error = worse(worse(check_state(from), check_number(target_velocity)), check_limits(limits));
    if (error != PlanError::none) return refuse(from, error);
    const double most = target_velocity > 0 ? limits.positive.velocity : limits.negative.velocity;
    if (std::abs(target_velocity) > most) return refuse(from, PlanError::out_of_bounds);
    return to_velocity(from, target_velocity, limits);
}

Plan plan_stop(const MotionState& from, const SignedLimits& limits) noexcept {
    if (const PlanError error = worse(check_state(from), check_limits(limits)); error != PlanError::none) return refuse(from, error);
    return to_velocity(from, 0, limits);
}

double stopping_distance(const MotionState& from, const SignedLimits& limits) noexcept {
    if (worse(check_state(from), check_limits(limits)) != PlanError::none) return std::numeric_limits<double>::quiet_NaN();
    const VelocityChange change{from, 0, limits};
    return change.brake.travel() + change.sign * change.ramp(0).travel();
}

Plan plan_to_state(const MotionState& from, const MotionState& target, const SignedLimits& limits) noexcept {
    if (const PlanError error = check_plan(from, target, limits); error != PlanError::none) return refuse(from, error);
    const ReducedProblem reduced{from, target, limits};
    if (reduced.target_is_outside()) return refuse(from, PlanError::target_outside_limits);
    int looked_at = 0;
    if (!reduced.brake.stretches().empty() && !reduced.start_is_outside()) {
        // Inside the limits, but not for long: unless the target comes first.
        const ReducedProblem unbraked{from, target, limits, ReducedProblem::Unbraked{}};
        const FastestMotion fast = fastest(unbraked.problem, unbraked.rounding(), {false, reduced.target_releases()});
        looked_at = fast.found.looked_at;
        if (fast.found.found) return {unbraked.profile(fast.motion), PlanError::none, looked_at};
    }
    const FastestMotion fast = fastest(reduced.problem, reduced.rounding(), {true, reduced.target_releases()});
    if (!fast.found.found) return refuse(from, PlanError::target_outside_limits);
    return {reduced.profile(fast.motion), PlanError::none, looked_at + fast.found.looked_at};
}

Plan plan_to_position(const MotionState& from, double target, const SignedLimits& limits) noexcept {
    return plan_to_state(from, {target, 0, 0}, limits);
}

}  // namespace taktwerk::axes
