#include "axes/axis/aim.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace taktwerk::axes {

namespace {

/// The part of the acceleration that `jerk` takes away before the speed passes `most`, or zero where the axis brakes. A stop (0) that took
/// over any in the sense of the motion would run on by a^2 / (2 j).
double releasable(const MotionState& state, double most, double jerk) noexcept {
    const double speed = std::abs(state.velocity);
    const bool faster = state.velocity * state.acceleration >= 0;
    const double room = faster ? std::max(0.0, most - speed) : speed;
    if (room > 0 && !std::isfinite(jerk)) return state.acceleration;
    const double bound = room > 0 ? std::sqrt(2 * jerk * room) : 0;
    return std::clamp(state.acceleration, -bound, bound);
}

}  // namespace

void Aim::at(Goal::Kind kind, double value, const MotionLimits& limits, VelocityLimiter limiter) noexcept {
    // The jerk of a slave, a table and a feed is not limited: what comes next takes over of their acceleration what it can release. (A slave alone
    // holds itself to that; with what was on top of it, it does not.)
    const bool stops = kind == Goal::Kind::stop;
    const double former_jerk = jerk_of_motion();
    const bool unlimited = !std::isfinite(former_jerk);
    if (unlimited && (motion_.goal.kind == Goal::Kind::given || ((stops || motion_.summed) && motion_.goal.kind == Goal::Kind::coupled))) {
        auto base = motion_.setpoint.base();
        base.acceleration = releasable(base, stops ? 0 : body_.config.limits.velocity_towards(base.velocity), limits.jerk);
        motion_.setpoint.set(base);
    }
    motion_.goal = {kind, value, limits, limiter};
    motion_.goal.former_jerk = former_jerk;
    motion_.goal_pending = motion_.watch_limits = true;
    motion_.held = false;
}

void Aim::at_rest(const MotionLimits& limits) noexcept {
    at(Goal::Kind::stop, 0, limits, VelocityLimiter::stopping);
    motion_.folded_jerk = 0;  // it counts once, also where one stop is given after the other
}

void Aim::at_velocity(double velocity, const MotionLimits& dynamics) noexcept {
    const auto allowed = allowed_speed(std::abs(velocity), body_.config.limits.velocity_towards(velocity), body_.velocity_cap());
    const auto limiter = velocity == 0 ? VelocityLimiter::stopping : allowed.limiter;
    at(Goal::Kind::velocity, std::copysign(allowed.speed, velocity), dynamics, limiter);
}

void Aim::at_target(const AxisCommand& command, double target) noexcept {
    const double way = target - motion_.setpoint.base().position;
    auto dynamics = dynamics_of(command, body_.config.limits, body_.config.defaults);
    const auto allowed = allowed_speed(command.velocity, body_.config.limits.velocity_towards(way), body_.velocity_cap());
    dynamics.velocity = allowed.speed;
    at(Goal::Kind::position, target, dynamics, allowed.limiter);
    if (moves_continuously(command.kind)) {
        const auto end =
            allowed_speed(std::abs(command.end_velocity), body_.config.limits.velocity_towards(command.end_velocity), body_.velocity_cap());
        motion_.goal.goes_on = true;
        motion_.goal.end_velocity = std::copysign(end.speed, command.end_velocity);
        return;
    }
    motion_.commanded_target = target;
    motion_.has_commanded_target = true;
}

void Aim::at_stop(const AxisCommand& command) noexcept { at_rest(dynamics_of(command, body_.config.limits, body_.config.defaults)); }

double Aim::jerk_of_motion() const noexcept {
    switch (motion_.goal.kind) {
        case Goal::Kind::rest: return motion_.folded_jerk;
        case Goal::Kind::position:
        case Goal::Kind::velocity: return motion_.with_override(motion_.goal.limits).jerk + motion_.folded_jerk;
        case Goal::Kind::stop: return std::max(motion_.goal.limits.jerk, motion_.goal.former_jerk) + motion_.folded_jerk;
        case Goal::Kind::given:
        case Goal::Kind::coupled: break;
    }
    return motion_.goal.former_jerk > 0 ? motion_.goal.former_jerk : std::numeric_limits<double>::infinity();
}

void Aim::start_at_base() noexcept {
    motion_.commanded_target += motion_.setpoint.fold_covered();
    if (body_.endless) reanchor();
    motion_.origin = motion_.setpoint.base().position;
    motion_.started_backwards = motion_.heads_backwards();
}

void Aim::anchor_near_actual() noexcept {
    if (body_.units.far_from_anchor(measured_.local())) body_.units.reanchor(measured_.local());
}

void Aim::reanchor() noexcept {
    const double here = motion_.setpoint.base().position;
    const double left = body_.units.reanchor(here);
    const double delta = left - here;
    motion_.setpoint.rebase(left);
    if (motion_.goal.kind == Goal::Kind::position) motion_.goal.value += delta;
    motion_.origin += delta;
    motion_.commanded_target += delta;
}

void Aim::keep_close_to_anchor() noexcept {
    if (motion_.goal_pending || motion_.goal.kind != Goal::Kind::velocity || !motion_.setpoint.finished() ||
        !body_.units.far_from_anchor(motion_.setpoint.base().position))
        return;
    reanchor();
    motion_.goal_pending = true;
}

void Aim::shift_coordinates(double delta) noexcept {
    if (body_.config.modulo > 0) delta = std::remainder(delta, body_.config.modulo);  // the same place whichever repetition: the nearest
    body_.units.shift_by(delta);
    // The number commanded stays and means the shifted coordinates (P1-200).
    const auto& active = body_.queue.active();
    const bool to_position =
        motion_.goal.kind == Goal::Kind::position && motion_.goal.limiter != VelocityLimiter::software_limit && !body_.begin_pending;
    if (to_position) motion_.goal_pending = true;  // limits and what waits behind have moved too
    if (to_position &&
        (active.command.kind == CommandKind::move_absolute || active.command.kind == CommandKind::move_continuous_absolute)) {
        motion_.goal.value = body_.config.modulo > 0 ? motion_.goal.value - delta : body_.units.to_local(active.command.position);
        motion_.commanded_target = motion_.goal.value;
    }
}

}  // namespace taktwerk::axes
