#include "axes/axis/succession.hpp"

#include <cmath>

#include "axes/axis/admission.hpp"
#include "axes/axis/aim.hpp"
#include "axes/axis/axis_coupling.hpp"
#include "axes/axis/axis_homing.hpp"
#include "axes/axis/axis_settings.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/conduct.hpp"
#include "axes/axis/drive_modes.hpp"
#include "axes/axis/drive_profiles.hpp"
#include "axes/axis/given_motion.hpp"
#include "axes/axis/homing_steps.hpp"
#include "axes/axis/jog_lease.hpp"
#include "axes/axis/targets.hpp"

namespace taktwerk::axes {

void Succession::begin_command() noexcept {
    body_.begin_pending = false;
    const auto error = set_goal(body_.queue.active());
    if (error == ErrorId::none) return;
    body_.queue.finish_active(Outcome::error, error);
    start_waiting(0);
}

ErrorId Succession::begin_home(const AxisCommand& command) noexcept {
    const auto error = homing_.begin(command);
    if (homing_.over()) start_waiting(0);
    return error;
}

/// The slave keeps its velocity (P1-271), and with Done begins what was buffered behind it (table 4).
void Succession::decouple() noexcept {
    aim_.start_at_base();
    aim_.at_velocity(motion_.setpoint.base().velocity, full_limits(body_.config.limits));
    motion_.goal.kept = true;
    body_.queue.finish_active(Outcome::done);
    while (body_.queue.waiting() > 0 && body_.queue.front().command.kind == CommandKind::setting) settings_.carry_out(body_.queue.pop());
    if (body_.queue.waiting() > 0) start_waiting(0);
}

ErrorId Succession::set_goal(const AcceptedCommand& accepted) noexcept {
    const auto command = accepted.command;
    switch (command.kind) {
        case CommandKind::home: return begin_home(command);
        case CommandKind::homing_step: return steps_.begin(command);
        case CommandKind::move_absolute:
        case CommandKind::move_relative:
        case CommandKind::move_additive:
        case CommandKind::move_continuous_absolute:
        case CommandKind::move_continuous_relative:
            aim_.start_at_base();
            if (command.kind == CommandKind::move_additive && motion_.has_commanded_target) motion_.origin = motion_.commanded_target;
            aim_.at_target(command, targets_.target_of(command, motion_.setpoint.base(), motion_.started_backwards));
            break;
        case CommandKind::move_velocity:
        case CommandKind::jog:
            aim_.start_at_base();
            motion_.has_commanded_target = false;
            aim_.at_velocity(targets_.signed_velocity(command, motion_.started_backwards),
                             dynamics_of(command, body_.config.limits, body_.config.defaults));
            break;
        case CommandKind::halt:
        case CommandKind::stop:
            aim_.start_at_base();
            aim_.at_stop(command);
            break;
        case CommandKind::position_profile:
        case CommandKind::velocity_profile:
        case CommandKind::acceleration_profile:
        case CommandKind::external:
        case CommandKind::group_motion:
            aim_.start_at_base();
            if (const auto error = given_.take(command); error != ErrorId::none) return error;
            aim_.at(Goal::Kind::given, 0, full_limits(body_.config.limits), VelocityLimiter::command);
            break;
        case CommandKind::gear_in:
        case CommandKind::gear_in_pos:
        case CommandKind::cam_in:
        case CommandKind::combine: return coupling_.join(accepted);
        case CommandKind::gear_out:
        case CommandKind::cam_out: decouple(); break;
        case CommandKind::torque:
            aim_.start_at_base();
            switching_.begin_torque(command);
            break;
        case CommandKind::set_controller_mode: switching_.begin_mode_change(command); break;
        case CommandKind::drive_move_absolute:
        case CommandKind::drive_move_relative:
        case CommandKind::drive_move_velocity:
        case CommandKind::drive_torque: profiles_.begin(command); break;
        default: return ErrorId::not_supported;
    }
    return ErrorId::none;
}

void Succession::hand_over() noexcept {
    if (!hands_over_in_target(body_.queue.active().command.kind)) return;
    body_.queue.finish_active(Outcome::aborted);
    start_waiting(0);
}

void Succession::complete() noexcept {
    if (motion_.goal.kind == Goal::Kind::coupled) {
        if (coupling_.complete()) start_waiting(0);
        return;
    }
    if (motion_.goal.kind == Goal::Kind::given) {
        body_.queue.set_in_target(given_.follows_feed() && body_.queue.active().command.kind == CommandKind::external);
        return;
    }
    for (std::size_t i = 0; !motion_.held && i <= CommandQueue::capacity; ++i)
        if (motion_.goal_pending || motion_.goal.kind == Goal::Kind::given || !motion_.setpoint.finished() || !complete_active()) break;
    const bool to_velocity = motion_.goal.kind == Goal::Kind::velocity;
    // P1-203: at the reduced velocity it is TRUE, also where that is 0.
    if (body_.state == AxisState::ContinuousMotion && (to_velocity || motion_.goal.kind == Goal::Kind::position))
        body_.queue.set_in_target(to_velocity && motion_.setpoint.finished() && motion_.wants_speed == 0);
}

bool Succession::complete_active() noexcept {
    const auto kind = body_.queue.active().command.kind;
    if (body_.slow_line && measured_.online()) {  // the motor follows late: it has to be there
        const bool stops = motion_.goal.kind == Goal::Kind::stop || (motion_.goal.kind == Goal::Kind::velocity && motion_.goal.value == 0);
        const bool arrives = motion_.goal.kind == Goal::Kind::position && ends_at_position(kind) && body_.queue.waiting() == 0;
        if ((stops || arrives) && !(measured_.stands() && measured_.feedback.commands_acknowledged)) return false;
        if (arrives && std::abs(motion_.setpoint.end().position - measured_.local()) > body_.config.windows.in_position) return false;
    }
    if (body_.state == AxisState::Stopping) {
        if (motion_.goal.kind != Goal::Kind::stop) return false;
        motion_.setpoint.go_to_end();
        body_.queue.finish_active(Outcome::done);
        if (conduct_.leave_stopping()) start_waiting(0);
        return false;
    }
    if (motion_.goal.kind == Goal::Kind::position && motion_.goal.goes_on) {
        // MC_MoveContinuous... is past its target: from here on it is a motion at a velocity.
        const double late = motion_.setpoint.overtime();
        motion_.setpoint.go_to_end();
        motion_.goal.kind = Goal::Kind::velocity;
        motion_.goal.value = motion_.goal.end_velocity;
        motion_.goal.limits.velocity = body_.config.limits.velocity;
        motion_.goal.goes_on = false;
        conduct_.run_goal(late);
        return false;
    }
    if (made_by_drive(kind)) {  // the axis has stopped for it
        profiles_.ask_for_mode();
        return false;
    }
    if (body_.state == AxisState::Homing && kind == CommandKind::homing_step) {
        if (!steps_.complete()) return false;
        start_waiting(0);
        return body_.queue.has_active();
    }
    if (body_.state != AxisState::DiscreteMotion || motion_.goal.kind == Goal::Kind::rest) return false;
    if (kind == CommandKind::none && motion_.goal.kind != Goal::Kind::stop) return false;
    if (motion_.goal.kind == Goal::Kind::velocity && motion_.goal.value != 0) {  // a jog at its speed
        body_.queue.set_in_target(true);
        return false;
    }
    const double late = motion_.setpoint.overtime();
    motion_.setpoint.go_to_end();
    if (jog_.expired() && kind == CommandKind::jog)
        body_.queue.finish_active(Outcome::error, static_cast<ErrorId>(AxisAlarm::jog_lease_expired));
    else body_.queue.finish_active(Outcome::done);
    start_waiting(late);
    return body_.queue.has_active();
}

void Succession::start_waiting(double late) noexcept {
    if (!conduct_.moves() && !body_.homing_procedure) conduct_.fire(AxisEvent::done);
    while (body_.queue.waiting() > 0) {
        const auto next = body_.queue.pop();
        if (next.command.kind == CommandKind::setting) {
            settings_.carry_out(next);
            continue;
        }
        auto error =
            next_state(body_.state, event_of(next.command.kind)) ? admission_.refuse_target(next.command, true) : ErrorId::state_forbids;
        if (error == ErrorId::none) error = switching_.refuse(next.command, true);
        if (error == ErrorId::none) {
            conduct_.fire(event_of(next.command.kind));
            body_.queue.activate(next);
            if (modes_.in_profile()) {  // it begins when the drive takes its set-point, or is back in the axis' own mode
                body_.begin_pending = true;
                return;
            }
            error = set_goal(next);
            if (error == ErrorId::none) {
                if (motion_.goal_pending) conduct_.run_goal(late);
                return;
            }
            body_.queue.finish_active(Outcome::error, error);
            if (!conduct_.moves() && !body_.homing_procedure) conduct_.fire(AxisEvent::done);
        } else body_.queue.record(next.id, Outcome::error, error);
    }
    const auto& base = motion_.setpoint.base();
    if (base.velocity != 0 || base.acceleration != 0) {  // what should have gone on here turned out impossible
        if (body_.state == AxisState::ErrorStop) return;
        const bool layered = motion_.setpoint.layered();
        if (layered) motion_.setpoint.sample();  // the base comes to where the other layer is in time, before both become one
        conduct_.halt_on_own_account();
        conduct_.run_goal(layered ? 0 : late);
        return;
    }
    motion_.goal = {};
    if (!conduct_.moves()) motion_.setpoint.fold();
}

}  // namespace taktwerk::axes
