#include "axes/group/path_run.hpp"

#include <algorithm>

#include "axes/axis/stop_ramp.hpp"
#include "axes/planner/plan.hpp"

namespace taktwerk::axes {

namespace {

double resolved(double wanted, double limit) noexcept { return wanted > 0 ? std::min(wanted, limit) : limit; }

/// Whether it ends before the end, by more than the last digits of a sum. A stop that reaches the end is none: what runs ends there anyway, and exactly.
bool within(double end, double length) noexcept { return end < length * (1 - 1e-12); }

}  // namespace

bool PathRun::begin(const StraightWay& way, const WayLimits& limits, const PathDynamics& wanted, const Override& factors) noexcept {
    *this = {};
    way_ = way;
    limits_ = limits;
    const auto& most = limits.along;
    wanted_ = {resolved(wanted.velocity, most.velocity), resolved(wanted.acceleration, most.acceleration),
               resolved(wanted.deceleration, most.deceleration), resolved(wanted.jerk, most.jerk)};
    factors_ = factors;
    exists_ = true;
    profile_ = Profile{MotionState{}};
    if (factors.velocity == 0) return true;  // it waits where it begins
    if (plan()) return true;
    exists_ = false;
    return false;
}

void PathRun::take(const Profile& profile) noexcept {
    profile_ = profile;
    elapsed_ = {};
    piece_ = 0;
    plan_pending_ = false;
}

/// To the end, or to rest where the override is 0. False: with these factors it would pass the end, or turn round.
bool PathRun::plan() noexcept {
    const MotionLimits limits{std::min(wanted_.velocity * factors_.velocity, limits_.along.velocity),
                              wanted_.acceleration * factors_.acceleration, wanted_.deceleration * factors_.acceleration,
                              wanted_.jerk * factors_.jerk};
    if (factors_.velocity == 0) {
        if (over()) return true;
        const auto rest = plan_stop(s_, MotionLimits{wanted_.velocity, limits.acceleration, limits.deceleration, limits.jerk});
        if (rest.error != PlanError::none || !within(rest.profile.end().position, way_.length) || rest.profile.top_velocity(-1) > 0)
            return false;
        take(rest.profile);
        return true;
    }
    const auto way = plan_to_position(s_, way_.length, limits);
    if (way.error != PlanError::none || way.profile.top_velocity(-1) > 0) return false;
    take(way.profile);
    return true;
}

void PathRun::advance(Duration period) noexcept {
    if (!exists_) return;
    if (plan_pending_ && !stops_) plan_pending_ = !plan();
    elapsed_ += period;
    const auto sample = profile_.sample(std::min(to_seconds(elapsed_), profile_.duration()), piece_);
    s_ = sample.state;
    piece_ = sample.piece;
}

void PathRun::override_with(const Override& factors) noexcept {
    if (factors == factors_) return;
    factors_ = factors;
    if (exists_ && !stops_ && !arrived()) plan_pending_ = !plan();
}

void PathRun::stop(const PathDynamics& ramp, const Override& factors, Duration period) noexcept {
    if (!exists_) return;
    stops_ = true;
    plan_pending_ = false;
    if (over()) return;
    const auto& most = limits_.along;
    const MotionLimits limits{most.velocity, most.acceleration, resolved(ramp.deceleration, most.deceleration) * factors.acceleration,
                              resolved(ramp.jerk, most.jerk) * factors.jerk};
    const auto rest = plan_stop(s_, never_reversing(s_, limits, to_seconds(period)));
    if (rest.error != PlanError::none) return;
    // Too soft to end on the way: what runs ends there, at rest, and goes on.
    if (!within(rest.profile.end().position, way_.length)) return;
    take(rest.profile);
}

void PathRun::resume(const Override& factors) noexcept {
    factors_ = factors;
    stops_ = false;
    if (exists_ && !arrived()) plan_pending_ = !plan();
}

double PathRun::remaining_time() const noexcept {
    const bool leads_there = exists_ && !stops_ && profile_.end().position == way_.length;
    return leads_there ? std::max(0.0, profile_.duration() - to_seconds(elapsed_)) : 0;
}

PathLimiter PathRun::limiter() const noexcept {
    if (over()) return PathLimiter::none;
    if (factors_.velocity < 1) return PathLimiter::override_factor;
    return wanted_.velocity >= limits_.along.velocity ? PathLimiter::axis : PathLimiter::command;
}

}  // namespace taktwerk::axes
