#include "axes/coupling/follower.hpp"

#include <algorithm>
#include <cmath>

#include "core/math.hpp"

namespace taktwerk::axes {

namespace {

constexpr double least_share = 0.2;  // of the acceleration, and of the velocity, that is left for a difference beside a fast relation
constexpr double rounding = 1e-9;

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

/// Room for the difference beside the relation's own motion.
SignedLimits difference_limits(const MotionState& slave, const MotionState& relation, RunDown target,
                               const FollowerLimits& limits) noexcept {
    const double now = std::abs(slave.velocity), goal = std::abs(relation.velocity);
    double acceleration = std::min(limits.approach.acceleration, limits.approach.deceleration);
    // PLCopen's words follow the slave's own velocity: a change of it without reversal needs one of the two.
    if (target == RunDown::velocity && slave.velocity * relation.velocity >= 0)
        acceleration = goal >= now ? limits.approach.acceleration : limits.approach.deceleration;
    acceleration = std::max(acceleration - std::abs(relation.acceleration), least_share * acceleration);
    const double jerk = limits.approach.jerk;
    double up = limits.forward, down = limits.backward;
    if (target == RunDown::velocity) up = down = std::abs(slave.velocity - relation.velocity) + limits.axis.velocity;
    else {
        up = std::max(up - relation.velocity, least_share * limits.axis.velocity);
        down = std::max(down + relation.velocity, least_share * limits.axis.velocity);
    }
    return {SignLimits{up, acceleration, acceleration, jerk}, SignLimits{down, acceleration, acceleration, jerk}};
}

}  // namespace

void Follower::begin(const Relation& relation, RunDown target, const FollowerLimits& limits) noexcept {
    relation_ = relation;
    target_ = target;
    limits_ = limits;
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
    if (!approaching_) return {frame.local(at.place), at.velocity, at.acceleration};
    const auto under_way = approach_.at(first);
    return {frame.local(approach_origin_) + under_way.position, under_way.velocity, under_way.acceleration};
}

void Follower::run_down(const MotionState& slave, const MotionState& relation) noexcept {
    const MotionState lack{slave.position - relation.position, slave.velocity - relation.velocity,
                           slave.acceleration - relation.acceleration};
    if (!difference_.begin(lack, target_, difference_limits(slave, relation, target_, limits_))) {
        // Only numbers beyond the planner's bounds: without acceleration it always has an answer.
        (void)difference_.begin({lack.position, lack.velocity, 0}, RunDown::velocity,
                                difference_limits(slave, relation, RunDown::velocity, limits_));
    }
}

MotionState Follower::held(const MotionState& wanted, const MotionState& before, double period) noexcept {
    const auto& axis = limits_.axis;
    // Through zero it brakes first.
    const bool grows = wanted.velocity * before.velocity >= 0 && std::abs(wanted.velocity) > std::abs(before.velocity);
    const double most = (grows ? axis.acceleration : axis.deceleration) * period;
    const double step = wanted.velocity - before.velocity;
    const double mean = (wanted.position - before.position) / period;
    const bool follows = std::abs(mean - (wanted.velocity + before.velocity) / 2) <= most / 2 + rounding * axis.velocity;
    const auto allowed = [&](double velocity) noexcept {
        return std::abs(velocity - limits_.inside(velocity)) <= rounding * axis.velocity;
    };
    const bool inside =
        std::abs(step) <= most * (1 + rounding) + rounding * rounding * axis.velocity && allowed(wanted.velocity) && allowed(mean);
    held_back_ = !(follows && inside);  // also when something is not a number
    if (!held_back_) return wanted;

    // A place that its velocity does not lead to asks for nothing: the slave keeps to the velocity, the difference to the rest.
    const double target = std::isfinite(wanted.velocity) ? limits_.inside(wanted.velocity) : 0.0;
    MotionState out;
    out.velocity = before.velocity + std::clamp(target - before.velocity, -most, most);
    out.acceleration = (out.velocity - before.velocity) / period;
    out.position = before.position + (before.velocity + out.velocity) / 2 * period;
    return out;
}

MotionState Follower::step(const EndlessMotion& first, const EndlessMotion& second, const MotionState& before, const SlaveFrame& frame,
                           Duration period) noexcept {
    const double seconds = to_seconds(period);
    const auto relation = wanted(first, second, frame);
    if (fresh_) {
        // As if the relation had held one period ago already: the slave goes on from where it was then.
        const MotionState then{relation.position - seconds * (relation.velocity - seconds * relation.acceleration / 2),
                               relation.velocity - seconds * relation.acceleration, relation.acceleration};
        run_down(before, then);
        fresh_ = false;
    }
    const auto want = sum(relation, difference_.advance(period));
    auto out = held(want, before, seconds);
    out.acceleration = tame(out, limits_);
    if (held_back_) run_down(out, relation);
    in_sync_ = !approaching_ && !held_back_ && difference_.finished();
    if (in_sync_ && difference_.state().position != 0) {
        // Lost for good: one rounding, and the difference is out of the way.
        const double lost = difference_.state().position;
        std::visit([&](auto& line) { line.shift(lost); }, relation_);
        difference_.clear();
    }
    return out;
}

}  // namespace taktwerk::axes
