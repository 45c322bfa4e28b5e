// One axis in time: inner steps of physics and control, and the exchange of objects with the bus.

#include "axes/sim/cia402_axis.hpp"

#include <cmath>

namespace taktwerk::axes::sim {

Cia402Axis::Cia402Axis(const PlantConfig& plant, const Personality& personality)
    : personality_(personality),
      plant_(plant),
      probes_{TouchProbe(personality.probe_toggle), TouchProbe(personality.probe_toggle)},
      encoder_(static_cast<double>(personality.counts_per_revolution), plant.index_pulse, personality.encoder_turn_bits),
      battery_(plant.battery),
      stored_shift_(-plant.index_pulse),
      causes_(personality.alarms.size(), false) {}

double Cia402Axis::quantised() const noexcept { return std::floor(actual()); }

IndexPulses Cia402Axis::index_pulses() const noexcept {
    return {plant_.config().index_pulse, static_cast<double>(personality_.counts_per_revolution)};
}

SwitchStates Cia402Axis::switches() const noexcept { return {plant_.negative_limit(), plant_.positive_limit(), plant_.home_switch()}; }

void Cia402Axis::inner_step() noexcept {
    const double dt = inner_seconds;
    torque_ = !energised() ? 0 : state_ == State::enabled ? enabled_torque(dt) : stopping_torque(dt);
    step_brake();
    const double before = plant_.position();
    plant_.step(dt, torque_);
    step_probes(before);
    end_stop();
    supervise();
}

/// In the drive's counts, as the latched position is.
void Cia402Axis::step_probes(double before) noexcept {
    auto pulses = index_pulses();
    pulses.at -= zero_;
    for (std::size_t i = 0; i < probes_.size(); ++i) {
        const auto& seen = plant_.config().probe[i];
        const auto signal = blank_ ? ProbeSignal{} : nearest({seen.from, seen.to}, seen.every, plant_.position());
        probes_[i].motion(before - zero_, plant_.position() - zero_, {signal.from - zero_, signal.to - zero_}, pulses);
    }
}

void Cia402Axis::advance(Instant now) noexcept {
    while (now_ + inner_period <= now) {
        now_ += inner_period;
        inner_step();
    }
}

void Cia402Axis::exchange(const AxisInputs& in, Duration cycle, AxisOutputs& out) noexcept {
    constexpr std::int64_t no_check = 0xFFFFFFFF;  // CiA 402-2, 6065h
    following_limit_ = in.following_error_window == 0          ? personality_.following_error_limit
                       : in.following_error_window == no_check ? 0
                                                               : static_cast<double>(in.following_error_window);
    limited_ = false;
    select_mode(in);
    command(in);
    for (std::size_t i = 0; i < probes_.size(); ++i) probes_[i].command(static_cast<std::uint8_t>(in.probe_function >> (8 * i)));
    if (state_ == State::enabled) take_targets(in, cycle);
    homing_bit_ = (in.control & 0x10u) != 0;
    fill(out);
}

}  // namespace taktwerk::axes::sim
