// How the axis gets into and out of ErrorStop, Stopping and Disabled.

#include <chrono>

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

namespace {

using namespace std::chrono_literals;

constexpr Duration reset_patience = 2s;  // a drive that still reports its fault after this long will not be reset

}  // namespace

bool AxisCore::fire(AxisEvent event) noexcept {
    const auto to = next_state(view_.state, event);
    if (to) view_.state = *to;
    show_power();
    if (view_.state != AxisState::DiscreteMotion) has_commanded_target_ = false;  // P1-147: it lives as long as that motion
    if (to && event == AxisEvent::homing_step) {
        view_.homing_procedure = true;
        step_succeeded_ = false;
    } else if (view_.state != AxisState::Homing) {
        view_.homing_procedure = step_succeeded_ = false;
    }
    return to.has_value();
}

void AxisCore::fail(AxisAlarm alarm, double a, double b) noexcept {
    if (!alarms_.raise(alarm, a, b)) return;
    const auto how = reaction(alarm);
    if (how < Reaction::stop_axis) return;
    enter_error_stop(id(alarm), how == Reaction::power_off);
}

void AxisCore::stop_for_error(AlarmId reason, bool then_power_off) noexcept {
    const bool stays_off = view_.state == AxisState::Disabled && !power_wish_;
    if (!stays_off && alarms_.raise(AxisAlarm::stopped_by_machine, reason, 0)) {
        enter_error_stop(id(AxisAlarm::stopped_by_machine), then_power_off);
        publish();
    } else if (then_power_off && view_.state == AxisState::ErrorStop) {
        off_after_error_ = true;
    }
}

void AxisCore::enter_error_stop(AlarmId reason, bool then_power_off) noexcept {
    off_after_error_ = off_after_error_ || then_power_off;
    if (view_.state == AxisState::ErrorStop) return;  // it stops already; the first error is the one shown
    view_.error = reason;
    view_.reset_error = ErrorId::none;
    fire(AxisEvent::axis_error);
    queue_.finish_active(Outcome::error, static_cast<ErrorId>(reason));
    queue_.finish_waiting(Outcome::error, ErrorId::aborted_by_axis_error);
    end_superimposed(Outcome::error, ErrorId::aborted_by_axis_error);
    view_.lock = 0;
    off_when_stopped_ = begin_pending_ = false;
    abort_homing();
    aim_at_rest(stop_limits(config_.limits));
}

void AxisCore::stop_on_own_account(bool then_power_off) noexcept {
    queue_.finish_active(Outcome::aborted);
    queue_.finish_waiting(Outcome::aborted);
    end_superimposed(Outcome::aborted);
    view_.lock = 0;
    begin_pending_ = false;
    off_when_stopped_ = off_when_stopped_ || then_power_off;
    abort_homing();
    if (view_.state != AxisState::Stopping) fire(AxisEvent::stop);
    aim_at_rest(full_limits(config_.limits));
}

/// A command could not go on, which is an error of its instance and none of the axis: it comes to rest as by MC_Halt, and may be moved again at
/// once. Stopping is for MC_Stop (figure 2), for power that goes, and for a change of hands.
void AxisCore::halt_on_own_account() noexcept {
    if (!next_state(view_.state, AxisEvent::discrete)) return stop_on_own_account(false);
    queue_.finish_active(Outcome::aborted);
    queue_.finish_waiting(Outcome::aborted);
    end_superimposed(Outcome::aborted);
    begin_pending_ = false;
    fire(AxisEvent::discrete);
    aim_at_rest(full_limits(config_.limits));
}

void AxisCore::switch_off() noexcept {
    queue_.finish_active(Outcome::aborted);
    queue_.finish_waiting(Outcome::aborted);
    end_superimposed(Outcome::aborted);
    view_.lock = 0;
    off_when_stopped_ = begin_pending_ = false;
    power_dropping_ = true;
    abort_homing();
    goal_ = {};
    if (setpoint_.at_rest()) setpoint_.place(setpoint_.state().position);  // also when a profile was just about to begin
    fire(AxisEvent::power_off);
}

void AxisCore::shut_down() noexcept {
    power_wish_ = false;
    if (view_.state == AxisState::Disabled) queue_.finish_waiting(Outcome::aborted);        // what waited for power
    if (view_.state == AxisState::Disabled || view_.state == AxisState::ErrorStop) return;  // power_wanted() sees the wish
    if (moves()) stop_on_own_account(true);
    else switch_off();
    publish();
}

void AxisCore::leave_stopping() noexcept {
    if (off_when_stopped_) {
        switch_off();
        return;
    }
    if (view_.lock != 0) return;
    fire(AxisEvent::stop_finished);
    goal_ = {};
    if (queue_.waiting() > 0) start_waiting(0);
}

void AxisCore::supervise(Instant now) noexcept {
    now_ = now;
    const bool jogs = queue_.active().command.kind == CommandKind::jog;
    if (emergency_ == EmergencyStop::none && !jogs) return;
    if (emergency_ != EmergencyStop::none) {
        const bool stays_off = view_.state == AxisState::Disabled && !power_wish_ && power_.phase() == PowerSequence::Phase::off;
        if (!stays_off) fail(AxisAlarm::emergency_stop);
        if (emergency_ >= EmergencyStop::stop_and_power_off) off_after_error_ = view_.state == AxisState::ErrorStop;
    }
    watch_jog_lease();
    publish();
}

void AxisCore::watch_jog_lease() noexcept {
    const auto& active = queue_.active();
    if (active.command.kind != CommandKind::jog || jog_expired_ || now_ - jog_renewed_ < config_.jog_lease) return;
    jog_expired_ = true;
    fail(AxisAlarm::jog_lease_expired, to_seconds(config_.jog_lease));
    begin_pending_ = false;
    aim_at_velocity(0, dynamics_of(active.command, config_.limits, config_.defaults));
}

void AxisCore::run_reset() noexcept {
    if (view_.state != AxisState::ErrorStop) {
        view_.resetting = false;
        return;
    }
    // A polled drive that was away still carries out what comes first, mostly being disabled: the fault it may have is not known before.
    const bool under_way = online() && !feedback_.commands_acknowledged;
    if (under_way) reset_since_ = now_;
    const bool cause_present = !online() || under_way || drive_faulted() || feedback_.setup_refused || emergency_ != EmergencyStop::none;
    if (!moves() && !cause_present) {
        if (power_.on() && power_wish_ && !off_after_error_) {
            end_reset(AxisEvent::reset_powered);
            return;
        }
        if (power_.phase() == PowerSequence::Phase::off) {
            end_reset(AxisEvent::reset_unpowered);
            return;
        }
        // Power is on its way off (note 3 or 4 holds when it is there).
    }
    const bool hopeless = drive_faulted() && !port_.alarm().resettable;  // the drive says: power cycle
    if (hopeless || now_ - reset_since_ >= reset_patience) {
        view_.resetting = false;
        view_.reset_error = ErrorId::reset_failed;
    }
}

void AxisCore::end_reset(AxisEvent event) noexcept {
    view_.resetting = false;
    view_.reset_error = ErrorId::none;
    view_.error = 0;
    off_after_error_ = false;
    goal_ = {};
    alarms_.clear_all_but(AxisAlarm::drive_warning);
    fire(event);
}

}  // namespace taktwerk::axes
