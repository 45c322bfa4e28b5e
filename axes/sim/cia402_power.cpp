// The power state machine of CiA 402-2: what the control word asks, what entering a state brings with it.

#include <algorithm>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

void Cia402Axis::power_on(Instant now) noexcept {
    now_ = now;
    mode_ = 0;
    error_code_ = 0;
    error_detail_ = 0;
    error_resettable_ = true;
    last_control_ = 0;
    encoder_failed_ = winding_down_ = phases_shorted_ = false;
    mode_changed_at_.reset();
    brake_closed_ = has_brake();
    brake_closing_ = plant_.config().brake_closing;
    power_went_ = now;
    read_switches({});
    for (auto& probe : probes_) probe.command(0);
    homing_.cancel();
    hidden_alarm_ = {};
    common_alarm_ = false;
    overload_lasts_ = {};
    enter(State::not_ready);
    self_test_ends_ = now + profile_->self_test;
    end_self_test();
}

/// TSVM 5.3.1, transitions 1 and 13: an error found while starting leads to Fault at once.
void Cia402Axis::end_self_test() noexcept {
    if (!self_test_ends_ || now_ < *self_test_ends_) return;
    self_test_ends_.reset();
    warnings_.clear();
    powered_at_ = now_;
    heat_ = 0;
    stalled_ = {};
    enter(State::disabled);
    wake_encoder();
    show_causes();
}

void Cia402Axis::enter(State state) noexcept {
    const bool powered = state_ == State::enabled || state_ == State::quick_stop;
    if (state == State::enabled || state == State::not_ready || state == State::fault_reaction) winding_down_ = false;
    else if (powered && state != State::quick_stop)
        wind_down(state == State::ready ? StopCause::shutdown : state == State::switched_on ? StopCause::disable : StopCause::off);
    if (state == State::enabled && state_ != State::enabled) {
        brake_opens_ = now_ + profile_->brake.release;
        commands_from_ = now_ + std::max(profile_->brake.release, profile_->deaf_after_enable);
        demand_ = {seen_position(), 0, 0};
        forget_targets();
        strikes_ = 0;
        loop_.reset();
    }
    if (state != State::enabled) homing_.cancel();
    if (state != State::enabled) halted_ = ramps_out_ = false;
    if (state == State::enabled || state == State::not_ready) phases_shorted_ = false;
    if (state == State::quick_stop) begin_stop(stop_for(StopCause::quick_stop));
    if (state == State::fault_reaction) begin_stop(stop_for(StopCause::fault));
    state_ = state;
}

void Cia402Axis::command(const AxisInputs& in) noexcept {
    const std::uint16_t word = in.control;
    const bool reset_edge = (word & 0x80u) && !(last_control_ & 0x80u);
    last_control_ = word;
    if (state_ == State::fault) {
        const bool dropped = !has(Quirk::fault_reset_needs_disable) || (word & 0x0Fu) != 0x0Fu;
        if (reset_edge && dropped) reset_alarm();
        return;
    }
    if (word & 0x80u) return;  // while bit 7 stands nothing else is taken (SV33-E 3.4.1, TSVM 5.3.2)
    const bool voltage = (word & 0x02u) != 0, quick = (word & 0x04u) == 0;
    const bool shutdown = voltage && !quick && !(word & 0x01u);
    const bool switch_on = voltage && !quick && (word & 0x01u);
    const bool enable = switch_on && (word & 0x08u);
    switch (state_) {
        case State::disabled:
            if (shutdown) enter(State::ready);
            break;
        case State::ready:
            if (!voltage || quick) enter(State::disabled);
            else if (switch_on && main_power_) enter(State::switched_on);
            break;
        case State::switched_on:
            if (!voltage || quick) enter(State::disabled);
            else if (shutdown) enter(State::ready);
            else if (enable && main_power_ && mode_ == mode::none && codes_[DriveAlarmKind::mode_not_set].code)
                raise(codes_[DriveAlarmKind::mode_not_set]);
            else if (enable && main_power_ && starts_too_fast()) raise(codes_[DriveAlarmKind::start_too_fast]);
            else if (enable && main_power_) enter(State::enabled);
            break;
        case State::enabled:
            if (!voltage) enter(State::disabled);
            else if (quick) enter(State::quick_stop);
            else if (shutdown) enter(State::ready);
            else if (!enable) enter(State::switched_on);
            break;
        case State::quick_stop:
            if (!voltage) enter(State::disabled);
            else if (enable && stop_.then != StopThen::free) enter(State::enabled);
            break;
        case State::not_ready:
        case State::fault_reaction:
        case State::fault: break;
    }
}

}  // namespace taktwerk::axes::sim
