// One axis in time: inner steps of physics and control, and the exchange of objects with the bus.

#include "axes/sim/cia402_axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace taktwerk::axes::sim {

namespace {

ProbeToggle probe_toggle(const DriveProfile& profile) noexcept {
    return profile.has(Quirk::probe_toggle_bits) ? ProbeToggle::bits_6_and_7 : ProbeToggle::none;
}

}  // namespace

Cia402Axis::Cia402Axis(const PlantConfig& plant, std::shared_ptr<const DriveProfile> profile, const SimulatedMotor& motor)
    : profile_(std::move(profile)),
      motor_(motor),
      codes_(*profile_),
      velocity_unit_(profile_->velocity_counts_per_unit),
      brake_moving_speed_(profile_->brake.moving_speed / 60.0 * static_cast<double>(motor.counts_per_revolution)),
      turn_(static_cast<double>(motor.counts_per_revolution)),
      plant_(plant),
      probes_{TouchProbe(probe_toggle(*profile_)), TouchProbe(probe_toggle(*profile_))},
      profile_position_(profile_->profile_buffer, has(Quirk::pp_bit_5_blends) ? BitFive::blends : BitFive::replaces),
      encoder_(static_cast<double>(motor.counts_per_revolution), plant.index_pulse, profile_->encoder.turn_bits),
      battery_(plant.battery),
      stored_shift_(-plant.index_pulse),
      causes_(profile_->alarms.size(), false) {
    take_torque_limits({});
}

double Cia402Axis::quantised() const noexcept { return std::floor(actual()); }

IndexPulses Cia402Axis::index_pulses() const noexcept { return {plant_.config().index_pulse, turn_}; }

void Cia402Axis::scale(double counts_per_revolution) noexcept {
    const double factor = counts_per_revolution / turn_;
    if (factor == 1) return;
    plant_.rescale(factor);
    encoder_.rescale(factor);
    for (double* count : {&zero_, &stored_shift_, &demand_.position, &demand_.velocity, &demand_step_, &target_, &brake_moving_speed_,
                          &motor_.following_error_limit, &motor_.maximum_velocity, &motor_.overspeed, &motor_.start_speed})
        *count *= factor;
    turn_ = counts_per_revolution;
    motor_.counts_per_revolution = std::llround(turn_);
}

void Cia402Axis::read_switches(Duration dt) noexcept {
    inputs_.step({plant_.negative_limit(), plant_.positive_limit(), plant_.home_switch()}, dt);
}

void Cia402Axis::open_loop(std::optional<double> standby) noexcept {
    stepper_.reset();
    if (standby) stepper_.emplace(*standby);
}

void Cia402Axis::inner_step() noexcept {
    const double dt = inner_seconds;
    const bool follows = state_ == State::enabled && !halted_ && !ramps_out_ && travel_stop_ == 0;
    if (energised()) torque_ = follows ? enabled_torque(dt) : stopping_torque(dt);
    else torque_ = phases_shorted_ ? brake_torque() : 0;
    if (stepper_ && !energised()) {
        demand_.velocity = 0;
        stepper_->release();
    }
    torque_ = std::clamp(torque_, torque_least_, torque_most_);
    step_brake();
    const double before = plant_.position();
    plant_.step(dt, torque_);
    read_switches(inner_period);
    step_probes(before);
    end_stop();
    end_self_test();
    watch_target();
    supervise();
    watch_torque();
}

/// In the drive's counts, as the latched position is.
void Cia402Axis::step_probes(double before) noexcept {
    auto pulses = index_pulses();
    pulses.at -= zero_;
    for (std::size_t i = 0; i < probes_.size(); ++i) {
        const auto signal = probe_signal(i);
        probes_[i].motion(before - zero_, plant_.position() - zero_, {signal.from - zero_, signal.to - zero_}, pulses);
    }
}

ProbeSignal Cia402Axis::probe_signal(std::size_t probe) const noexcept {
    const auto& seen = plant_.config().probe[probe];
    return blank_ ? ProbeSignal{} : nearest({seen.from, seen.to}, seen.every, plant_.position());
}

bool Cia402Axis::probe_input(std::size_t probe) const noexcept {
    const auto signal = probe_signal(probe);
    return signal.from <= plant_.position() && plant_.position() <= signal.to;
}

bool Cia402Axis::at_index_pulse() const noexcept {
    const auto pulses = index_pulses();
    return std::abs(std::remainder(plant_.position() - pulses.at, pulses.every)) < 0.5;
}

/// In every mode (SV-DA200 2.1 note 9). A limit is a number without sign, the negative one too.
void Cia402Axis::take_torque_limits(const AxisInputs& in) noexcept {
    const auto limit = [&](std::int64_t raw) { return raw < 0 ? std::numeric_limits<double>::infinity() : torque_of(raw); };
    torque_most_ = std::min({torque_limit(), limit(in.torque_limit), limit(in.torque_limit_positive)});
    torque_least_ = -std::min({torque_limit(), limit(in.torque_limit), limit(in.torque_limit_negative)});
}

void Cia402Axis::advance(Instant now) noexcept {
    while (now_ + inner_period <= now) {
        now_ += inner_period;
        inner_step();
    }
}

void Cia402Axis::exchange(const AxisInputs& in, Duration cycle, AxisOutputs& out) noexcept {
    settings_ = in;
    take_torque_limits(in);
    constexpr std::int64_t no_check = 0xFFFFFFFF;  // CiA 402-2, 6065h
    following_limit_ = in.following_error_window == 0          ? motor_.following_error_limit
                       : in.following_error_window == no_check ? 0
                                                               : static_cast<double>(in.following_error_window);
    limited_ = false;
    select_mode(in);
    command(in);
    take_halt(in);
    for (std::size_t i = 0; i < probes_.size(); ++i) probes_[i].command(static_cast<std::uint8_t>(in.probe_function >> (8 * i)));
    if (state_ == State::enabled) take_targets(in, cycle);
    watch_travel(in);
    homing_bit_ = (in.control & 0x10u) != 0;
    fill(out);
    reached_told_ = target_reached_;
}

}  // namespace taktwerk::axes::sim
