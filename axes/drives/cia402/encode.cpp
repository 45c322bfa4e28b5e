// Command -> raw fields, each cycle.

#include <algorithm>
#include <cmath>

#include "axes/drives/cia402/cia402_drive.hpp"
#include "axes/drives/cia402/words.hpp"

namespace taktwerk::axes::cia402 {

namespace {

constexpr std::uint32_t brake_bit = 1;  // of 60FEh

bool position_mode(DriveMode mode) noexcept { return mode == DriveMode::cyclic_position || mode == DriveMode::profile_position; }
bool profile_mode(DriveMode mode) noexcept {
    return mode == DriveMode::profile_position || mode == DriveMode::profile_velocity || mode == DriveMode::profile_torque;
}
bool velocity_mode(DriveMode mode) noexcept { return mode == DriveMode::cyclic_velocity || mode == DriveMode::profile_velocity; }
bool torque_mode(DriveMode mode) noexcept { return mode == DriveMode::cyclic_torque || mode == DriveMode::profile_torque; }

}  // namespace

std::uint16_t Cia402Drive::control_word(const DriveCommand& command, bool mode_confirmed) noexcept {
    const bool unknown = feedback_.power == PowerState::unknown;
    if (feedback_.fault || unknown) {
        // A drive that clears this alarm by a power cycle only is not pestered with edges (TSVM 7, note on starred alarms).
        if (command.reset_fault && alarm_.alarm().resettable) return reset_.word(place_.health().due);
        reset_.end();
        // Whatever it is doing in a state nobody knows: a motor that runs is stopped rather than let go.
        return unknown && !feedback_.fault ? quick_stop : disable_voltage;
    }
    reset_.end();

    switch (command.power) {
        case PowerRequest::off: return towards_off(feedback_.power);
        case PowerRequest::quick_stop:
            return feedback_.power == PowerState::enabled || feedback_.power == PowerState::quick_stop ? quick_stop
                                                                                                       : towards_off(feedback_.power);
        case PowerRequest::on: break;
    }
    const bool bits_stand = status_.may_enable(feedback_.status_word, settings_.status_hidden());
    const bool may_enable = mode_confirmed && bits_stand && settings_.verdict() == SettingsCheck::Verdict::fits;
    std::uint16_t word = towards_enabled(feedback_.power, may_enable);
    if (feedback_.power == PowerState::enabled) {
        if (command.mode == DriveMode::homing && mode_confirmed && command.start_homing) word |= homing_start;
        if (command.halt) word |= halt;
    }
    return word;
}

void Cia402Drive::encode(const DriveCommand& command, Instant now) noexcept {
    const auto image = place_.bus().outputs();
    starting_.write_once(image);
    settings_.reset(command.reset_fault);
    const auto mode = mode_.send(command.mode, profile_->mode_rules, now, [&] { return place_.effective(now); });
    const bool mode_confirmed = feedback_.mode == command.mode && mode == command.mode;
    if (command.mode != DriveMode::homing) homing_setup_.release();
    const bool set_up = command.mode != DriveMode::homing || homing_setup_.ready(command.homing);
    feedback_.homing_setup_refused = homing_setup_.refused();
    auto word = control_word(command, mode_confirmed);
    if (!set_up) word = static_cast<std::uint16_t>(word & ~homing_start);
    if (turns_.bit(now)) word = static_cast<std::uint16_t>(word | profile_->encoder.clear_turns_control);
    homing_.started((word & homing_start) != 0 && command.mode == DriveMode::homing, now);
    if (out_.mode.mapped()) write_signal(image, out_.mode.signal, mode_code(mode));

    // Until the drive follows in this mode its target is its own actual position: enabling and mode switches never step. From one cyclic
    // mode into another the targets of both are the command's: a motor that turns would feel an actual value, old as it is, as a step. So it
    // would out of a profile mode in motion.
    const bool changes_over = (is_cyclic(feedback_.mode) || profile_mode(feedback_.mode)) && is_cyclic(command.mode);
    const bool follows = feedback_.power == PowerState::enabled && (mode_confirmed || changes_over) && command.power == PowerRequest::on;
    if (profile_mode(command.mode)) {
        auto held = command;
        // One ramp for both: never harder than either of the two asked for (SV-DA200 3.2.3).
        if (profile_->has(Quirk::pp_shared_ramp) && command.mode == DriveMode::profile_position && command.deceleration > 0)
            held.acceleration = std::min(command.acceleration, command.deceleration);
        const bool prepared = profile_prepared(held, follows);
        if (command.mode == DriveMode::profile_position && prepared)
            word |= handshake_.bits(command.profile, feedback_.status_word, feedback_.fresh, now);
        hold_profile_target(held, follows, prepared);
        write_targets(image, held, follows);
        write_limits(image, held);
    } else {
        handshake_.reset();
        if (!follows || !profile_mode(feedback_.mode)) held_.forget();
        write_targets(image, command, follows);
        write_limits(image, command);
    }
    if (torque_limits_.used()) ask_torque_limits(command);
    write_signal(image, out_.control.signal, word);
    if (out_.digital.mapped()) {
        const auto before = static_cast<std::uint32_t>(read_signal(image, out_.digital.signal));
        write_signal(image, out_.digital.signal,
                     (before & ~command.digital_output_mask) | (command.digital_outputs & command.digital_output_mask));
    }
    if (capabilities_.brake && command.brake != BrakeRequest::none) write_brake(image, command.brake == BrakeRequest::open);
    if (out_.probe_function.mapped()) write_probes(image, command);
}

/// Speed and ramps of the set-point are in the drive, or go with this frame, and the drive is in the mode to take it.
bool Cia402Drive::profile_prepared(const DriveCommand& command, bool follows) noexcept {
    if (!follows) {
        handshake_.reset();
        return false;
    }
    const auto sequence = command.profile.sequence;
    if (sequence == 0) return true;
    const auto raw = [](double value) { return static_cast<std::uint32_t>(std::llround(std::clamp(std::abs(value), 0.0, 4294967295.0))); };
    const bool position = command.mode == DriveMode::profile_position;
    const auto at_least_one = [&](double value) { return value > 0 ? std::max<std::uint32_t>(1, raw(value)) : 0u; };
    ramps_.ask(sequence, {position ? at_least_one(std::abs(command.velocity) * profile_->velocity_counts_per_unit) : 0u,
                          at_least_one(command.acceleration), at_least_one(command.deceleration),
                          at_least_one(command.torque_slope * profile_->torque_rated_raw)});
    return ramps_.written(sequence);
}

/// In PV and PT the target is the set-point: the old one stays until its ramps are there.
void Cia402Drive::hold_profile_target(DriveCommand& command, bool follows, bool prepared) noexcept {
    if (!follows) held_.forget();
    if (command.mode == DriveMode::profile_position) {
        feedback_.profile_accepted = handshake_.accepted();
        return;
    }
    if (prepared) {
        held_.take(command);
        feedback_.profile_accepted = command.profile.sequence;
    }
    held_.put(command);
}

void Cia402Drive::write_targets(std::span<std::byte> image, const DriveCommand& command, bool follows) const noexcept {
    // Positions wrap like the drive's own: the low bits, not a saturated value.
    const bool in_position_mode = position_mode(command.mode) || feedback_.mode == DriveMode::cyclic_position;
    write_signal(image, out_.target_position.signal, follows && in_position_mode ? command.position : feedback_.position);
    const double velocity = follows ? command.velocity * settings_.velocity_counts_per_unit() : 0.0;
    const bool in_velocity_mode = velocity_mode(command.mode) || feedback_.mode == DriveMode::cyclic_velocity;
    // On the way out of a profile mode its target stays: a zero would begin a ramp before the mode has changed.
    const bool on_the_way_out = profile_mode(feedback_.mode) && !profile_mode(command.mode);
    const double target_velocity = on_the_way_out     ? held_.velocity() * settings_.velocity_counts_per_unit()
                                   : in_velocity_mode ? velocity
                                                      : 0;
    out_.target_velocity.write(image, target_velocity);
    out_.velocity_offset.write(image, command.mode == DriveMode::cyclic_position && !on_the_way_out ? velocity : 0);
    const double torque = follows ? command.torque * profile_->torque_rated_raw : 0.0;
    const bool in_torque_mode = torque_mode(command.mode) || feedback_.mode == DriveMode::cyclic_torque;
    out_.target_torque.write(image, on_the_way_out ? held_.torque() * profile_->torque_rated_raw : in_torque_mode ? torque : 0);
    out_.torque_offset.write(image, torque_mode(command.mode) || profile_mode(command.mode) || on_the_way_out ? 0 : torque);
}

void Cia402Drive::write_limits(std::span<std::byte> image, const DriveCommand& command) const noexcept {
    // A mapped torque limit of zero would block the drive (SV-DA200 sheet 9 item 12): infinity is the most the object takes.
    const double positive = command.torque_limit_positive * profile_->torque_rated_raw;
    const double negative = command.torque_limit_negative * profile_->torque_rated_raw;
    out_.torque_positive.write(image, positive);
    out_.torque_negative.write(image, negative);
    // Where each direction has its own, the one for both must not cut off the larger.
    out_.torque_max.write(image, capabilities_.torque_limit_per_direction ? std::max(positive, negative) : std::min(positive, negative));
    // The rest stays as the start-up list or the last command left it while nothing is asked for: zero would mean "never move".
    if (std::isfinite(command.velocity_limit))
        out_.velocity_limit.write(image, command.velocity_limit * settings_.velocity_counts_per_unit());
    else if (starting_.velocity_limit() != 0)  // the limit of a torque command must not slow down what comes after it
        out_.velocity_limit.write(image, static_cast<double>(starting_.velocity_limit()));
    if (command.acceleration > 0) out_.profile_acceleration.write(image, command.acceleration);
    if (command.deceleration > 0) out_.profile_deceleration.write(image, command.deceleration);
    if (command.torque_slope > 0) out_.torque_slope.write(image, command.torque_slope * profile_->torque_rated_raw);
    if (command.mode == DriveMode::profile_position && command.velocity != 0)
        out_.profile_velocity.write(image, std::abs(command.velocity) * settings_.velocity_counts_per_unit());
}

void Cia402Drive::ask_torque_limits(const DriveCommand& command) noexcept {
    const auto raw = [&](double limit) {
        constexpr double most = 1e9;
        return std::isfinite(limit) ? std::lround(std::min(limit * profile_->torque_rated_raw, most)) : TorqueLimitWriter::no_limit;
    };
    TorqueLimitWriter::Values wanted{raw(command.torque_limit_positive), raw(command.torque_limit_negative)};
    if (!capabilities_.torque_limit_per_direction)
        wanted = {raw(std::min(command.torque_limit_positive, command.torque_limit_negative)), TorqueLimitWriter::no_limit};
    feedback_.torque_limits = torque_limits_.ask(wanted, feedback_.online);
}

void Cia402Drive::write_brake(std::span<std::byte> image, bool open) const noexcept {
    const auto set_bit = [&](const MappedOutput& output, bool on) {
        if (!output.mapped()) return;
        const auto before = static_cast<std::uint32_t>(read_signal(image, output.signal));
        write_signal(image, output.signal, on ? before | brake_bit : before & ~brake_bit);
    };
    const bool by_output = profile_->brake.object == BrakeObject::output_bit;
    if (by_output) set_bit(out_.digital, !open);
    set_bit(out_.digital_mask, by_output || open);
}

void Cia402Drive::write_probes(std::span<std::byte> image, const DriveCommand& command) noexcept {
    unsigned function = 0;
    for (std::size_t probe = 0; probe < probes_.size(); ++probe)
        function |= static_cast<unsigned>(probes_[probe].function(command.probes[probe])) << (8 * probe);
    write_signal(image, out_.probe_function.signal, static_cast<std::int64_t>(function));
}

}  // namespace taktwerk::axes::cia402
