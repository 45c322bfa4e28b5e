// What the drive counts from: the place of an incremental encoder at power-on, or what an absolute one reads and homing has stored.

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

void Cia402Axis::read_encoder() noexcept { zero_ = plant_.position() - encoder_.reading(plant_.position()) + stored_shift_; }

void Cia402Axis::wake_encoder() noexcept {
    encoder_complaint_ = {};
    if (stepper_) demand_ = {plant_.position(), 0, 0};
    if (!personality_.absolute_encoder) {
        zero_ = plant_.position();
        homed_ = false;
        return;
    }
    const bool empty = battery_ == Battery::empty;
    if (empty || encoder_reset_ordered_) {
        encoder_.forget_turns(plant_.position());
        homed_ = false;
    }
    if (empty) encoder_fault_kept_ = personality_.encoder_keeps_fault;
    else if (encoder_reset_ordered_) encoder_fault_kept_ = false;
    encoder_reset_ordered_ = false;
    if (empty || encoder_fault_kept_) encoder_complaint_ = personality_.reference_lost_alarm;
    read_encoder();
    raise_or_warn(encoder_complaint_);
}

void Cia402Axis::watch_encoder() noexcept {
    // Where the manual lists it among the faults it stops the drive (TSVM 7.2, 27; SV-DA200 5.3, Er02-8); SV33-E 5.5 only warns.
    if (battery_low() && !personality_.battery_low_alarm.warning && state_ != State::not_ready) raise(personality_.battery_low_alarm);
    if (!personality_.absolute_encoder || encoder_complaint_.code != 0 || personality_.turn_overflow_alarm.code == 0) return;
    if (!encoder_.overflowed(plant_.position())) return;
    homed_ = false;
    encoder_complaint_ = personality_.turn_overflow_alarm;
    raise_or_warn(encoder_complaint_);
}

bool Cia402Axis::battery_low() const noexcept {
    const bool low = battery_volts_ ? *battery_volts_ < personality_.battery_low : battery_ == Battery::low;
    return personality_.absolute_encoder && low && personality_.battery_low_alarm.code != 0;
}

void Cia402Axis::battery_voltage(double volts) noexcept {
    battery_volts_ = volts;
    battery_ = volts < personality_.battery_empty ? Battery::empty : volts < personality_.battery_low ? Battery::low : Battery::good;
}

void Cia402Axis::order_encoder_reset() noexcept {
    if (personality_.absolute_encoder && !energised()) encoder_reset_ordered_ = true;
}

bool Cia402Axis::battery_warns() const noexcept { return battery_low() && personality_.battery_low_alarm.warning; }

void Cia402Axis::reset_encoder() noexcept {
    if (energised()) return;
    if (encoder_.overflowed(plant_.position()) && encoder_complaint_.code != 0) return;  // only fewer turns help
    encoder_complaint_ = {};
    cause(DriveAlarmKind::reference_lost, false);
}

void Cia402Axis::clear_turns() noexcept {
    if (energised() || !personality_.absolute_encoder) return;
    encoder_.forget_turns(plant_.position());
    encoder_complaint_ = {};
    cause(DriveAlarmKind::reference_lost, false);
    cause(DriveAlarmKind::turn_overflow, false);
    homed_ = false;
    read_encoder();
}

}  // namespace taktwerk::axes::sim
