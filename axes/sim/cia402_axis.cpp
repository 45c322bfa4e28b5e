// One axis in time: inner steps of physics and control, and the exchange of objects with the bus.

#include "axes/sim/cia402_axis.hpp"

#include <cmath>

#include "axes/sim/inner_step.hpp"

namespace taktwerk::axes::sim {

namespace {

ProbeToggle probe_toggle(const DriveProfile& profile) noexcept {
    return profile.has(Quirk::probe_toggle_bits) ? ProbeToggle::bits_6_and_7 : ProbeToggle::none;
}

}  // namespace

Cia402Axis::Cia402Axis(const PlantConfig& plant, std::shared_ptr<const DriveProfile> profile, const SimulatedMotor& motor)
    : profile_(std::move(profile)),
      codes_(*profile_),
      motor_(plant, motor, *profile_),
      origin_(plant, motor, *profile_, codes_),
      brake_(profile_->brake, static_cast<double>(motor.counts_per_revolution), plant.brake_closing),
      terminals_(probe_toggle(*profile_)),
      profile_position_(profile_->profile_buffer, has(Quirk::pp_bit_5_blends) ? BitFive::blends : BitFive::replaces),
      travel_(has(Quirk::limit_stop_is_warning)),
      causes_(profile_->alarms.size(), false) {}

void Cia402Axis::scale(double counts_per_revolution) noexcept {
    const double factor = motor_.rescale(counts_per_revolution);
    if (factor == 1) return;
    origin_.rescale(factor);
    cyclic_.rescale(factor);
    brake_.rescale(factor);
}

bool Cia402Axis::at_index_pulse() const noexcept {
    const auto pulses = motor_.index_pulses();
    return std::abs(std::remainder(plant().position() - pulses.at, pulses.every)) < 0.5;
}

void Cia402Axis::inner_step() noexcept {
    const double dt = inner_seconds;
    const bool follows = state_ == State::enabled && !stop_.holds_up() && !travel_.stopped();
    double torque = 0;
    if (energised()) torque = follows ? enabled_torque(dt) : stopping_torque(dt);
    else if (stop_.phases_shorted()) torque = motor_.brake_torque();
    if (!energised()) motor_.release_field();
    motor_.give(torque);
    step_brake();
    const double before = plant().position();
    motor_.turn(dt);
    terminals_.step(motor_, before, origin_.zero());
    end_stop();
    end_self_test();
    watch_target();
    supervise();
}

void Cia402Axis::advance(Instant now) noexcept {
    while (now_ + inner_period <= now) {
        now_ += inner_period;
        inner_step();
    }
}

void Cia402Axis::exchange(const AxisInputs& in, Duration cycle, AxisOutputs& out) noexcept {
    settings_ = in;
    motor_.limit_torque(in);
    travel_.limited(false);
    select_mode(in);
    command(in);
    take_halt(in);
    terminals_.command(in.probe_function);
    if (state_ == State::enabled) take_targets(in, cycle);
    watch_travel(in);
    homing_.exchanged(in);
    motor_.tell_torque();
    fill(out);
    window_.tell();
}

}  // namespace taktwerk::axes::sim
