// What comes after what: the end of a command, the one that waits behind it, and how fast the axis passes from one into the next.

#include <array>
#include <cmath>

#include "axes/axis/axis_core.hpp"
#include "axes/axis/junction.hpp"

namespace taktwerk::axes {

/// A command that has shown its Inxxx output for a cycle gives way to what waits behind it: it has no Done, so it counts as aborted.
void AxisCore::hand_over() noexcept {
    if (!hands_over_in_target(queue_.active().command.kind)) return;
    queue_.finish_active(Outcome::aborted);
    start_waiting(0);
}

void AxisCore::complete() noexcept {
    if (goal_.kind == Goal::Kind::coupled) {
        complete_coupled();
        return;
    }
    if (goal_.kind == Goal::Kind::given) {
        queue_.set_in_target(feed_.followed && queue_.active().command.kind == CommandKind::external);
        return;
    }
    for (std::size_t i = 0; !held_ && i <= CommandQueue::capacity; ++i)
        if (goal_pending_ || goal_.kind == Goal::Kind::given || !setpoint_.finished() || !complete_active()) break;
    const bool to_velocity = goal_.kind == Goal::Kind::velocity;
    // P1-203: at the reduced velocity it is TRUE, also where that is 0.
    if (view_.state == AxisState::ContinuousMotion && (to_velocity || goal_.kind == Goal::Kind::position))
        queue_.set_in_target(to_velocity && setpoint_.finished() && wants_speed_ == 0);
}

bool AxisCore::complete_active() noexcept {
    const auto kind = queue_.active().command.kind;
    if (port_.capabilities().setpoints == SetpointClass::low_dynamics && online()) {  // the motor follows late: it has to be there
        const bool stops = goal_.kind == Goal::Kind::stop || (goal_.kind == Goal::Kind::velocity && goal_.value == 0);
        const bool arrives = goal_.kind == Goal::Kind::position && ends_at_position(kind) && queue_.waiting() == 0;
        if ((stops || arrives) && !(drive_stands() && feedback_.commands_acknowledged)) return false;
        if (arrives && std::abs(setpoint_.end().position - actual_local()) > config_.windows.in_position) return false;
    }
    if (view_.state == AxisState::Stopping) {
        if (goal_.kind != Goal::Kind::stop) return false;
        setpoint_.go_to_end();
        queue_.finish_active(Outcome::done);
        leave_stopping();
        return false;
    }
    if (goal_.kind == Goal::Kind::position && goal_.goes_on) {
        // MC_MoveContinuous... is past its target: from here on it is a motion at a velocity.
        const double late = setpoint_.overtime();
        setpoint_.go_to_end();
        goal_.kind = Goal::Kind::velocity;
        goal_.value = goal_.end_velocity;
        goal_.limits.velocity = config_.limits.velocity;
        goal_.goes_on = false;
        run_goal(late);
        return false;
    }
    if (made_by_drive(kind)) {  // the axis has stopped for it
        ask_for_drive_mode();
        return false;
    }
    if (view_.state == AxisState::Homing && kind == CommandKind::homing_step) return complete_homing_step();
    if (view_.state != AxisState::DiscreteMotion || goal_.kind == Goal::Kind::rest) return false;
    if (kind == CommandKind::none && goal_.kind != Goal::Kind::stop) return false;
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

void AxisCore::start_waiting(double late) noexcept {
    if (!moves() && !view_.homing_procedure) fire(AxisEvent::done);
    while (queue_.waiting() > 0) {
        const auto next = queue_.pop();
        if (next.command.kind == CommandKind::setting) {
            carry_out(next);
            continue;
        }
        auto error = next_state(view_.state, event_of(next.command.kind)) ? refuse_target(next.command, true) : ErrorId::state_forbids;
        if (error == ErrorId::none) error = refuse_mode(next.command, true);
        if (error == ErrorId::none) {
            fire(event_of(next.command.kind));
            queue_.activate(next);
            if (in_drive_profile()) {  // it begins when the drive takes its set-point, or is back in the axis' own mode
                begin_pending_ = true;
                return;
            }
            error = set_goal(next);
            if (error == ErrorId::none) {
                if (goal_pending_) run_goal(late);
                return;
            }
            queue_.finish_active(Outcome::error, error);
            if (!moves() && !view_.homing_procedure) fire(AxisEvent::done);
        } else queue_.record(next.id, Outcome::error, error);
    }
    const auto& base = setpoint_.base();
    if (base.velocity != 0 || base.acceleration != 0) {  // what should have gone on here turned out impossible
        if (view_.state == AxisState::ErrorStop) return;
        const bool layered = setpoint_.layered();
        if (layered) setpoint_.sample();  // the base comes to where the other layer is in time, before both become one
        halt_on_own_account();
        run_goal(layered ? 0 : late);
        return;
    }
    goal_ = {};
    if (!moves()) setpoint_.fold();
}

double AxisCore::velocity_at_junction(const MotionState& from, const MotionLimits& limits) const noexcept {
    const auto& active = queue_.active().command;
    if (queue_.waiting() == 0 || !blends(queue_.waiting_at(0).command.buffer_mode) || !ends_at_position(active.kind)) return 0;
    if (goal_.limiter == VelocityLimiter::software_limit) return 0;

    const double factor = override_counts() ? override_.velocity : 1;
    const double superimposed = setpoint_.superimposed().position + setpoint_.superimposed_rest();
    std::array<ChainMove, CommandQueue::capacity + 1> chain{};
    chain[0] = {.way = goal_.value - from.position, .speed = limits.velocity, .limits = limits};
    std::size_t length = 1;
    MotionState place{goal_.value, 0, 0};
    for (std::size_t i = 0; i < queue_.waiting(); ++i) {
        const auto& command = queue_.waiting_at(i).command;
        const auto& before = chain[length - 1];
        if (!blends(command.buffer_mode) || before.end != ChainMove::End::rest) break;

        ChainMove move;
        move.mode = command.buffer_mode;
        move.limits = with_override(dynamics_of(command, config_.limits, config_.defaults));
        move.speed = factor * allowed_speed(std::abs(command.velocity), config_.limits.velocity, velocity_cap()).speed;
        const bool backwards = before.way < 0;
        if (command.kind == CommandKind::move_velocity) {
            move.end = ChainMove::End::none;
            move.way = signed_velocity(command, backwards);
        } else if (ends_at_position(command.kind) || moves_continuously(command.kind)) {
            const bool absolute = command.kind == CommandKind::move_absolute || command.kind == CommandKind::move_continuous_absolute;
            // Its turn on a modulo axis is the one that it would take from a stop, as Buffered.
            const double target = absolute ? repetition_of(command, place, backwards) - superimposed : place.position + command.position;
            const double sense = target - place.position;
            if (!permitted(sense) || (software_limits_hold() && refuse_place(units_.to_program(target)) != ErrorId::none)) break;
            move.way = sense;
            place.position = target;
            if (moves_continuously(command.kind)) {
                move.end = ChainMove::End::velocity;
                const auto end = allowed_speed(std::abs(command.end_velocity), config_.limits.velocity, velocity_cap());
                move.end_velocity = factor * std::copysign(end.speed, command.end_velocity);
            }
        } else break;
        chain[length++] = move;
    }
    const double wanted = junction_velocity({chain.data(), length});
    return nearest_reachable(wanted, from, goal_.value, limits);
}

}  // namespace taktwerk::axes
