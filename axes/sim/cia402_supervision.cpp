// Alarms: those that somebody provokes and those that the drive finds out by itself.

#include <algorithm>
#include <cmath>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

void Cia402Axis::raise(std::uint16_t code, bool resettable, std::uint32_t detail) noexcept {
    if (state_ == State::fault || state_ == State::fault_reaction) return;  // the first alarm is the one shown
    error_code_ = code;
    error_detail_ = detail;
    error_resettable_ = resettable;
    remember({code, resettable, detail});
    enter(energised() ? State::fault_reaction : State::fault);
}

void Cia402Axis::raise_or_warn(const AlarmCode& alarm) noexcept {
    if (alarm.code == 0) return;
    if (!alarm.warning) return raise(alarm);
    warning_ = true;
    error_code_ = alarm.code;
    error_detail_ = alarm.detail;
}

void Cia402Axis::end_warning() noexcept {
    if (!warning_) return;
    warning_ = false;
    error_code_ = 0;
    error_detail_ = 0;
}

void Cia402Axis::fail(Failure failure) noexcept {
    switch (failure) {
        case Failure::overspeed: raise(personality_.overspeed_alarm); break;
        case Failure::following_error: raise(personality_.following_error_alarm); break;
        case Failure::undervoltage: raise(personality_.undervoltage_alarm); break;
        case Failure::overload: raise(personality_.overload_alarm); break;
        case Failure::communication: raise(personality_.communication_alarm); break;
        case Failure::encoder:
            frozen_position_ = static_cast<std::int64_t>(quantised());
            encoder_failed_ = true;
            raise(personality_.encoder_alarm);
            break;
    }
}

void Cia402Axis::main_power(bool on) noexcept {
    main_power_ = on;
    if (!on && (state_ == State::enabled || state_ == State::quick_stop)) raise(personality_.undervoltage_alarm);
}

void Cia402Axis::communication_lost() noexcept {
    operational_ = false;
    if (state_ == State::enabled || state_ == State::quick_stop) raise(personality_.communication_alarm);
    else if (state_ == State::ready || state_ == State::switched_on) enter(State::disabled);
}

/// TSVM 7.2, alarm 29.
void Cia402Axis::watch_torque() noexcept {
    const bool above = personality_.torque_overload > 0 && state_ == State::enabled &&
                       std::abs(torque_) > personality_.torque_overload * plant_.config().rated_torque;
    overload_lasts_ = above ? overload_lasts_ + inner_period : Duration{};
    if (above && overload_lasts_ > personality_.torque_overload_time && personality_.torque_overload_alarm.code)
        raise(personality_.torque_overload_alarm);
}

void Cia402Axis::supervise() noexcept {
    watch_encoder();
    supervise_torque();
    if (state_ != State::enabled) return;
    if (personality_.overspeed > 0 && std::abs(seen_velocity()) > personality_.overspeed) raise(personality_.overspeed_alarm);
    const bool follows_position = mode_ == mode::cyclic_position || mode_ == mode::homing || mode_ == mode::profile_position;
    if (state_ == State::enabled && following_limit_ > 0 && follows_position &&
        std::abs(demand_.position - seen_position()) > following_limit_)
        raise(personality_.following_error_alarm);
}

void Cia402Axis::supervise_torque() noexcept {
    const double load = torque_ / plant_.config().rated_torque;
    heat_ = std::max(0.0, heat_ + (load * load - 1) * inner_seconds);
    // Twice the rated torque for `overload_seconds` gives 3 rated torques2 s a second above what the motor sheds.
    if (state_ == State::enabled && personality_.overload_seconds > 0 && heat_ > 3 * personality_.overload_seconds)
        raise(personality_.overload_alarm);
    const bool stuck = std::abs(torque_) >= 0.999 * torque_limit() && stands();
    stalled_ = stuck ? stalled_ + inner_period : Duration{};
    if (state_ == State::enabled && personality_.stall_time > Duration::zero() && stalled_ >= personality_.stall_time)
        raise(personality_.stall_alarm);
}

}  // namespace taktwerk::axes::sim
