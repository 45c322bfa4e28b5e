// Raw fields -> feedback, each cycle.

#include "axes/drives/cia402/cia402_drive.hpp"
#include "axes/drives/cia402/words.hpp"

namespace taktwerk::axes::cia402 {

namespace {

// Attained bits count only after the drive has shown that it took the new start, or after this long: methods such as 35 are over
// before a frame has passed.
constexpr Duration homing_settle = std::chrono::milliseconds{50};

/// a - b modulo 2^bits, sign-extended: a raw position may wrap between two samples.
std::int64_t difference(std::int64_t a, std::int64_t b, unsigned bits) noexcept {
    const unsigned unused = 64u - bits;
    const auto wide = static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b);
    return static_cast<std::int64_t>(wide << unused) >> unused;
}

}  // namespace

const DriveFeedback& Cia402Drive::decode(Instant now) noexcept {
    const auto& health = bus_.health(slave_);
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
        position_at_ = {};
    }
    if (!health.fresh) return feedback_;

    const auto image = bus_.inputs();
    feedback_.latched = health.latched;
    const auto status = static_cast<std::uint16_t>(read_signal(image, in_.status));
    feedback_.status_word = status;
    feedback_.power = power_state(status, fault_quirk_);
    if (feedback_.online) turns_.note(feedback_.power);
    enabled_.store(feedback_.power == PowerState::enabled, std::memory_order_relaxed);
    feedback_.fault = (status & bit_fault) != 0;
    feedback_.warning = (status & bit_warning) != 0 && !feedback_.fault;  // TSVM 5.3.2: bit 7 stands with faults, too
    feedback_.main_power = (status & bit_voltage) != 0;
    feedback_.target_reached = (status & bit_target_reached) != 0;
    feedback_.internal_limit = (status & bit_internal_limit) != 0 && !profile_->has(Quirk::no_internal_limit_bit);
    feedback_.error_code = static_cast<std::uint16_t>(read_signal(image, in_.error));

    // While a drive changes its mode, 6061h and what belongs to the mode may be anything (TSVM 5.4.1).
    if (health.latched >= mode_means_something_from_) {
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
    const auto image = bus_.inputs();
    const bool returned = feedback_.online && !was_online_;
    if (returned) {
        was_online_ = true;
        position_at_ = {};
        if (position_seeded_) ++feedback_.position_epoch;
    }
    const auto before = feedback_.position;
    const auto raw = read_signal(image, in_.position);
    feedback_.position = position_seeded_ ? anchor_ + difference(raw, anchor_raw_, in_.position.bits) : raw;
    // Only what a drive in OP says moves the anchor: one that restarts may show zeros for a while.
    if (feedback_.online) {
        anchor_ = feedback_.position;
        anchor_raw_ = raw;
        position_seeded_ = true;
    }

    if (in_.velocity.mapped()) {
        feedback_.velocity = static_cast<double>(read_signal(image, in_.velocity)) / settings_.velocity_counts_per_unit();
    } else if (position_at_ == Instant{}) {
        feedback_.velocity = 0;
    } else if (feedback_.latched > position_at_) {
        feedback_.velocity = static_cast<double>(feedback_.position - before) / to_seconds(feedback_.latched - position_at_);
    }
    position_at_ = feedback_.online ? feedback_.latched : Instant{};
    feedback_.torque = static_cast<double>(read_signal(image, in_.torque)) / profile_->torque_rated_raw;
}

void Cia402Drive::decode_homing(std::uint16_t status, Instant now) noexcept {
    const bool attained_before = feedback_.homing_attained;
    feedback_.homing_attained = feedback_.homing_error = false;
    if (!homing_since_ || feedback_.mode != DriveMode::homing) return;
    const bool attained = (status & bit_homing_attained) != 0;
    const bool error = (status & bit_homing_error) != 0;
    if (!attained && !error) homing_cleared_ = true;
    if (!homing_cleared_ && now - *homing_since_ < homing_settle) return;
    feedback_.homing_error = error;
    feedback_.homing_attained = attained && !error && (status & bit_target_reached) != 0;
    if (feedback_.homing_attained && !attained_before) {
        ++feedback_.position_epoch;
        position_at_ = {};
    }
}

void Cia402Drive::decode_probes() noexcept {
    const auto image = bus_.inputs();
    const auto status = static_cast<std::uint16_t>(read_signal(image, in_.probe_status));
    for (std::size_t probe = 0; probe < capabilities_.probes; ++probe) {
        auto& latch = probes_[probe];
        const auto raw = read_signal(image, in_.probe_position[probe][latch.rising() ? 0 : 1]);
        // The latch is a raw position like 6064h: it lies next to the unwrapped actual position.
        if (latch.take(static_cast<std::uint8_t>(status >> (8 * probe)), raw, feedback_.probes[probe]))
            feedback_.probes[probe].position = feedback_.position + difference(raw, anchor_raw_, in_.position.bits);
    }
}

}  // namespace taktwerk::axes::cia402
