#include "axes/coupling/follower.hpp"

#include <algorithm>
#include <cmath>

#include "axes/coupling/relative_rounding.hpp"
#include "core/math.hpp"

namespace taktwerk::axes {

namespace {

constexpr double least_difference_share = 0.2;  // of the acceleration that is left for a difference beside a fast relation
constexpr double least_room = 0.01;             // of the velocity
constexpr double noticed = 1.0 / 64;            // of the slave's limits: a relation that changes by less is the one foreseen

MotionState sum(const MotionState& a, const MotionState& b) noexcept {
    return {a.position + b.position, a.velocity + b.velocity, a.acceleration + b.acceleration};
}

/// The acceleration from which whatever takes the slave over can go on inside its limits: a relation may have any for a moment.
double tame(const MotionState& state, const FollowerLimits& follower) noexcept {
    const auto& limits = follower.axis;
    const bool faster = state.velocity * state.acceleration >= 0;
    const double room = follower.room(state.velocity != 0 ? state.velocity : state.acceleration) - std::abs(state.velocity);
    double most = faster ? limits.acceleration : limits.deceleration;
    // The jerk takes it away while the velocity still grows: v + a^2 / (2 j) is to stay below the limit.
    if (faster && std::isfinite(limits.jerk)) most = std::min(most, math::sqrt(2 * limits.jerk * std::max(0.0, room)));
    // Braking, it is gone before the velocity is: else whoever stops the slave would run it backwards.
    else if (std::isfinite(limits.jerk)) most = std::min(most, math::sqrt(2 * limits.jerk * std::abs(state.velocity)));
    return std::clamp(state.acceleration, -most, most);
}

/// PLCopen's words follow the slave's own velocity, which may turn round on the way: what holds for either.
double either_way(const MotionLimits& approach) noexcept { return std::min(approach.acceleration, approach.deceleration); }

/// Where the slave can go: the relation, but for what its own limits leave no room beside.
MotionState reachable(const MotionState& relation, const FollowerLimits& limits) noexcept {
    const double margin = least_room * limits.axis.velocity;
    MotionState out = relation;
    out.velocity = std::clamp(relation.velocity, -std::max(0.0, limits.backward - margin), std::max(0.0, limits.forward - margin));
    const double most = (1 - least_difference_share) * either_way(limits.approach);
    out.acceleration = out.velocity != relation.velocity ? 0.0 : std::clamp(relation.acceleration, -most, most);
    return out;
}

/// Room for the difference beside the goal's own motion.
SignedLimits difference_limits(const MotionState& goal, const FollowerLimits& limits) noexcept {
    const double up = limits.forward - goal.velocity, down = limits.backward + goal.velocity, acceleration = either_way(limits.approach);
    const double least = least_room * limits.axis.velocity, jerk = limits.approach.jerk;
    const double faster = acceleration - goal.acceleration, slower = acceleration + goal.acceleration;
    return {SignLimits{std::max(up, least), faster, faster, jerk}, SignLimits{std::max(down, least), slower, slower, jerk}};
}

}  // namespace

void Follower::begin(const Relation& relation, RunDown target, const FollowerLimits& limits) noexcept {
    relation_ = relation;
    target_ = target;
    limits_ = limits;
    catch_up_.begin();
    fresh_ = true;
    approaching_ = in_sync_ = held_back_ = false;
}

void Follower::begin(const Relation& relation, const SyncApproach& approach, const SlaveFrame& frame,
                     const FollowerLimits& limits) noexcept {
    begin(relation, RunDown::position, limits);
    approach_ = approach;
    approach_origin_ = frame.place(0);
    approaching_ = true;
}

MotionState Follower::wanted(const EndlessMotion& first, const EndlessMotion& second, const SlaveFrame& frame) noexcept {
    // The relation is asked in every cycle, also under way to the sync point: a cam counts its passes.
    EndlessMotion at;
    if (auto* line = std::get_if<GearLine>(&relation_)) at = line->at(first);
    else if (auto* both = std::get_if<GearSum>(&relation_)) at = both->at(first, second);
    else if (auto* cam = std::get_if<CamCurve>(&relation_)) at = cam->at(first);
    if (approaching_ && approach_.passed(first.place)) approaching_ = false;
    trend_ = at.trend;
    if (!approaching_) return {frame.local(at.place), at.velocity, at.acceleration};
    const auto under_way = approach_.at(first);
    return {frame.local(approach_origin_) + under_way.position, under_way.velocity, under_way.acceleration};
}

/// The relation moves as it did when the difference was planned.
bool Follower::foreseen(const MotionState& relation) const noexcept {
    return std::abs(relation.acceleration - goal_.acceleration) <= noticed * limits_.approach.acceleration &&
           std::abs(limits_.forward - relation.velocity - room_) <= noticed * limits_.axis.velocity;
}

/// From the slave's state one period ago, as if the goal had held then already. `acceleration`: the slave's own.
Plan Follower::plan_from(const MotionState& before, const MotionState& goal, double acceleration, double period) const noexcept {
    const MotionState then{goal.position - period * (goal.velocity - period * goal.acceleration / 2),
                           goal.velocity - period * goal.acceleration, goal.acceleration};
    const MotionState lack{before.position - then.position, before.velocity - then.velocity, acceleration - then.acceleration};
    return Difference::plan(lack, difference_limits(goal, limits_));
}

/// The difference begins anew, one period ago, beside what the slave can follow of the relation.
void Follower::make_up(const MotionState& before, const MotionState& relation, double period) noexcept {
    goal_ = reachable(relation, limits_);
    room_ = limits_.forward - relation.velocity;
    exact_ = goal_ == relation;
    auto plan = plan_from(before, goal_, before.acceleration, period);
    // A slave that came to its acceleration with its master, by no jerk of its own, loses it with its master too.
    if (!fresh_) {
        const auto along = plan_from(before, goal_, goal_.acceleration + own_acceleration_, period);
        const bool sooner = plan.error != PlanError::none || along.profile.duration() < plan.profile.duration();
        if (along.error == PlanError::none && sooner) plan = along;
    }
    if (plan.error == PlanError::none) difference_.run(plan.profile);
    else difference_.clear();  // only numbers beyond the planner's bounds
}

/// The relation has another acceleration than was foreseen, or leaves other room: is there a way now that ends sooner?
void Follower::look_for_a_sooner_way(const MotionState& before, const MotionState& relation, double period) noexcept {
    if (reachable(relation, limits_) != relation) return;
    const auto plan = plan_from(before, relation, before.acceleration, period);
    if (plan.error != PlanError::none || !(plan.profile.duration() < difference_.remaining() - period)) return;
    goal_ = relation;
    room_ = limits_.forward - relation.velocity;
    difference_.run(plan.profile);
}

bool Follower::possible(const MotionState& wanted, const MotionState& before, double period) const noexcept {
    const auto& axis = limits_.axis;
    // Through zero it brakes first.
    const bool grows = wanted.velocity * before.velocity >= 0 && std::abs(wanted.velocity) > std::abs(before.velocity);
    const double most = (grows ? axis.acceleration : axis.deceleration) * period;
    const double step = wanted.velocity - before.velocity;
    const double mean = (wanted.position - before.position) / period;
    const auto allowed = [&](double velocity) noexcept {
        return std::abs(velocity - limits_.inside(velocity)) <= relative_rounding * axis.velocity;
    };
    const bool follows = std::abs(mean - (wanted.velocity + before.velocity) / 2) <= most / 2 + relative_rounding * axis.velocity;
    // Nothing of it holds of something that is not a number.
    return follows && std::abs(step) <= most * (1 + relative_rounding) + relative_rounding * relative_rounding * axis.velocity &&
           allowed(wanted.velocity) && allowed(mean);
}

/// The velocity as far as it can be had, and the place to which it leads.
MotionState Follower::kept_inside(const MotionState& wanted, const MotionState& before, double period) const noexcept {
    const double target = std::isfinite(wanted.velocity) ? limits_.inside(wanted.velocity) : 0.0;
    const bool grows = target * before.velocity >= 0 && std::abs(target) > std::abs(before.velocity);
    const double most = (grows ? limits_.axis.acceleration : limits_.axis.deceleration) * period;
    MotionState out;
    out.velocity = before.velocity + std::clamp(target - before.velocity, -most, most);
    out.acceleration = (out.velocity - before.velocity) / period;
    out.position = before.position + (before.velocity + out.velocity) / 2 * period;
    return out;
}

/// Towards the velocity of the gear. Once there, the distance lost is lost for good: the gear is moved by it, and from now on locked by place.
MotionState Follower::catch_up(const MotionState& relation, const MotionState& before, double period) noexcept {
    const auto next = catch_up_.next(before, {relation.velocity, relation.acceleration, trend_}, limits_, period);
    MotionState out{next.place, relation.velocity, relation.acceleration};
    in_sync_ = next.caught && possible(out, before, period);
    if (in_sync_) {
        held_back_ = false;
        exact_ = true;
        target_ = RunDown::position;  // from now on
        std::visit([&](auto& line) { line.shift(out.position - relation.position); }, relation_);
        difference_.clear();
        out.acceleration = tame(out, limits_);
        return out;
    }
    // Its accelerations are inside, but for what the slave brought along; the velocity limit may have come down on it.
    const double velocity = next.state.velocity;
    const bool inside = std::abs(velocity - limits_.inside(velocity)) <= relative_rounding * limits_.axis.velocity;
    held_back_ = next.held_back || !inside;
    return inside ? next.state : kept_inside(next.state, before, period);
}

MotionState Follower::step(const EndlessMotion& first, const EndlessMotion& second, const MotionState& before, const SlaveFrame& frame,
                           Duration period) noexcept {
    const double seconds = to_seconds(period);
    const auto relation = wanted(first, second, frame);
    if (target_ == RunDown::velocity) {
        fresh_ = false;
        return catch_up(relation, before, seconds);
    }
    own_acceleration_ = difference_.state().acceleration;
    bool anew = fresh_ || !(exact_ || difference_.finished());
    if (anew) make_up(before, relation, seconds);
    else if (!difference_.finished() && !foreseen(relation)) look_for_a_sooner_way(before, relation, seconds);
    auto out = sum(anew ? goal_ : relation, difference_.advance(period));
    held_back_ = false;
    if (!anew && !possible(out, before, seconds)) {
        make_up(before, relation, seconds);
        out = sum(goal_, difference_.advance(period));
        anew = held_back_ = true;
    }
    if (anew && !possible(out, before, seconds)) {
        out = kept_inside(out, before, seconds);
        exact_ = false;
    }
    held_back_ = held_back_ || (anew && !exact_);
    fresh_ = false;
    out.acceleration = tame(out, limits_);
    in_sync_ = !approaching_ && !held_back_ && difference_.finished();
    return out;
}

}  // namespace taktwerk::axes
