#include "axes/drives/analog/analog_port.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace taktwerk::axes::analog {

AnalogPort::AnalogPort(std::unique_ptr<DrivePort> encoder, const AnalogDrive& drive, double counts_per_unit, double runaway, bool switches)
    : encoder_(std::move(encoder)),
      drive_(drive),
      volts_per_count_(10 / (drive.velocity_at_10v * counts_per_unit)),
      polarity_(runaway * std::abs(counts_per_unit)) {
    join_capabilities();
    capabilities_.digital_inputs = switches;
}

void AnalogPort::join_capabilities() noexcept {
    const auto& measures = encoder_->capabilities();
    const bool switches = capabilities_.digital_inputs;
    capabilities_ = measures;
    capabilities_.modes = 1u << static_cast<unsigned>(DriveMode::cyclic_velocity);
    capabilities_.digital_inputs = switches;
    capabilities_.rated_velocity = drive_.voltage_limit / std::abs(volts_per_count_);
}

const DriveFeedback& AnalogPort::decode(Instant now) noexcept {
    const auto& from = encoder_->decode(now);
    measure(from);
    if (encoder_->alarm().kind == DriveAlarmKind::encoder) fall(PortFault::encoder);
    if (in_.reachable && in_.fault) fall(PortFault::amplifier);

    const double velocity = feedback_.velocity;
    feedback_ = from;
    feedback_.velocity = velocity;
    feedback_.mode = DriveMode::cyclic_velocity;
    feedback_.power = power();
    feedback_.fault = fault_ != PortFault::none;
    // The wires say something new, also where the encoder does not; without the wires nothing is known of the amplifier.
    feedback_.fresh = in_.reachable && (from.fresh || (from.online && feedback_.fault));
    feedback_.has_inputs = in_.has_switches;
    feedback_.negative_limit = in_.negative_limit;
    feedback_.positive_limit = in_.positive_limit;
    feedback_.home_switch = in_.home_switch;
    return feedback_;
}

/// `feedback_` still is that of the cycle before.
void AnalogPort::measure(const DriveFeedback& from) noexcept {
    const bool other_zero = from.position_epoch != feedback_.position_epoch || !from.online;
    if (other_zero) {
        slope_.clear();
        feedback_.velocity = 0;
    }
    if (!from.fresh) return;
    feedback_.velocity = slope_.add(from.latched, from.position);
    if (other_zero || stage_ != Stage::on || !polarity_.step(static_cast<double>(from.position - feedback_.position), driven_)) return;
    ran_away_ = polarity_.against();
    fall(PortFault::polarity);
}

/// The first is the one that is told; what stops the amplifier is step_power().
void AnalogPort::fall(PortFault fault) noexcept {
    if (fault_ == PortFault::none) fault_ = fault;
}

bool AnalogPort::cause_present() const noexcept {
    return stage_ != Stage::off || encoder_->alarm().kind == DriveAlarmKind::encoder || (in_.reachable && in_.fault);
}

PowerState AnalogPort::power() const noexcept {
    if (fault_ != PortFault::none) return stage_ == Stage::stopping ? PowerState::fault_reaction : PowerState::fault;
    switch (stage_) {
        case Stage::off: return asked_ == PowerRequest::on && !in_.ready ? PowerState::not_ready : PowerState::disabled;
        case Stage::rising: return PowerState::switched_on;
        case Stage::on: return asked_ == PowerRequest::quick_stop ? PowerState::quick_stop : PowerState::enabled;
        case Stage::stopping: break;
    }
    return PowerState::quick_stop;
}

void AnalogPort::encode(const DriveCommand& command, Instant now) noexcept {
    encoder_->encode(command, now);
    out_.reset = command.reset_fault && in_.fault;
    if (command.reset_fault && !cause_present()) fault_ = PortFault::none;
    step_power(command.power, now);
    asked_ = command.power;
    driven_ = stage_ == Stage::on && asked_ == PowerRequest::on ? command.velocity : 0;
    out_.enable = stage_ != Stage::off;
    const double volts = driven_ * volts_per_count_ + drive_.offset;
    out_.volts = out_.enable ? std::clamp(volts, -drive_.voltage_limit, drive_.voltage_limit) : 0;
}

void AnalogPort::step_power(PowerRequest request, Instant now) noexcept {
    const bool usable = in_.reachable && in_.ready && feedback_.online && fault_ == PortFault::none;
    const bool cut = !in_.reachable || !in_.ready || fault_ == PortFault::amplifier;  // there is nothing left that could brake
    switch (stage_) {
        case Stage::off:
            if (request != PowerRequest::on || !usable) return;
            polarity_.begin();
            return go(Stage::rising, now);
        case Stage::rising:
        case Stage::on:
            if (cut) return go(Stage::off, now);
            if (!usable) return go(Stage::stopping, now);
            if (request == PowerRequest::off) return go(Stage::off, now);
            if (stage_ == Stage::rising && now - since_ >= drive_.enable_delay) go(Stage::on, now);
            return;
        case Stage::stopping:
            if (cut || now - since_ >= drive_.stop_time) go(Stage::off, now);
            return;
    }
}

DriveAlarm AnalogPort::alarm() const noexcept {
    DriveAlarm told;
    told.found = fault_;
    if (fault_ == PortFault::polarity) told.detail = static_cast<std::uint32_t>(std::clamp(ran_away_, 0.0, 4e9));
    if (fault_ == PortFault::none && power() == PowerState::not_ready) told.found = PortFault::not_ready;
    return told;
}

}  // namespace taktwerk::axes::analog
