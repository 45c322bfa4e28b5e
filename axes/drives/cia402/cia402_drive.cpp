#include "axes/drives/cia402/cia402_drive.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "axes/drives/cia402/words.hpp"
#include "core/bytes.hpp"

namespace taktwerk::axes::cia402 {

namespace {

// A reset edge is held this long, then taken back as long, then tried again while it is still asked for. TSVM and SV33-E
// ignore every other command while bit 7 stands.
constexpr std::uint32_t reset_low_cycles = 4;
constexpr std::uint32_t reset_high_cycles = 4;
constexpr std::uint32_t reset_wait_cycles = 100;

// Attained bits count only after the drive has shown that it took the new start.
constexpr std::uint32_t homing_settle_cycles = 20;

std::int64_t saturate(double value, const Signal& signal) noexcept {
    const double top = std::ldexp(1.0, signal.bits - (signal.is_signed ? 1 : 0)) - 1.0;
    const double bottom = signal.is_signed ? -top - 1.0 : 0.0;
    if (!(value > bottom)) return static_cast<std::int64_t>(bottom);  // also NaN
    if (value >= top) return static_cast<std::int64_t>(top);
    return static_cast<std::int64_t>(value < 0 ? value - 0.5 : value + 0.5);
}

}  // namespace

Cia402Drive::Cia402Drive(ecat::Master& bus, std::size_t slave, std::uint8_t axis, std::shared_ptr<const DriveProfile> profile,
                         Duration cycle)
    : bus_(bus), slave_(slave), axis_(axis), profile_(std::move(profile)),
      interpolation_(profile_->csp_interpolates ? cycle : Duration{}), fault_quirk_(profile_->has(Quirk::fault_low_nibble_f)) {
    auto& c = capabilities_;
    for (const auto mode : profile_->modes) c.modes = static_cast<std::uint16_t>(c.modes | (1u << static_cast<unsigned>(mode)));
    c.drive_homing = !profile_->homing_methods.empty() && c.has(DriveMode::homing);
    c.motor_has_encoder = profile_->motor_has_encoder;
    c.position_bits = profile_->position_bits;
    c.minimum_cycle = profile_->minimum_cycle_csp;
    c.enable_delay = profile_->enable_delay;
    c.mode_change_delay = profile_->mode_change_delay;
    c.mode_change_at_standstill = profile_->mode_change_at_standstill;
}

std::uint16_t Cia402Drive::object(std::uint16_t base) const noexcept {
    return static_cast<std::uint16_t>(base + axis_ * profile_->object_offset);
}

Result<void> Cia402Drive::resolve() {
    const auto missing = [&](std::uint16_t index, const char* what, const char* pdo) {
        return Error{"drive.not_mapped", fmt::format("slave '{}' axis {}", bus_.slave(slave_).name, axis_ + 1),
                     fmt::format("object {:04X}h ({}) is not in its {}", object(index), what, pdo),
                     fmt::format("add {:04X}h to the slave's `pdo.{}` list (see docs/drives.md)", object(index), pdo[0] == 'R' ? "rx" : "tx")};
    };
    const auto output = [&](Signal& signal, std::uint16_t index, std::uint8_t sub, bool is_signed) {
        if (!bus_.maps_output(slave_, object(index), sub)) return false;
        auto found = bus_.output(slave_, object(index), sub);
        if (!found) return false;
        signal = *found;
        signal.is_signed = is_signed;
        return true;
    };
    const auto input = [&](Signal& signal, std::uint16_t index, std::uint8_t sub, bool is_signed) {
        if (!bus_.maps_input(slave_, object(index), sub)) return false;
        auto found = bus_.input(slave_, object(index), sub);
        if (!found) return false;
        signal = *found;
        signal.is_signed = is_signed;
        return true;
    };

    if (!output(out_.control, 0x6040, 0, false)) return missing(0x6040, "controlword", "RxPDO");
    if (!output(out_.mode, 0x6060, 0, true)) return missing(0x6060, "modes of operation", "RxPDO");
    if (capabilities_.has(DriveMode::cyclic_position) && !output(out_.target_position, 0x607A, 0, true))
        return missing(0x607A, "target position", "RxPDO");
    if (!input(in_.status, 0x6041, 0, false)) return missing(0x6041, "statusword", "TxPDO");
    if (!input(in_.mode, 0x6061, 0, true)) return missing(0x6061, "modes of operation display", "TxPDO");
    if (!input(in_.position, 0x6064, 0, true)) return missing(0x6064, "position actual value", "TxPDO");

    output(out_.target_velocity, 0x60FF, 0, true);
    output(out_.target_torque, 0x6071, 0, true);
    capabilities_.velocity_feed_forward = output(out_.velocity_offset, 0x60B1, 0, true);
    capabilities_.torque_feed_forward = output(out_.torque_offset, 0x60B2, 0, true);
    const bool max = output(out_.torque_max, 0x6072, 0, false);
    const bool pair = output(out_.torque_positive, 0x60E0, 0, false) && output(out_.torque_negative, 0x60E1, 0, false);
    capabilities_.torque_limits = max || pair;
    capabilities_.digital_outputs = output(out_.digital, 0x60FE, 1, false);
    const bool probe_function = output(out_.probe_function, 0x60B8, 0, false);
    // In the SE-808X default image these are cyclic: zeros there would override the SDO values (sheet 9.1 item 3).
    output(out_.profile_velocity, 0x6081, 0, false);
    output(out_.profile_acceleration, 0x6083, 0, false);
    output(out_.profile_deceleration, 0x6084, 0, false);

    input(in_.velocity, 0x606C, 0, true);
    input(in_.torque, 0x6077, 0, true);
    input(in_.error, 0x603F, 0, false);
    capabilities_.digital_inputs = input(in_.digital, 0x60FD, 0, false);
    if (probe_function && input(in_.probe_status, 0x60B9, 0, false)) {
        static constexpr std::uint16_t positions[2][2] = {{0x60BA, 0x60BB}, {0x60BC, 0x60BD}};
        for (std::size_t probe = 0; probe < 2; ++probe) {
            const bool rising = input(in_.probe_position[probe][0], positions[probe][0], 0, true);
            const bool falling = input(in_.probe_position[probe][1], positions[probe][1], 0, true);
            if ((rising || falling) && probe < profile_->probes) capabilities_.probes = static_cast<std::uint8_t>(probe + 1);
        }
    }
    feedback_.has_inputs = capabilities_.digital_inputs;
    return {};
}

const DriveFeedback& Cia402Drive::decode(Instant now) noexcept {
    const auto& health = bus_.health(slave_);
    feedback_.fresh = health.fresh;
    feedback_.age = health.age;
    feedback_.online = health.al_state == ecat::AlState::op && !health.al_error;
    if (!health.fresh) return feedback_;

    const auto image = bus_.inputs();
    feedback_.latched = health.latched;
    const auto status = static_cast<std::uint16_t>(read_signal(image, in_.status));
    feedback_.status_word = status;
    feedback_.power = power_state(status, fault_quirk_);
    feedback_.fault = (status & bit_fault) != 0;
    feedback_.warning = (status & bit_warning) != 0;
    feedback_.main_power = (status & bit_voltage) != 0;
    feedback_.target_reached = (status & bit_target_reached) != 0;
    feedback_.internal_limit = (status & bit_internal_limit) != 0 && !profile_->has(Quirk::no_internal_limit_bit);
    feedback_.mode = mode_of(read_signal(image, in_.mode));
    feedback_.error_code = static_cast<std::uint16_t>(read_signal(image, in_.error));
    feedback_.torque = static_cast<double>(read_signal(image, in_.torque)) / profile_->torque_rated_raw;

    decode_position(now);
    decode_homing(status);
    if (capabilities_.digital_inputs) {
        const auto inputs = static_cast<std::uint32_t>(read_signal(image, in_.digital));
        feedback_.digital_inputs = inputs;
        feedback_.negative_limit = ((inputs >> profile_->input_bit_negative_limit) & 1u) != 0;
        feedback_.positive_limit = ((inputs >> profile_->input_bit_positive_limit) & 1u) != 0;
        feedback_.home_switch = ((inputs >> profile_->input_bit_home) & 1u) != 0;
    }
    if (capabilities_.probes > 0) decode_probes();
    note_alarm();
    return feedback_;
}

void Cia402Drive::decode_position(Instant now) noexcept {
    const auto image = bus_.inputs();
    const std::int64_t raw = read_signal(image, in_.position);
    std::int64_t step = 0;
    if (position_known_) {
        // Difference modulo 2^bits, sign-extended: a 32-bit position may wrap.
        const unsigned unused = 64u - in_.position.bits;
        step = static_cast<std::int64_t>(static_cast<std::uint64_t>(raw - raw_position_) << unused) >> unused;
        feedback_.position += step;
    } else {
        feedback_.position = raw;
        position_known_ = true;
    }
    raw_position_ = raw;
    const Instant at = feedback_.latched;
    if (in_.velocity.mapped()) {
        feedback_.velocity = static_cast<double>(read_signal(image, in_.velocity)) / profile_->velocity_counts_per_unit;
    } else if (at > position_at_ && position_at_ != Instant{}) {
        feedback_.velocity = static_cast<double>(step) / to_seconds(at - position_at_);
    }
    position_at_ = at != Instant{} ? at : now;
}

void Cia402Drive::decode_homing(std::uint16_t status) noexcept {
    feedback_.homing_attained = feedback_.homing_error = false;
    if (homing_cycles_ == 0 || feedback_.mode != DriveMode::homing) return;
    ++homing_cycles_;
    const bool attained = (status & bit_homing_attained) != 0;
    const bool error = (status & bit_homing_error) != 0;
    if (!attained && !error) homing_cleared_ = true;
    if (!homing_cleared_ && homing_cycles_ < homing_settle_cycles) return;
    feedback_.homing_error = error;
    feedback_.homing_attained = attained && !error && (status & bit_target_reached) != 0;
}

void Cia402Drive::decode_probes() noexcept {
    const auto image = bus_.inputs();
    const auto status = static_cast<std::uint16_t>(read_signal(image, in_.probe_status));
    for (std::size_t probe = 0; probe < capabilities_.probes; ++probe) {
        const unsigned bits = status >> (8 * probe);
        const bool rising = (bits & 2u) != 0, falling = (bits & 4u) != 0;
        auto& out = feedback_.probes[probe];
        const bool latched = rising || falling;
        if (latched && !out.latched) ++out.count;
        if (!(bits & 1u)) out.count = 0;
        out.latched = latched;
        if (!latched) continue;
        const Signal& signal = in_.probe_position[probe][rising ? 0 : 1];
        const std::int64_t raw = read_signal(image, signal);
        // The latch is a raw position like 6064h: place it next to the unwrapped actual position.
        const unsigned unused = 64u - in_.position.bits;
        const auto away = static_cast<std::int64_t>(static_cast<std::uint64_t>(raw - raw_position_) << unused) >> unused;
        out.position = feedback_.position + away;
    }
}

void Cia402Drive::note_alarm() noexcept {
    const bool present = feedback_.fault || feedback_.power == PowerState::unknown || (feedback_.warning && feedback_.error_code != 0);
    if (!present) {
        alarm_ = DriveAlarm{};
        detail_wanted_.store(0, std::memory_order_relaxed);
        return;
    }
    const auto answer = detail_answer_.load(std::memory_order_acquire);
    const bool detail_new = !alarm_.detail_known && profile_->alarm_detail_index != 0 && answer != 0 &&
                            static_cast<std::uint16_t>(answer >> 32) == feedback_.error_code;
    if (alarm_.code == feedback_.error_code && alarm_.code != 0 && !detail_new) return;
    alarm_.code = feedback_.error_code;
    alarm_.detail_known = detail_new;
    alarm_.detail = detail_new ? static_cast<std::uint32_t>(answer) : 0;
    alarm_.entry = -1;
    alarm_.resettable = true;
    // Only when the alarm changes; the table is bounded (a few hundred rows).
    for (std::size_t i = 0; i < profile_->alarms.size(); ++i) {
        const auto& row = profile_->alarms[i];
        if (row.code != alarm_.code) continue;
        const bool exact = alarm_.detail_known && row.detail == alarm_.detail;
        if (alarm_.entry < 0 || exact) {
            alarm_.entry = static_cast<std::int32_t>(i);
            alarm_.resettable = row.resettable;
        }
        if (exact) break;
    }
    if (profile_->alarm_detail_index != 0 && !detail_new) detail_wanted_.store(alarm_.code, std::memory_order_release);
}

DriveAlarm Cia402Drive::alarm() const noexcept { return alarm_; }

void Cia402Drive::step(Instant) {
    if (profile_->alarm_detail_index == 0) return;
    const auto wanted = detail_wanted_.load(std::memory_order_acquire);
    if (detail_ticket_ == 0) {
        if (wanted == 0) {
            detail_asked_ = 0;
            detail_answer_.store(0, std::memory_order_release);
            return;
        }
        if (wanted == detail_asked_) return;
        detail_asked_ = wanted;
        detail_ticket_ = bus_.upload(slave_, profile_->alarm_detail_index, profile_->alarm_detail_sub);
        return;
    }
    auto answer = bus_.poll(detail_ticket_);
    if (!answer) return;
    detail_ticket_ = 0;
    if (!answer->ok()) return;  // the plain code stays: a drive that cannot answer is no second fault
    std::uint32_t detail = 0;
    const auto& data = answer->value().data;
    for (std::size_t i = 0; i < std::min<std::size_t>(4, data.size()); ++i) detail |= static_cast<std::uint32_t>(data[i]) << (8 * i);
    detail_answer_.store((static_cast<std::uint64_t>(detail_asked_) << 32) | detail, std::memory_order_release);
}

Instant Cia402Drive::setpoint_effective(Instant send_time) const noexcept {
    return bus_.outputs_effective(slave_, send_time) + interpolation_;
}

std::uint16_t Cia402Drive::fault_reset_word() noexcept {
    const auto phase = reset_cycle_++ % (reset_low_cycles + reset_high_cycles + reset_wait_cycles);
    return phase >= reset_low_cycles && phase < reset_low_cycles + reset_high_cycles ? fault_reset : disable_voltage;
}

std::uint16_t Cia402Drive::control_word(const DriveCommand& command, bool mode_confirmed) noexcept {
    const bool faulted = feedback_.fault || feedback_.power == PowerState::unknown;
    if (command.reset_fault && faulted) return fault_reset_word();
    reset_cycle_ = 0;
    if (faulted) return disable_voltage;

    switch (command.power) {
        case PowerRequest::off: return towards_off(feedback_.power);
        case PowerRequest::quick_stop:
            return feedback_.power == PowerState::enabled || feedback_.power == PowerState::quick_stop ? quick_stop : towards_off(feedback_.power);
        case PowerRequest::on: break;
    }
    std::uint16_t word = towards_enabled(feedback_.power, mode_confirmed);
    if (feedback_.power == PowerState::enabled) {
        if (command.mode == DriveMode::homing && mode_confirmed && command.start_homing) word |= homing_start;
        if (command.halt) word |= halt;
    }
    return word;
}

void Cia402Drive::encode(const DriveCommand& command, Instant) noexcept {
    const auto image = bus_.outputs();
    const bool mode_confirmed = feedback_.mode == command.mode;
    const auto word = control_word(command, mode_confirmed);
    const bool homing_runs = (word & homing_start) != 0 && command.mode == DriveMode::homing;
    if (!homing_runs) {
        homing_cycles_ = 0;
        homing_cleared_ = false;
    } else if (homing_cycles_ == 0) {
        homing_cycles_ = 1;
    }
    write_signal(image, out_.control, word);
    write_signal(image, out_.mode, mode_code(command.mode));

    // Until the drive follows in this mode its target is its own actual position: enabling and mode switches never step.
    const bool follows = feedback_.power == PowerState::enabled && mode_confirmed && command.power == PowerRequest::on;
    const bool position_mode = command.mode == DriveMode::cyclic_position || command.mode == DriveMode::profile_position;
    write_signal(image, out_.target_position, follows && position_mode ? command.position : feedback_.position);
    const double velocity = follows ? command.velocity : 0.0;
    const bool velocity_mode = command.mode == DriveMode::cyclic_velocity || command.mode == DriveMode::profile_velocity;
    write_signal(image, out_.target_velocity,
                 velocity_mode ? saturate(velocity * profile_->velocity_counts_per_unit, out_.target_velocity) : 0);
    write_signal(image, out_.velocity_offset,
                 position_mode ? saturate(velocity * profile_->velocity_counts_per_unit, out_.velocity_offset) : 0);
    const double torque = follows ? command.torque * profile_->torque_rated_raw : 0.0;
    const bool torque_mode = command.mode == DriveMode::cyclic_torque || command.mode == DriveMode::profile_torque;
    write_signal(image, out_.target_torque, torque_mode ? saturate(torque, out_.target_torque) : 0);
    write_signal(image, out_.torque_offset, torque_mode ? 0 : saturate(torque, out_.torque_offset));
    // A mapped torque limit of zero would block the drive (SV-DA200 sheet 9 item 12): infinity saturates to the top.
    write_signal(image, out_.torque_positive, saturate(command.torque_limit_positive * profile_->torque_rated_raw, out_.torque_positive));
    write_signal(image, out_.torque_negative, saturate(command.torque_limit_negative * profile_->torque_rated_raw, out_.torque_negative));
    write_signal(image, out_.torque_max,
                 saturate(std::min(command.torque_limit_positive, command.torque_limit_negative) * profile_->torque_rated_raw, out_.torque_max));
    if (command.acceleration > 0) write_signal(image, out_.profile_acceleration, saturate(command.acceleration, out_.profile_acceleration));
    if (command.deceleration > 0) write_signal(image, out_.profile_deceleration, saturate(command.deceleration, out_.profile_deceleration));
    write_signal(image, out_.profile_velocity, saturate(std::abs(command.velocity), out_.profile_velocity));
    if (out_.digital.mapped()) {
        const auto before = static_cast<std::uint32_t>(read_signal(image, out_.digital));
        write_signal(image, out_.digital, (before & ~command.digital_output_mask) | (command.digital_outputs & command.digital_output_mask));
    }
    if (out_.probe_function.mapped()) write_probes(command);
}

void Cia402Drive::write_probes(const DriveCommand& command) noexcept {
    std::uint16_t function = 0;
    for (std::size_t probe = 0; probe < command.probes.size(); ++probe) {
        const auto& wanted = command.probes[probe];
        if (!wanted.armed) continue;
        std::uint16_t bits = 1;                                   // bit 0: enable
        if (wanted.continuous) bits |= 1u << 1;                   // bit 1: trigger with each event
        if (wanted.index_pulse) bits |= 1u << 2;                  // bit 2: zero impulse of the encoder
        bits |= wanted.edge == ProbeEdge::rising ? 1u << 4 : 1u << 5;
        function = static_cast<std::uint16_t>(function | (bits << (8 * probe)));
    }
    write_signal(bus_.outputs(), out_.probe_function, function);
}

}  // namespace taktwerk::axes::cia402
