// Alarms: those that somebody provokes and those that the drive finds out by itself.

#include <cmath>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

void Cia402Axis::raise(std::uint16_t code, bool resettable, std::uint32_t detail) noexcept {
    if (state_ == State::fault || state_ == State::fault_reaction) return;  // the first alarm is the one shown
    alarms_.show({code, resettable, detail}, now_, plant().velocity());
    enter(energised() ? State::fault_reaction : State::fault);
}

void Cia402Axis::raise_or_warn(const AlarmCode& alarm) noexcept {
    if (alarm.code == 0) return;
    if (alarm.warning) alarms_.warn(alarm);
    else raise(alarm);
}

/// Nothing where this drive has no such alarm.
void Cia402Axis::raise_if_known(DriveAlarmKind kind) noexcept {
    if (codes_[kind].code) raise(codes_[kind]);
}

/// An alarm of the whole drive; a fault that the axis found out by itself stands behind it.
void Cia402Axis::raise_common(const AlarmCode& alarm) noexcept {
    if (state_ == State::fault || state_ == State::fault_reaction) return alarms_.cover(alarm);
    raise(alarm);
    alarms_.belongs_to_all();
}

void Cia402Axis::fail(Failure failure) noexcept {
    switch (failure) {
        case Failure::overspeed: raise(codes_[DriveAlarmKind::overspeed]); break;
        case Failure::following_error: raise(codes_[DriveAlarmKind::following_error]); break;
        case Failure::undervoltage: raise(codes_[DriveAlarmKind::undervoltage]); break;
        case Failure::overload: raise(codes_[DriveAlarmKind::overload]); break;
        case Failure::communication: raise(codes_[DriveAlarmKind::communication]); break;
        case Failure::encoder:
            origin_.fail(counted());
            raise(codes_[DriveAlarmKind::encoder]);
            break;
    }
}

void Cia402Axis::main_power(bool on) noexcept {
    supply_.main_power = on;
    if (!on && (state_ == State::enabled || state_ == State::quick_stop)) raise(codes_[DriveAlarmKind::undervoltage]);
}

void Cia402Axis::left_operational() noexcept {
    if (state_ == State::enabled || state_ == State::quick_stop) raise_if_known(DriveAlarmKind::left_operational);
    communication_lost();
}

void Cia402Axis::communication_lost() noexcept {
    supply_.operational = false;
    if (state_ == State::enabled || state_ == State::quick_stop) raise(codes_[DriveAlarmKind::communication]);
    else if (state_ == State::ready || state_ == State::switched_on) enter(State::disabled);
}

/// counts; 0: no check. 6065h.
double Cia402Axis::following_limit() const noexcept {
    constexpr std::int64_t no_check = 0xFFFFFFFF;  // CiA 402-2
    const auto window = settings_.following_error_window;
    return window == 0 ? motor_.motor().following_error_limit : window == no_check ? 0 : static_cast<double>(window);
}

void Cia402Axis::supervise() noexcept {
    supervise_encoder();
    supervise_load();
    const double overspeed = motor_.motor().overspeed, limit = following_limit();
    if (state_ == State::enabled && overspeed > 0 && std::abs(motor_.velocity()) > overspeed) raise(codes_[DriveAlarmKind::overspeed]);
    const bool follows_position = mode_ == mode::cyclic_position || mode_ == mode::homing || mode_ == mode::profile_position;
    if (state_ == State::enabled && limit > 0 && follows_position && motor_.deviation() > limit)
        raise(codes_[DriveAlarmKind::following_error]);
    const bool high = profile_->torque_overload > 0 && state_ == State::enabled &&
                      std::abs(motor_.torque()) > profile_->torque_overload * plant().config().rated_torque;
    if (load_.high_too_long(high, profile_->torque_overload_time)) raise_if_known(DriveAlarmKind::torque_overload);
}

void Cia402Axis::supervise_encoder() noexcept {
    if (origin_.battery_stops() && state_ != State::not_ready) raise(codes_[DriveAlarmKind::battery_low]);
    raise_or_warn(origin_.watch(plant().position()));
}

void Cia402Axis::supervise_load() noexcept {
    load_.step(motor_.load(), std::abs(motor_.torque()) >= 0.999 * motor_.torque_limit() && stands());
    if (state_ == State::enabled && load_.hot(motor_.motor().overload_seconds)) raise(codes_[DriveAlarmKind::overload]);
    if (state_ == State::enabled && load_.stalled()) raise_if_known(DriveAlarmKind::stall);
}

void Cia402Axis::reset_encoder() noexcept {
    if (!energised() && origin_.reset(plant().position())) cause(DriveAlarmKind::reference_lost, false);
}

void Cia402Axis::clear_turns() noexcept {
    if (energised() || !origin_.clear_turns(plant().position())) return;
    cause(DriveAlarmKind::reference_lost, false);
    cause(DriveAlarmKind::turn_overflow, false);
}

void Cia402Axis::order_encoder_reset() noexcept {
    if (!energised()) origin_.order_reset();
}

}  // namespace taktwerk::axes::sim
