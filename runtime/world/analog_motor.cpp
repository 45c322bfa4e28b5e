#include "runtime/world/analog_motor.hpp"

#include <cmath>

namespace taktwerk::runtime {

namespace {

constexpr double coasting_s = 0.3, braking_s = 0.02;  // time constants without power: free, and under its holding brake
constexpr double stands = 1e-6;                       // of the velocity at 10 V: friction has stopped it

}  // namespace

AnalogMotor::AnalogMotor(const AxisBinding& binding) noexcept
    : analog_(*binding.analog), simulation_(binding.simulation), position_(binding.simulation.start) {}

void AnalogMotor::run(double volts, bool enabled, bool brake_holds, Duration time) noexcept {
    const double seconds = to_seconds(time), full = analog_.drive.velocity_at_10v;
    if (jammed_ || (brake_holds && velocity_ == 0)) {
        velocity_ = 0;
        return;
    }
    if (enabled && ready()) {
        lag((volts + simulation_.analog.drift) / 10 * full, to_seconds(simulation_.analog.time_constant), seconds);
    } else {
        lag(0, brake_holds ? braking_s : coasting_s, seconds);
        if (std::abs(velocity_) < stands * std::abs(full)) velocity_ = 0;
    }
    if (simulation_.negative_stop && position_ < *simulation_.negative_stop) position_ = *simulation_.negative_stop, velocity_ = 0;
    if (simulation_.positive_stop && position_ > *simulation_.positive_stop) position_ = *simulation_.positive_stop, velocity_ = 0;
}

void AnalogMotor::lag(double towards, double time_constant, double seconds) noexcept {
    const double left = time_constant > 0 ? std::exp(-seconds / time_constant) : 0;
    const double missing = velocity_ - towards;
    position_ += towards * seconds + missing * time_constant * (1 - left);
    velocity_ = towards + missing * left;
}

}  // namespace taktwerk::runtime
