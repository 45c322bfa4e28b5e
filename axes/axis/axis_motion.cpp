// From commands to set-points: the goal of the active command, the profile towards it, the limits that interrupt it, and what comes after.

#include <algorithm>
#include <cmath>

#include "axes/axis/axis.hpp"

namespace taktwerk::axes {

namespace {

constexpr double far_from_anchor = 1024;  // feeds: nearer than this `local` resolves some 1e-13 feeds

}  // namespace

void Axis::plan(Instant now, Duration period) noexcept {
    now_ = now;
    if (power_.follows_actual() || drive_homing_.busy()) {
        follow_actual(period);
        step_homing();
        publish();
        return;
    }
    const bool may_be_homed = state_ == AxisState::Homing;
    step_homing();
    carry_out_due_settings();
    // A command without Done has shown InVelocity (ProfileCompleted, ...) for a cycle: what waits behind it takes over, and it counts as
    // aborted.
    if (view_.active_in_target && hands_over_in_target(queue_.active().command.kind) && queue_.waiting() > 0) {
        queue_.finish_active(Outcome::aborted);
        start_waiting(0);
    }
    if (begin_pending_) begin_command();
    keep_close_to_anchor();

    const MotionState before = setpoint_.state();
    if (goal_pending_) run_goal(0);
    if (goal_.kind == Goal::Kind::given) step_given(period);
    else setpoint_.advance(period);
    if (goal_pending_) {  // what was given has ended badly: the axis brakes from where it is
        run_goal(0);
        setpoint_.advance(period);
    }
    guard(before, period);
    complete();
    publish_state();
    publish_setpoint();
    if (may_be_homed) publish_feedback();  // in other coordinates
}

void Axis::follow_actual(Duration period) noexcept {
    if (!online()) {
        aligned_ = false;
        return;
    }
    // Never faster than the axis may be, so that no trace shows a jump where a drive falls with a following error.
    const double way = actual_local() - setpoint_.state().position;
    const double most = config_.limits.velocity * to_seconds(period);
    aligned_ = drive_homing_.busy() || std::abs(way) <= most;
    setpoint_.place(aligned_ ? actual_local() : setpoint_.state().position + std::copysign(most, way));
    if (!power_.follows_actual()) return;
    goal_ = {};
    goal_pending_ = begin_pending_ = false;
}

void Axis::aim(Goal::Kind kind, double value, const MotionLimits& limits, VelocityLimiter limiter) noexcept {
    goal_ = {kind, value, limits, limiter};
    goal_pending_ = true;
}

void Axis::aim_at_velocity(double velocity, const MotionLimits& dynamics) noexcept {
    const auto allowed = allowed_speed(std::abs(velocity), config_.limits.velocity, velocity_cap());
    const auto limiter = velocity == 0 ? VelocityLimiter::stopping : allowed.limiter;
    aim(Goal::Kind::velocity, std::copysign(allowed.speed, velocity), dynamics, limiter);
}

double Axis::signed_velocity(const AxisCommand& command) const noexcept {
    if (command.kind != CommandKind::move_velocity) return command.velocity;
    switch (command.direction) {
        case mcNegativeDirection: return -command.velocity;
        case mcCurrentDirection: return setpoint_.state().velocity < 0 ? -command.velocity : command.velocity;
        case mcPositiveDirection:
        case mcShortestWay: break;
    }
    return command.velocity;
}

void Axis::begin_command() noexcept {
    begin_pending_ = false;
    const auto error = set_goal(queue_.active());
    if (error == ErrorId::none) return;
    queue_.finish_active(Outcome::error, error);
    start_waiting(0);
}

ErrorId Axis::set_goal(const AcceptedCommand& accepted) noexcept {
    const auto command = accepted.command;
    if (command.kind == CommandKind::home) return begin_homing(command);
    if (endless_) setpoint_.rebase(units_.reanchor(setpoint_.state().position));

    auto dynamics = dynamics_of(command, config_.limits, config_.defaults);
    const double here = setpoint_.state().position;
    switch (command.kind) {
        case CommandKind::move_absolute:
        case CommandKind::move_relative: {
            const auto allowed = allowed_speed(command.velocity, config_.limits.velocity, velocity_cap());
            dynamics.velocity = allowed.speed;
            const bool absolute = command.kind == CommandKind::move_absolute;
            aim(Goal::Kind::position, absolute ? units_.to_local(command.position) : here + command.position, dynamics, allowed.limiter);
            break;
        }
        case CommandKind::move_velocity:
        case CommandKind::jog: aim_at_velocity(signed_velocity(command), dynamics); break;
        case CommandKind::halt:
        case CommandKind::stop: aim(Goal::Kind::stop, 0, dynamics, VelocityLimiter::stopping); break;
        case CommandKind::position_profile:
        case CommandKind::velocity_profile:
        case CommandKind::acceleration_profile:
        case CommandKind::external: return set_goal_given(command);
        default: return ErrorId::not_supported;
    }
    return ErrorId::none;
}

void Axis::run_goal(double late) noexcept {
    goal_pending_ = false;
    const auto from = setpoint_.state();
    Plan plan;
    switch (goal_.kind) {
        case Goal::Kind::rest: return;
        case Goal::Kind::given: start_given(late); return;
        case Goal::Kind::position: {
            // A new target with gentle dynamics must not carry a fast axis past a software limit on its way back.
            if (software_limits_hold() && from.velocity != 0) {
                const double end = units_.to_program(from.position + stopping_distance(from, goal_.limits));
                const auto& limits = config_.limits;
                if (end > limits.position_max || end < limits.position_min) {
                    goal_.limits.deceleration = std::max(goal_.limits.deceleration, limits.deceleration);
                    goal_.limits.jerk = std::max(goal_.limits.jerk, limits.jerk);
                }
            }
            plan = plan_to_position(from, goal_.value, goal_.limits);
            break;
        }
        case Goal::Kind::velocity: plan = plan_to_velocity(from, goal_.value, goal_.limits); break;
        case Goal::Kind::stop: plan = plan_stop(from, goal_.limits); break;
    }
    if (plan.error != PlanError::none) {
        fail(AxisAlarm::planner_refused, units_.to_program(from.position), from.velocity);
        plan = plan_stop(from, stop_limits(config_.limits));
        goal_pending_ = false;
    }
    setpoint_.run(plan.profile, late);
    setpoint_.sample();
}

/// Only while nothing is planned: every local coordinate becomes another.
void Axis::anchor_near_actual() noexcept {
    if (std::abs(actual_local()) >= far_from_anchor * units_.feed()) units_.reanchor(actual_local());
}

void Axis::keep_close_to_anchor() noexcept {
    const double here = setpoint_.state().position;
    if (!endless_ || goal_pending_ || goal_.kind != Goal::Kind::velocity || !setpoint_.finished() ||
        std::abs(here) < far_from_anchor * units_.feed())
        return;
    setpoint_.rebase(units_.reanchor(here));
    goal_pending_ = true;
}

void Axis::guard(const MotionState& before, Duration period) noexcept {
    if (goal_.kind == Goal::Kind::rest || goal_.kind == Goal::Kind::stop || state_ == AxisState::Homing) return;
    if (!guard_switches() && !guard_software_limits(before)) return;
    setpoint_.restore(before);
    run_goal(0);
    setpoint_.advance(period);
}

bool Axis::guard_switches() noexcept {
    const double velocity = setpoint_.state().velocity;
    const double here = units_.to_program(setpoint_.state().position);
    if ((velocity > 0 && positive_switch_) || (velocity < 0 && negative_switch_)) {
        fail(velocity > 0 ? AxisAlarm::positive_limit_switch : AxisAlarm::negative_limit_switch, here);
        aim(Goal::Kind::stop, 0, stop_limits(config_.limits), VelocityLimiter::stopping);  // also on the way to a software limit
    } else if ((velocity > 0 && !permit_positive_) || (velocity < 0 && !permit_negative_)) {
        queue_.finish_active(Outcome::error, ErrorId::interlocked);
        stop_on_own_account(false);
    } else return false;
    return true;
}

bool Axis::guard_software_limits(const MotionState& before) noexcept {
    if (!software_limits_hold() || goal_.kind != Goal::Kind::velocity) return false;
    const auto& next = setpoint_.state();
    if (next.velocity == 0) return false;
    const double edge = next.velocity > 0 ? config_.limits.position_max : config_.limits.position_min;
    if (std::isinf(edge)) return false;

    auto limits = full_limits(config_.limits);
    const double end = next.position + stopping_distance(next, limits);
    const double edge_local = units_.to_local(edge);
    if (next.velocity > 0 ? end <= edge_local : end >= edge_local) return false;

    // One period ago stopping was still possible: from there the way to the limit ends exactly on it.
    limits.velocity = std::min(limits.velocity, std::max(std::abs(goal_.value), std::abs(before.velocity)));
    if (hands_over_in_target(queue_.active().command.kind))
        fail(AxisAlarm::software_limit_reached, units_.to_program(before.position), edge);
    // Also in ErrorStop: its own stop might be softer and pass the limit.
    aim(Goal::Kind::position, edge_local, limits, VelocityLimiter::software_limit);
    return true;
}

void Axis::complete() noexcept {
    if (goal_.kind == Goal::Kind::given) {
        queue_.set_in_target(feed_.followed && queue_.active().command.kind == CommandKind::external);
        return;
    }
    if (state_ == AxisState::ContinuousMotion) queue_.set_in_target(setpoint_.finished() && goal_.kind == Goal::Kind::velocity);
    for (std::size_t i = 0; i <= CommandQueue::capacity; ++i)
        if (goal_pending_ || goal_.kind == Goal::Kind::given || !setpoint_.finished() || !complete_active()) return;
}

bool Axis::complete_active() noexcept {
    const auto kind = queue_.active().command.kind;
    if (state_ == AxisState::Stopping) {
        if (goal_.kind != Goal::Kind::stop) return false;
        setpoint_.go_to_end();
        queue_.finish_active(Outcome::done);
        leave_stopping();
        return false;
    }
    if (state_ != AxisState::DiscreteMotion || kind == CommandKind::none) return false;
    if (goal_.kind == Goal::Kind::velocity && goal_.value != 0) {  // a jog at its speed
        queue_.set_in_target(true);
        return false;
    }
    const double late = setpoint_.overtime();
    setpoint_.go_to_end();
    if (jog_expired_ && kind == CommandKind::jog) queue_.finish_active(Outcome::error, static_cast<ErrorId>(AxisAlarm::jog_lease_expired));
    else queue_.finish_active(Outcome::done);
    start_waiting(late);
    return queue_.has_active();
}

void Axis::start_waiting(double late) noexcept {
    if (!moves()) fire(AxisEvent::done);
    while (queue_.waiting() > 0) {
        const auto next = queue_.pop();
        if (next.command.kind == CommandKind::setting) {
            carry_out(next);
            continue;
        }
        auto error = next_state(state_, event_of(next.command.kind)) ? refuse_target(next.command, true) : ErrorId::state_forbids;
        if (error == ErrorId::none) {
            fire(event_of(next.command.kind));
            queue_.activate(next);
            error = set_goal(next);
            if (error == ErrorId::none) {
                if (goal_pending_) run_goal(late);
                return;
            }
            queue_.finish_active(Outcome::error, error);
            if (!moves()) fire(AxisEvent::done);
        } else queue_.record(next.id, Outcome::error, error);
    }
    if (!moves()) goal_ = {};
}

}  // namespace taktwerk::axes
