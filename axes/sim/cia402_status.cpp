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
    if (main_power_) word |= status_bit(4);
    const bool faulted = state_ == State::fault_reaction || state_ == State::fault;
    if (has(Quirk::quick_stop_bit_rests_high) && (faulted || state_ == State::disabled)) word |= status_bit(5);
    if (faulted && has(Quirk::alarm_sets_warning_bit)) word |= status_bit(7);
    if (!has(Quirk::no_remote_bit) && (operational_ || (has(Quirk::remote_bit_from_preop) && reachable_))) word |= status_bit(9);
    if (warning_ || battery_warns() || warnings_.any()) word |= status_bit(7);
    if (mode_ == mode::homing) {
        if (stands() && !homing_.busy()) word |= status_bit(10);
        if (homing_attained_) word |= status_bit(12);
        if (homing_error_) word |= status_bit(13);
    } else if (mode_ == mode::profile_position || mode_ == mode::profile_velocity || mode_ == mode::profile_torque) {
        word |= profile_bits();
    } else {
        const bool reports_target = !has(Quirk::cyclic_bit_10_reserved) || !mode::cyclic(mode_);
        if (reports_target && state_ == State::enabled && stands() && std::abs(demand_.position - seen_position()) < 10)
            word |= status_bit(10);
        if (mode::cyclic(mode_) && !has(Quirk::csp_bits_12_13_reserved) && state_ == State::enabled) word |= status_bit(12);
    }
    if (limited_ && !has(Quirk::no_internal_limit_bit)) word |= status_bit(11);
    return word;
}

std::uint16_t Cia402Axis::profile_bits() const noexcept {
    std::uint16_t word = 0;
    if (target_reached_) word |= status_bit(10);
    if (mode_ == mode::profile_position && profile_position_.acknowledges()) word |= status_bit(12);
    if (mode_ == mode::profile_velocity && !has(Quirk::pv_bits_12_13_reserved) && stands()) word |= status_bit(12);
    const double limit = motor_.following_error_limit;
    if (mode_ == mode::profile_position && limit > 0 && std::abs(demand_.position - seen_position()) > limit) word |= status_bit(13);
    return word;
}

void Cia402Axis::fill(AxisOutputs& out) const noexcept {
    out.status = status_word();
    out.mode = mode_;
    out.position = encoder_failed_ ? frozen_position_ : static_cast<std::int64_t>(quantised());
    out.velocity = std::llround(seen_velocity() * velocity_unit_);
    // Without an encoder nothing tells the drive what the load takes.
    out.torque = stepper_ ? 0 : std::llround(torque_ / plant_.config().rated_torque * profile_->torque_rated_raw);
    if (mode_changed_at_ && now_ - *mode_changed_at_ < profile_->mode_rules.indeterminate) {  // whatever lies there (TSVM 5.4.1 rule 3)
        out.mode = -86;
        out.velocity = ~out.velocity;
        out.torque = ~out.torque;
    }
    out.demand = static_cast<std::int64_t>(std::floor(demand_.position - zero_));
    out.following_error = out.demand - out.position;
    out.error_code = error_code_;
    out.error_detail = error_detail_;
    if (error_code_ == 0 && battery_warns()) {
        out.error_code = codes_[DriveAlarmKind::battery_low].code;
        out.error_detail = codes_[DriveAlarmKind::battery_low].detail;
    }
    if (error_code_ == 0 && warnings_.any()) {
        out.error_code = warnings_.shown().code;
        out.error_detail = warnings_.shown().detail;
    }
    for (std::size_t i = 0; i < probes_.size(); ++i) {
        out.probe_status = static_cast<std::uint16_t>(out.probe_status | probes_[i].status() << (8 * i));
        out.probe_rising[i] = probes_[i].rising();
        out.probe_falling[i] = probes_[i].falling();
    }
    const auto& seen = switches();
    out.digital_inputs = (seen.negative_limit ? 1u : 0u) | (seen.positive_limit ? 2u : 0u) | (seen.home ? 4u : 0u);
}

}  // namespace taktwerk::axes::sim
