// Raw fields -> feedback, each cycle.

#include "axes/drives/cia402/cia402_drive.hpp"
#include "axes/drives/cia402/words.hpp"

namespace taktwerk::axes::cia402 {

const DriveFeedback& Cia402Drive::decode(Instant now) noexcept {
    const auto& health = place_.health();
    feedback_.fresh = health.fresh;
    feedback_.age = health.age;
    feedback_.online = health.al_state == ecat::AlState::op && !health.al_error;
    if (turns_.begun()) {
        ++feedback_.reference_epoch;
        ++feedback_.position_epoch;
    }
    settings_.online(feedback_.online);
    feedback_.setup_refused = settings_.verdict() == SettingsCheck::Verdict::refused;
    if (!feedback_.online) {
        homing_setup_.forget();
        turns_.note(PowerState::unknown);
        if (was_online_) ramps_.forget();
        was_online_ = false;
        position_.interrupt();
    }
    if (!health.fresh) return feedback_;

    const auto image = place_.bus().inputs();
    feedback_.latched = health.latched;
    const auto status = static_cast<std::uint16_t>(read_signal(image, in_.status));
    feedback_.status_word = status;
    feedback_.power = status_.power(status);
    if (feedback_.online) turns_.note(feedback_.power);
    enabled_.store(feedback_.power == PowerState::enabled, std::memory_order_relaxed);
    feedback_.fault = (status & bit_fault) != 0;
    feedback_.warning = (status & bit_warning) != 0 && !feedback_.fault;  // TSVM 5.3.2: bit 7 stands with faults, too
    feedback_.main_power = (status & bit_voltage) != 0;
    feedback_.target_reached = (status & bit_target_reached) != 0;
    feedback_.internal_limit = (status & bit_internal_limit) != 0 && !profile_->has(Quirk::no_internal_limit_bit);
    feedback_.error_code = static_cast<std::uint16_t>(read_signal(image, in_.error));

    // While a drive changes its mode, 6061h and what belongs to the mode may be anything (TSVM 5.4.1).
    if (mode_.valid(health.latched)) {
        feedback_.mode = own_.fixed ? *own_.fixed : mode_of(read_signal(image, in_.mode));
        decode_motion();
    } else {
        feedback_.mode = DriveMode::none;
    }
    feedback_.follows_target = !capabilities_.reports_following || feedback_.power != PowerState::enabled || !is_cyclic(feedback_.mode) ||
                               (status & bit_follows_target) != 0;
    decode_homing(status, now);
    if (capabilities_.digital_inputs) {
        const auto inputs = static_cast<std::uint32_t>(read_signal(image, in_.digital));
        feedback_.digital_inputs = inputs;
        feedback_.negative_limit = ((inputs >> profile_->input_bit_negative_limit) & 1u) != 0;
        feedback_.positive_limit = ((inputs >> profile_->input_bit_positive_limit) & 1u) != 0;
        feedback_.home_switch = ((inputs >> profile_->input_bit_home) & 1u) != 0;
    }
    if (capabilities_.probes > 0) decode_probes();
    const bool alarm = feedback_.fault || feedback_.power == PowerState::unknown || (feedback_.warning && feedback_.error_code != 0);
    alarm_.note(alarm, feedback_.error_code, !feedback_.fault && feedback_.power != PowerState::unknown);
    return feedback_;
}

void Cia402Drive::decode_motion() noexcept {
    const auto image = place_.bus().inputs();
    const bool returned = feedback_.online && !was_online_;
    if (returned) {
        was_online_ = true;
        position_.interrupt();
        if (position_.seeded()) ++feedback_.position_epoch;
    }
    const auto before = feedback_.position;
    const auto raw = read_signal(image, in_.position);
    feedback_.position = position_.position(raw, in_.position.bits);
    // Only what a drive in OP says moves the anchor: one that restarts may show zeros for a while.
    if (feedback_.online) position_.anchor(feedback_.position, raw);

    if (in_.velocity.mapped()) {
        feedback_.velocity = static_cast<double>(read_signal(image, in_.velocity)) / settings_.velocity_counts_per_unit();
    } else if (position_.before() == Instant{}) {
        feedback_.velocity = 0;
    } else if (feedback_.latched > position_.before()) {
        feedback_.velocity = static_cast<double>(feedback_.position - before) / to_seconds(feedback_.latched - position_.before());
    }
    position_.counted(feedback_.online ? feedback_.latched : Instant{});
    feedback_.torque = static_cast<double>(read_signal(image, in_.torque)) / profile_->torque_rated_raw;
}

void Cia402Drive::decode_homing(std::uint16_t status, Instant now) noexcept {
    const bool attained_before = feedback_.homing_attained;
    feedback_.homing_attained = feedback_.homing_error = false;
    if (feedback_.mode != DriveMode::homing) return;
    const auto bits = homing_.read(status, now);
    feedback_.homing_error = bits.error;
    feedback_.homing_attained = bits.attained;
    if (feedback_.homing_attained && !attained_before) {
        ++feedback_.position_epoch;
        position_.interrupt();
    }
}

void Cia402Drive::decode_probes() noexcept {
    const auto image = place_.bus().inputs();
    const auto status = static_cast<std::uint16_t>(read_signal(image, in_.probe_status));
    for (std::size_t probe = 0; probe < capabilities_.probes; ++probe) {
        auto& latch = probes_[probe];
        const auto raw = read_signal(image, in_.probe_position[probe][latch.rising() ? 0 : 1]);
        // The latch is a raw position like 6064h: it lies next to the unwrapped actual position.
        if (latch.take(static_cast<std::uint8_t>(status >> (8 * probe)), raw, feedback_.probes[probe]))
            feedback_.probes[probe].position = feedback_.position + position_.beside(raw, in_.position.bits);
    }
}

}  // namespace taktwerk::axes::cia402
