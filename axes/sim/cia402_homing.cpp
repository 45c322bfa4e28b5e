// Homing by the drive: the rising edge of control word bit 4 starts it, its fall or halt (bit 8) break it off, its end gives the drive a
// new zero. After a halt a new edge is needed: CiA 402 calls the procedure interrupted then, no manual says how it would go on.

#include <algorithm>
#include <cmath>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

HomingView Cia402Axis::homing_view() const noexcept {
    return {switches(), seen_position(), std::abs(torque_) / torque_limit(), stands(), index_pulses()};
}

void Cia402Axis::take_homing_start(const AxisInputs& in) noexcept {
    const bool held = (in.control & 0x10u) != 0, halt = (in.control & 0x100u) != 0;
    if (!held || halt) return homing_.abort();
    if (homing_bit_) return;
    if (too_early()) {
        ++early_commands_;
        return;
    }
    end_warning();
    homing_attained_ = homing_error_ = false;
    home_offset_ = in.home_offset;
    home_position_method_ = in.home_position_method;
    const auto number = in.homing.method == 19 && has(Quirk::homing_19_starts_negative) ? 21 : in.homing.method;
    const auto& documented = profile_->homing_methods;  // none: it knows them all
    const bool known = in.homing.method >= -2 && in.homing.method < 62 &&
                       (documented.empty() || std::find(documented.begin(), documented.end(), in.homing.method) != documented.end());
    homing_.start(in.homing, known ? homing_method(number) : HomingMethod{}, homing_view());
}

void Cia402Axis::homing_step(double dt) noexcept {
    const bool pressed = homing_.presses();
    homing_.step(dt, homing_view());
    demand_.velocity = homing_.velocity();
    demand_.position = pressed ? quantised() + zero_ : demand_.position + demand_.velocity * dt;
    if (pressed && !homing_.presses()) loop_.reset();  // the torque that pressed is of no use on the way back
    if (homing_.state() == HomingRun::State::failed && !homing_error_) homing_failed();
    if (homing_.state() == HomingRun::State::attained && !homing_attained_) homing_attained();
}

void Cia402Axis::homing_failed() noexcept {
    homing_error_ = true;
    switch (homing_.failure()) {
        case HomingRun::Failure::method: raise_or_warn(codes_[DriveAlarmKind::homing_method]); break;
        case HomingRun::Failure::time: raise_or_warn(codes_[DriveAlarmKind::homing_timeout]); break;
        case HomingRun::Failure::limit:
            if (has(Quirk::homing_limit_is_fault)) raise_or_warn(codes_[DriveAlarmKind::homing_limit]);
            break;
        case HomingRun::Failure::speed:
        case HomingRun::Failure::none: break;
    }
}

/// SV33-E table 3-75 (60E6h). The actual position jumps, the motor does not; the encoder's counts stay where they are.
void Cia402Axis::homing_attained() noexcept {
    const auto offset = static_cast<double>(home_offset_);
    zero_ += home_position_method_ == 1 ? -offset : std::floor(homing_.reference() - zero_) - offset;
    stored_shift_ = encoder_.reading(plant_.position()) - actual();
    homing_attained_ = homed_ = true;
}

}  // namespace taktwerk::axes::sim
