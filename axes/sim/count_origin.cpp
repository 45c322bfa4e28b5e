#include "axes/sim/count_origin.hpp"

namespace taktwerk::axes::sim {

CountOrigin::CountOrigin(const PlantConfig& plant, const SimulatedMotor& motor, const DriveProfile& profile, const DriveAlarmCodes& codes)
    : absolute_(motor.absolute_encoder),
      encoder_(static_cast<double>(motor.counts_per_revolution), plant.index_pulse, profile.encoder.turn_bits),
      low_volts_(profile.encoder.battery_low),
      empty_volts_(profile.encoder.battery_empty),
      keeps_fault_(profile.encoder.reset.index != 0),
      lost_(codes[DriveAlarmKind::reference_lost]),
      low_(codes[DriveAlarmKind::battery_low]),
      too_many_turns_(codes[DriveAlarmKind::turn_overflow]),
      battery_(plant.battery),
      stored_shift_(-plant.index_pulse) {}

void CountOrigin::rescale(double factor) noexcept {
    encoder_.rescale(factor);
    zero_ *= factor;
    stored_shift_ *= factor;
}

AlarmCode CountOrigin::wake(double position) noexcept {
    complaint_ = {};
    if (!absolute_) {
        zero_ = position;
        homed_ = false;
        return {};
    }
    const bool empty = battery_ == Battery::empty;
    if (empty || reset_ordered_) {
        encoder_.forget_turns(position);
        homed_ = false;
    }
    if (empty) fault_kept_ = keeps_fault_;
    else if (reset_ordered_) fault_kept_ = false;
    reset_ordered_ = false;
    if (empty || fault_kept_) complaint_ = lost_;
    read(position);
    return complaint_;
}

void CountOrigin::reference(double shift, double position, double seen) noexcept {
    zero_ += shift;
    stored_shift_ = encoder_.reading(position) - (seen - zero_);
    homed_ = true;
}

AlarmCode CountOrigin::watch(double position) noexcept {
    if (!absolute_ || complaint_.code != 0 || too_many_turns_.code == 0) return {};
    if (!encoder_.overflowed(position)) return {};
    homed_ = false;
    return complaint_ = too_many_turns_;
}

void CountOrigin::fail(std::int64_t count) noexcept {
    frozen_ = count;
    failed_ = true;
}

bool CountOrigin::battery_low() const noexcept {
    const bool low = battery_volts_ ? *battery_volts_ < low_volts_ : battery_ == Battery::low;
    return absolute_ && low && low_.code != 0;
}

void CountOrigin::battery_voltage(double volts) noexcept {
    battery_volts_ = volts;
    battery_ = volts < empty_volts_ ? Battery::empty : volts < low_volts_ ? Battery::low : Battery::good;
}

bool CountOrigin::reset(double position) noexcept {
    if (encoder_.overflowed(position) && complaint_.code != 0) return false;  // only fewer turns help
    complaint_ = {};
    return true;
}

bool CountOrigin::clear_turns(double position) noexcept {
    if (!absolute_) return false;
    encoder_.forget_turns(position);
    complaint_ = {};
    homed_ = false;
    read(position);
    return true;
}

void CountOrigin::order_reset() noexcept {
    if (absolute_) reset_ordered_ = true;
}

}  // namespace taktwerk::axes::sim
