// Alarms: those that somebody provokes and those that the drive finds out by itself.

#include <algorithm>
#include <cmath>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

namespace {

constexpr Duration stall_time = std::chrono::milliseconds{200};  // at the torque limit without turning (SV33-E P08.18)

}  // namespace

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
        case Failure::overspeed: raise(codes_[DriveAlarmKind::overspeed]); break;
        case Failure::following_error: raise(codes_[DriveAlarmKind::following_error]); break;
        case Failure::undervoltage: raise(codes_[DriveAlarmKind::undervoltage]); break;
        case Failure::overload: raise(codes_[DriveAlarmKind::overload]); break;
        case Failure::communication: raise(codes_[DriveAlarmKind::communication]); break;
        case Failure::encoder:
            frozen_position_ = static_cast<std::int64_t>(quantised());
            encoder_failed_ = true;
            raise(codes_[DriveAlarmKind::encoder]);
            break;
    }
}

void Cia402Axis::main_power(bool on) noexcept {
    main_power_ = on;
    if (!on && (state_ == State::enabled || state_ == State::quick_stop)) raise(codes_[DriveAlarmKind::undervoltage]);
}

void Cia402Axis::communication_lost() noexcept {
    operational_ = false;
    if (state_ == State::enabled || state_ == State::quick_stop) raise(codes_[DriveAlarmKind::communication]);
    else if (state_ == State::ready || state_ == State::switched_on) enter(State::disabled);
}

/// TSVM 7.2, alarm 29.
void Cia402Axis::watch_torque() noexcept {
    const bool above = profile_->torque_overload > 0 && state_ == State::enabled &&
                       std::abs(torque_) > profile_->torque_overload * plant_.config().rated_torque;
    overload_lasts_ = above ? overload_lasts_ + inner_period : Duration{};
    if (above && overload_lasts_ > profile_->torque_overload_time && codes_[DriveAlarmKind::torque_overload].code)
        raise(codes_[DriveAlarmKind::torque_overload]);
}

void Cia402Axis::supervise() noexcept {
    watch_encoder();
    supervise_torque();
    if (state_ != State::enabled) return;
    if (motor_.overspeed > 0 && std::abs(seen_velocity()) > motor_.overspeed) raise(codes_[DriveAlarmKind::overspeed]);
    const bool follows_position = mode_ == mode::cyclic_position || mode_ == mode::homing || mode_ == mode::profile_position;
    if (state_ == State::enabled && following_limit_ > 0 && follows_position &&
        std::abs(demand_.position - seen_position()) > following_limit_)
        raise(codes_[DriveAlarmKind::following_error]);
}

void Cia402Axis::supervise_torque() noexcept {
    const double load = torque_ / plant_.config().rated_torque;
    heat_ = std::max(0.0, heat_ + (load * load - 1) * inner_seconds);
    // Twice the rated torque for `overload_seconds` gives 3 rated torques2 s a second above what the motor sheds.
    if (state_ == State::enabled && motor_.overload_seconds > 0 && heat_ > 3 * motor_.overload_seconds)
        raise(codes_[DriveAlarmKind::overload]);
    const bool stuck = std::abs(torque_) >= 0.999 * torque_limit() && stands();
    stalled_ = stuck ? stalled_ + inner_period : Duration{};
    if (state_ == State::enabled && codes_[DriveAlarmKind::stall].code && stalled_ >= stall_time) raise(codes_[DriveAlarmKind::stall]);
}

}  // namespace taktwerk::axes::sim
