// From a command to its goal: where to, how fast, and from which start. One case per kind of command in set_goal.

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/axis/axis_core.hpp"

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

void AxisCore::begin_command() noexcept {
    begin_pending_ = false;
    const auto error = set_goal(queue_.active());
    if (error == ErrorId::none) return;
    queue_.finish_active(Outcome::error, error);
    start_waiting(0);
}

ErrorId AxisCore::set_goal(const AcceptedCommand& accepted) noexcept {
    const auto command = accepted.command;
    switch (command.kind) {
        case CommandKind::home: return begin_homing(command);
        case CommandKind::homing_step: return begin_homing_step(command);
        case CommandKind::move_absolute:
        case CommandKind::move_relative:
        case CommandKind::move_additive:
        case CommandKind::move_continuous_absolute:
        case CommandKind::move_continuous_relative:
            start_at_base();
            if (command.kind == CommandKind::move_additive && has_commanded_target_) origin_ = commanded_target_;
            aim_at_target(command, target_of(command, setpoint_.base(), started_backwards_));
            break;
        case CommandKind::move_velocity:
        case CommandKind::jog:
            start_at_base();
            has_commanded_target_ = false;
            aim_at_velocity(signed_velocity(command, started_backwards_), dynamics_of(command, config_.limits, config_.defaults));
            break;
        case CommandKind::halt:
        case CommandKind::stop:
            start_at_base();
            aim_at_stop(command);
            break;
        case CommandKind::position_profile:
        case CommandKind::velocity_profile:
        case CommandKind::acceleration_profile:
        case CommandKind::external: start_at_base(); return set_goal_given(command);
        case CommandKind::gear_in:
        case CommandKind::gear_in_pos:
        case CommandKind::cam_in:
        case CommandKind::combine:
        case CommandKind::gear_out:
        case CommandKind::cam_out: return join(accepted);
        case CommandKind::torque:
            start_at_base();
            begin_torque(command);
            break;
        case CommandKind::set_controller_mode: begin_mode_change(command); break;
        case CommandKind::drive_move_absolute:
        case CommandKind::drive_move_relative:
        case CommandKind::drive_move_velocity:
        case CommandKind::drive_torque: begin_drive_profile(command); break;
        default: return ErrorId::not_supported;
    }
    return ErrorId::none;
}

/// The command begins here: with what was superimposed so far, near the anchor. A goal must follow.
void AxisCore::start_at_base() noexcept {
    commanded_target_ += setpoint_.fold_covered();
    if (endless_) reanchor();
    origin_ = setpoint_.base().position;
    started_backwards_ = heads_backwards();
}

bool AxisCore::heads_backwards() const noexcept {
    const double velocity = setpoint_.base().velocity;
    return velocity != 0 ? velocity < 0 : backwards_;
}

void AxisCore::aim(Goal::Kind kind, double value, const MotionLimits& limits, VelocityLimiter limiter) noexcept {
    // The jerk of a slave, a table and a feed is not limited: what comes next takes over of their acceleration what it can release. (A slave alone
    // holds itself to that; with what was on top of it, it does not.)
    const bool stops = kind == Goal::Kind::stop;
    const double former_jerk = jerk_of_motion();
    const bool unlimited = !std::isfinite(former_jerk);
    if (unlimited && (goal_.kind == Goal::Kind::given || ((stops || summed_) && goal_.kind == Goal::Kind::coupled))) {
        auto base = setpoint_.base();
        base.acceleration = releasable(base, stops ? 0 : config_.limits.velocity, limits.jerk);
        setpoint_.set(base);
    }
    goal_ = {kind, value, limits, limiter};
    goal_.former_jerk = former_jerk;
    goal_pending_ = watch_limits_ = true;
    held_ = false;
}

/// Every stop of a planned motion begins here, whoever asked for it.
void AxisCore::aim_at_rest(const MotionLimits& limits) noexcept {
    aim(Goal::Kind::stop, 0, limits, VelocityLimiter::stopping);
    folded_jerk_ = 0;  // it counts once, also where one stop is given after the other
}

/// Of what moves the axis now, base and addition together. That of a slave, a table or a fed set-point is not limited once it has moved the axis: until
/// then it is that of the motion before.
double AxisCore::jerk_of_motion() const noexcept {
    switch (goal_.kind) {
        case Goal::Kind::rest: return folded_jerk_;
        case Goal::Kind::position:
        case Goal::Kind::velocity: return with_override(goal_.limits).jerk + folded_jerk_;
        case Goal::Kind::stop: return std::max(goal_.limits.jerk, goal_.former_jerk) + folded_jerk_;
        case Goal::Kind::given:
        case Goal::Kind::coupled: break;
    }
    return goal_.former_jerk > 0 ? goal_.former_jerk : std::numeric_limits<double>::infinity();
}

void AxisCore::aim_at_velocity(double velocity, const MotionLimits& dynamics) noexcept {
    const auto allowed = allowed_speed(std::abs(velocity), config_.limits.velocity, velocity_cap());
    const auto limiter = velocity == 0 ? VelocityLimiter::stopping : allowed.limiter;
    aim(Goal::Kind::velocity, std::copysign(allowed.speed, velocity), dynamics, limiter);
}

/// `target` is local.
void AxisCore::aim_at_target(const AxisCommand& command, double target) noexcept {
    auto dynamics = dynamics_of(command, config_.limits, config_.defaults);
    const auto allowed = allowed_speed(command.velocity, config_.limits.velocity, velocity_cap());
    dynamics.velocity = allowed.speed;
    aim(Goal::Kind::position, target, dynamics, allowed.limiter);
    if (moves_continuously(command.kind)) {
        const auto end = allowed_speed(std::abs(command.end_velocity), config_.limits.velocity, velocity_cap());
        goal_.goes_on = true;
        goal_.end_velocity = std::copysign(end.speed, command.end_velocity);
        return;
    }
    commanded_target_ = target;
    has_commanded_target_ = true;
}

void AxisCore::aim_at_stop(const AxisCommand& command) noexcept { aim_at_rest(dynamics_of(command, config_.limits, config_.defaults)); }

double AxisCore::signed_velocity(const AxisCommand& command, bool backwards) const noexcept {
    if (command.kind != CommandKind::move_velocity && command.kind != CommandKind::drive_move_velocity) return command.velocity;
    const bool negative = command.direction == mcNegativeDirection || (command.direction == mcCurrentDirection && backwards);
    return negative ? -command.velocity : command.velocity;
}

/// Local target of a motion to a position that begins at `from`.
double AxisCore::target_of(const AxisCommand& command, const MotionState& from, bool backwards) const noexcept {
    const bool absolute = command.kind == CommandKind::move_absolute || command.kind == CommandKind::move_continuous_absolute;
    if (!absolute) return origin_ + command.position;
    return repetition_of(command, from, backwards);
}

/// Which repetition of a modulo axis' position is meant: the first from `from` in the direction; the next one after where the axis can
/// stop, when it already moves that way with a direction it must keep (P1-095). WholeTurns come on top.
double AxisCore::repetition_of(const AxisCommand& command, const MotionState& from, bool backwards) const noexcept {
    const double modulo = units_.modulo();
    if (!(modulo > 0)) return units_.to_local(command.position);

    constexpr double same_place = 1e-10;  // moduli: rounding must not send the axis round once more
    const bool with_turns = std::holds_alternative<WholeTurns>(command.details);
    const double turns = with_turns ? std::floor(command.position / modulo + same_place) : 0;
    const double place = units_.to_local(command.position - turns * modulo);
    auto direction = command.direction;
    double ahead = std::fmod(place - from.position, modulo);
    if (ahead < 0) ahead += modulo;
    if (ahead < same_place * modulo || modulo - ahead < same_place * modulo) ahead = 0;
    if (direction == mcCurrentDirection) direction = backwards ? mcNegativeDirection : mcPositiveDirection;
    const bool back = direction == mcNegativeDirection || (direction == mcShortestWay && ahead > modulo / 2);
    double way = back && ahead > 0 ? ahead - modulo : ahead;
    if (direction != mcShortestWay && from.velocity * (back ? -1 : 1) > 0) {
        auto limits = with_override(dynamics_of(command, config_.limits, config_.defaults));
        limits.velocity = config_.limits.velocity;
        const double stop = std::abs(stopping_distance(from, limits)) * (1 - 1e-9);
        const double missing = stop - std::abs(way);
        if (missing > 0) way += (back ? -modulo : modulo) * std::ceil(missing / modulo);
    }
    const double extra = direction == mcShortestWay ? 0 : back ? -turns : turns;
    return place + modulo * (std::round((from.position + way - place) / modulo) + extra);
}

}  // namespace taktwerk::axes
