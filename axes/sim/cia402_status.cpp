// What the drive answers: status word and actual values.

#include <cmath>

#include "axes/sim/cia402_axis.hpp"
#include "axes/sim/status_bit.hpp"

namespace taktwerk::axes::sim {

std::uint16_t Cia402Axis::status_word() const noexcept {
    if (state_ == State::not_ready) return 0;
    if (state_ == State::fault_reaction && has(Quirk::fault_reaction_02b6)) return 0x02B6;
    std::uint16_t word = 0;
    switch (state_) {
        case State::not_ready: word = 0x00; break;
        case State::disabled: word = 0x40; break;
        case State::ready: word = 0x21; break;
        case State::switched_on: word = 0x23; break;
        case State::enabled: word = 0x27; break;
        case State::quick_stop: word = 0x07; break;
        case State::fault_reaction: word = 0x0F; break;
        case State::fault: word = has(Quirk::fault_low_nibble_f) ? 0x0F : 0x08; break;
    }
    if (supply_.main_power) word |= status_bit(4);
    const bool faulted = state_ == State::fault_reaction || state_ == State::fault;
    if (has(Quirk::quick_stop_bit_rests_high) && (faulted || state_ == State::disabled)) word |= status_bit(5);
    if (faulted && has(Quirk::alarm_sets_warning_bit)) word |= status_bit(7);
    if (!has(Quirk::no_remote_bit) && (supply_.operational || (has(Quirk::remote_bit_from_preop) && supply_.reachable)))
        word |= status_bit(9);
    if (alarms_.warns() || origin_.battery_warns()) word |= status_bit(7);
    if (travel_.limited() && !has(Quirk::no_internal_limit_bit)) word |= status_bit(11);
    return static_cast<std::uint16_t>(word | mode_bits());
}

std::uint16_t Cia402Axis::mode_bits() const noexcept {
    if (mode_ == mode::profile_position || mode_ == mode::profile_velocity || mode_ == mode::profile_torque) return profile_bits();
    std::uint16_t word = 0;
    if (mode_ == mode::homing) {
        if (stands() && !homing_.busy()) word |= status_bit(10);
        if (homing_.attained()) word |= status_bit(12);
        if (homing_.failed()) word |= status_bit(13);
        return word;
    }
    const bool reports_target = !has(Quirk::cyclic_bit_10_reserved) || !mode::cyclic(mode_);
    if (reports_target && state_ == State::enabled && stands() && motor_.deviation() < 10) word |= status_bit(10);
    if (mode::cyclic(mode_) && !has(Quirk::csp_bits_12_13_reserved) && state_ == State::enabled) word |= status_bit(12);
    return word;
}

std::uint16_t Cia402Axis::profile_bits() const noexcept {
    std::uint16_t word = 0;
    if (window_.reached()) word |= status_bit(10);
    if (mode_ == mode::profile_position && profile_position_.acknowledges()) word |= status_bit(12);
    if (mode_ == mode::profile_velocity && !has(Quirk::pv_bits_12_13_reserved) && stands()) word |= status_bit(12);
    const double limit = motor_.motor().following_error_limit;
    if (mode_ == mode::profile_position && limit > 0 && motor_.deviation() > limit) word |= status_bit(13);
    return word;
}

void Cia402Axis::fill(AxisOutputs& out) const noexcept {
    out.status = status_word();
    out.mode = mode_;
    out.position = origin_.shown(counted());
    out.velocity = motor_.raw_velocity();
    out.torque = motor_.raw_torque();
    if (mode_changed_at_ && now_ - *mode_changed_at_ < profile_->mode_rules.indeterminate) {  // whatever lies there (TSVM 5.4.1 rule 3)
        out.mode = -86;
        out.velocity = ~out.velocity;
        out.torque = ~out.torque;
    }
    out.demand = static_cast<std::int64_t>(std::floor(motor_.demand().position - origin_.zero()));
    out.following_error = out.demand - out.position;
    const auto alarm = alarms_.answer(origin_.battery_warns() ? &codes_[DriveAlarmKind::battery_low] : nullptr);
    out.error_code = alarm.code;
    out.error_detail = alarm.detail;
    terminals_.fill(out);
}

}  // namespace taktwerk::axes::sim
