// The power state machine of CiA 402-2: what the control word asks, what entering a state brings with it.

#include <algorithm>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

void Cia402Axis::power_on(Instant now) noexcept {
    now_ = now;
    mode_ = 0;
    last_control_ = 0;
    mode_changed_at_.reset();
    origin_.power_on();
    stop_.power_on();
    brake_.power_on(now);
    terminals_.power_on(plant());
    homing_.cancel();
    alarms_.power_on();
    load_.power_on();
    enter(State::not_ready);
    gate_.power_on(now + profile_->self_test);
    end_self_test();
}

/// TSVM 5.3.1, transitions 1 and 13: an error found while starting leads to Fault at once.
void Cia402Axis::end_self_test() noexcept {
    if (!gate_.starts(now_)) return;
    alarms_.start(now_);
    load_.start();
    enter(State::disabled);
    if (motor_.without_encoder()) motor_.demand({plant().position(), 0, 0});
    raise_or_warn(origin_.wake(plant().position()));
    show_causes();
}

void Cia402Axis::enter(State state) noexcept {
    const bool powered = state_ == State::enabled || state_ == State::quick_stop;
    if (state == State::enabled || state == State::not_ready || state == State::fault_reaction) stop_.wind_no_longer();
    else if (powered && state != State::quick_stop)
        wind_down(state == State::ready ? StopCause::shutdown : state == State::switched_on ? StopCause::disable : StopCause::off);
    if (state == State::enabled && state_ != State::enabled) {
        brake_.enabled(now_);
        gate_.open_at(now_ + std::max(profile_->brake.release, profile_->deaf_after_enable));
        motor_.demand_rest();
        forget_targets();
        cyclic_.enabled();
        motor_.forget_integral();
    }
    if (state != State::enabled) homing_.cancel();
    if (state != State::enabled) stop_.follow_again();
    if (state == State::enabled || state == State::not_ready) stop_.free_phases();
    if (state == State::quick_stop) begin_stop(stop_for(StopCause::quick_stop));
    if (state == State::fault_reaction) begin_stop(stop_for(StopCause::fault));
    state_ = state;
}

bool Cia402Axis::energised() const noexcept {
    return state_ == State::enabled || state_ == State::quick_stop || state_ == State::fault_reaction || stop_.winding_down();
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
            else if (switch_on && supply_.main_power) enter(State::switched_on);
            break;
        case State::switched_on:
            if (!voltage || quick) enter(State::disabled);
            else if (shutdown) enter(State::ready);
            else if (enable && supply_.main_power && mode_ == mode::none && codes_[DriveAlarmKind::mode_not_set].code)
                raise(codes_[DriveAlarmKind::mode_not_set]);
            else if (enable && supply_.main_power && motor_.too_fast_to_start()) raise(codes_[DriveAlarmKind::start_too_fast]);
            else if (enable && supply_.main_power) enter(State::enabled);
            break;
        case State::enabled:
            if (!voltage) enter(State::disabled);
            else if (quick) enter(State::quick_stop);
            else if (shutdown) enter(State::ready);
            else if (!enable) enter(State::switched_on);
            break;
        case State::quick_stop:
            if (!voltage) enter(State::disabled);
            else if (enable && stop_.order().then != StopThen::free) enter(State::enabled);
            break;
        case State::not_ready:
        case State::fault_reaction:
        case State::fault: break;
    }
}

}  // namespace taktwerk::axes::sim
