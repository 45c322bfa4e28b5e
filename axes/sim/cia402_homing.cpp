// Homing by the drive: control word bit 4 starts and holds it, its end gives the drive a new zero.

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

void Cia402Axis::take_homing_start(const AxisInputs& in) noexcept {
    const bool start = (in.control & 0x10u) != 0;
    const bool idle = homing_.state() == HomingRun::State::idle;
    if (start && idle && too_early()) {
        ++early_commands_;
    } else if (start && idle) {
        homing_attained_ = homing_error_ = false;
        home_offset_ = in.home_offset;
        homing_.start(in.homing, switches());
    } else if (!start && !idle) {
        homing_.abort();
        demand_ = {plant_.position(), 0, 0};
    }
}

void Cia402Axis::homing_step(double dt) noexcept {
    homing_.step(dt, switches(), plant_.position());
    demand_.velocity = homing_.velocity();
    demand_.position += demand_.velocity * dt;
    if (homing_.state() == HomingRun::State::attained || homing_.state() == HomingRun::State::failed) homing_finished();
}

void Cia402Axis::homing_finished() noexcept {
    if (homing_.state() == HomingRun::State::failed) {
        homing_error_ = true;
    } else if (!homing_attained_) {
        // 60E6h = 0: the edge gets the coordinate 607Ch; the actual position jumps, the motor does not.
        zero_ = homing_.reference() - static_cast<double>(home_offset_);
        homing_attained_ = homed_ = true;
    }
}

}  // namespace taktwerk::axes::sim
