#include "axes/axis/conduct.hpp"

#include <algorithm>

#include "axes/axis/aim.hpp"
#include "axes/axis/base_motion.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/superimposed_motion.hpp"

namespace taktwerk::axes {

bool Conduct::moves() const noexcept {
    return !motion_.setpoint.at_rest() || runs_.drive.busy() || body_.queue.beside(SideSlot::superimposed) != 0;
}

void Conduct::fire(AxisEvent event) noexcept {
    const auto to = next_state(body_.state, event);
    if (to) body_.state = *to;
    if (body_.state != AxisState::DiscreteMotion) motion_.has_commanded_target = false;  // P1-147: it lives as long as that motion
    if (to && event == AxisEvent::homing_step) {
        body_.homing_procedure = true;
        runs_.step_succeeded = false;
    } else if (body_.state != AxisState::Homing) {
        body_.homing_procedure = runs_.step_succeeded = false;
    }
}

void Conduct::fail(AxisAlarm alarm, double a, double b) noexcept {
    if (!body_.alarms.raise(alarm, a, b)) return;
    const auto how = body_.config.reactions.of(alarm);
    if (how >= ErrorReaction::ramp_stop) enter_error_stop(id(alarm), how);
}

void Conduct::enter_error_stop(AlarmId reason, ErrorReaction how) noexcept {
    off_after_error_ = off_after_error_ || how >= ErrorReaction::ramp_then_off;
    hardest_ = std::max(hardest_, how);
    if (body_.state == AxisState::ErrorStop) return;  // it stops already; the first error is the one shown
    body_.error = reason;
    reset_error_ = ErrorId::none;
    fire(AxisEvent::axis_error);
    body_.queue.finish_active(Outcome::error, static_cast<ErrorId>(reason));
    body_.queue.finish_waiting(Outcome::error, ErrorId::aborted_by_axis_error);
    addition_.end(Outcome::error, ErrorId::aborted_by_axis_error);
    body_.lock = 0;
    off_when_stopped_ = body_.begin_pending = false;
    runs_.abort();
    aim_.at_rest(stop_limits(body_.config.limits));
}

bool Conduct::stop_for_error(AlarmId reason, bool then_power_off) noexcept {
    const bool stays_off = body_.state == AxisState::Disabled && !body_.power_wish;
    if (!stays_off && body_.alarms.raise(AxisAlarm::stopped_by_machine, reason, 0)) {
        enter_error_stop(id(AxisAlarm::stopped_by_machine), then_power_off ? ErrorReaction::ramp_then_off : ErrorReaction::ramp_stop);
        return true;
    }
    if (then_power_off && body_.state == AxisState::ErrorStop) off_after_error_ = true;
    return false;
}

void Conduct::stop_on_own_account(bool then_power_off) noexcept {
    body_.queue.finish_active(Outcome::aborted);
    body_.queue.finish_waiting(Outcome::aborted);
    addition_.end(Outcome::aborted);
    body_.lock = 0;
    body_.begin_pending = false;
    off_when_stopped_ = off_when_stopped_ || then_power_off;
    runs_.abort();
    if (body_.state != AxisState::Stopping) fire(AxisEvent::stop);
    aim_.at_rest(full_limits(body_.config.limits));
}

void Conduct::halt_on_own_account() noexcept {
    if (!next_state(body_.state, AxisEvent::discrete)) return stop_on_own_account(false);
    body_.queue.finish_active(Outcome::aborted);
    body_.queue.finish_waiting(Outcome::aborted);
    addition_.end(Outcome::aborted);
    body_.begin_pending = false;
    fire(AxisEvent::discrete);
    aim_.at_rest(full_limits(body_.config.limits));
}

void Conduct::switch_off() noexcept {
    body_.queue.finish_active(Outcome::aborted);
    body_.queue.finish_waiting(Outcome::aborted);
    addition_.end(Outcome::aborted);
    body_.lock = 0;
    off_when_stopped_ = body_.begin_pending = false;
    power_dropping_ = true;
    runs_.abort();
    motion_.goal = {};
    if (motion_.setpoint.at_rest())
        motion_.setpoint.place(motion_.setpoint.state().position);  // also when a profile was just about to begin
    fire(AxisEvent::power_off);
}

void Conduct::shut_down() noexcept {
    body_.power_wish = false;
    if (body_.state == AxisState::Disabled) body_.queue.finish_waiting(Outcome::aborted);   // what waited for power
    if (body_.state == AxisState::Disabled || body_.state == AxisState::ErrorStop) return;  // power goes with the wish
    if (moves()) stop_on_own_account(true);
    else switch_off();
}

bool Conduct::leave_stopping() noexcept {
    if (off_when_stopped_) {
        switch_off();
        return false;
    }
    if (body_.lock != 0) return false;
    fire(AxisEvent::stop_finished);
    motion_.goal = {};
    return body_.queue.waiting() > 0;
}

void Conduct::run_goal(double late) noexcept {
    if (base_.plan_goal(late)) return;
    const auto& from = motion_.setpoint.base();
    fail(AxisAlarm::planner_refused, body_.units.to_program(from.position), from.velocity);
    base_.stop_instead(late);
}

void Conduct::end_with(ErrorId error) noexcept {
    body_.queue.finish_active(Outcome::error, error);
    halt_on_own_account();
}

void Conduct::obey_emergency() noexcept {
    const bool stays_off = body_.state == AxisState::Disabled && !body_.power_wish && body_.power.phase() == PowerSequence::Phase::off;
    if (!stays_off) fail(AxisAlarm::emergency_stop);
    if (body_.emergency >= EmergencyStop::stop_and_power_off) off_after_error_ = body_.state == AxisState::ErrorStop;
}

void Conduct::give_way(const AxisCommand& command) noexcept {
    body_.queue.finish_active(Outcome::aborted);
    body_.queue.finish_waiting(Outcome::aborted);
    // P1-151: in any other mode what is superimposed goes on beside it.
    const bool aborts = command.buffer_mode == mcAborting;
    if (aborts && couples(command.kind)) addition_.abandon();
    else if (aborts) addition_.end(Outcome::aborted);
    runs_.abort();
}

void Conduct::change_hands(Owner owner) noexcept {
    body_.owner = owner;
    body_.brake.let_go();
    body_.permit_positive = body_.permit_negative = true;
    if (body_.state == AxisState::Disabled) body_.queue.finish_waiting(Outcome::aborted);  // for power that another party wanted
    const bool commanded = body_.queue.has_active() || body_.queue.waiting() > 0 || body_.lock != 0 || moves();
    if (commanded && body_.state != AxisState::Disabled && body_.state != AxisState::ErrorStop) stop_on_own_account(off_when_stopped_);
}

}  // namespace taktwerk::axes
