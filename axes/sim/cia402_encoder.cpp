// What the drive counts from: the place of an incremental encoder at power-on, or what an absolute one reads and homing has stored.

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

void Cia402Axis::read_encoder() noexcept { zero_ = plant_.position() - encoder_.reading(plant_.position()) + stored_shift_; }

void Cia402Axis::wake_encoder() noexcept {
    encoder_complaint_ = {};
    if (stepper_) demand_ = {plant_.position(), 0, 0};
    if (!motor_.absolute_encoder) {
        zero_ = plant_.position();
        homed_ = false;
        return;
    }
    const bool empty = battery_ == Battery::empty;
    if (empty || encoder_reset_ordered_) {
        encoder_.forget_turns(plant_.position());
        homed_ = false;
    }
    if (empty) encoder_fault_kept_ = (profile_->encoder.reset.index != 0);
    else if (encoder_reset_ordered_) encoder_fault_kept_ = false;
    encoder_reset_ordered_ = false;
    if (empty || encoder_fault_kept_) encoder_complaint_ = codes_[DriveAlarmKind::reference_lost];
    read_encoder();
    raise_or_warn(encoder_complaint_);
}

void Cia402Axis::watch_encoder() noexcept {
    // Where the manual lists it among the faults it stops the drive (TSVM 7.2, 27; SV-DA200 5.3, Er02-8); SV33-E 5.5 only warns.
    if (battery_low() && !codes_[DriveAlarmKind::battery_low].warning && state_ != State::not_ready)
        raise(codes_[DriveAlarmKind::battery_low]);
    if (!motor_.absolute_encoder || encoder_complaint_.code != 0 || codes_[DriveAlarmKind::turn_overflow].code == 0) return;
    if (!encoder_.overflowed(plant_.position())) return;
    homed_ = false;
    encoder_complaint_ = codes_[DriveAlarmKind::turn_overflow];
    raise_or_warn(encoder_complaint_);
}

bool Cia402Axis::battery_low() const noexcept {
    const bool low = battery_volts_ ? *battery_volts_ < profile_->encoder.battery_low : battery_ == Battery::low;
    return motor_.absolute_encoder && low && codes_[DriveAlarmKind::battery_low].code != 0;
}

void Cia402Axis::battery_voltage(double volts) noexcept {
    battery_volts_ = volts;
    battery_ = volts < profile_->encoder.battery_empty ? Battery::empty
               : volts < profile_->encoder.battery_low ? Battery::low
                                                       : Battery::good;
}

void Cia402Axis::order_encoder_reset() noexcept {
    if (motor_.absolute_encoder && !energised()) encoder_reset_ordered_ = true;
}

bool Cia402Axis::battery_warns() const noexcept { return battery_low() && codes_[DriveAlarmKind::battery_low].warning; }

void Cia402Axis::reset_encoder() noexcept {
    if (energised()) return;
    if (encoder_.overflowed(plant_.position()) && encoder_complaint_.code != 0) return;  // only fewer turns help
    encoder_complaint_ = {};
    cause(DriveAlarmKind::reference_lost, false);
}

void Cia402Axis::clear_turns() noexcept {
    if (energised() || !motor_.absolute_encoder) return;
    encoder_.forget_turns(plant_.position());
    encoder_complaint_ = {};
    cause(DriveAlarmKind::reference_lost, false);
    cause(DriveAlarmKind::turn_overflow, false);
    homed_ = false;
    read_encoder();
}

}  // namespace taktwerk::axes::sim
