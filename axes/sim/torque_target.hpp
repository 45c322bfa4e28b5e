#pragma once
// The torque that a simulated drive is told to give: in PT and CST as its target, elsewhere beside what its loops ask for (60B2h). N m.

#include <cstdint>

#include "axes/sim/motor_control.hpp"

namespace taktwerk::axes::sim {

class TorqueTarget {
public:
    /// Nothing is demanded.
    void forget() noexcept { target_ = demand_ = offset_ = 0; }
    /// Where the ramp leads to; or at once.
    void aim(double torque) noexcept { target_ = torque; }
    void demand(double torque) noexcept { demand_ = torque; }
    /// counts/s beyond which the torque is taken back; infinity: nowhere.
    void limit_speed(double limit) noexcept;
    void offset(double torque) noexcept { offset_ = torque; }
    /// `dt` seconds of 6087h, `slope` in its raw unit a second.
    void ramp(const MotorControl& motor, std::int64_t slope, double dt) noexcept;

    [[nodiscard]] double demanded() const noexcept { return demand_; }
    [[nodiscard]] bool reached() const noexcept { return demand_ == target_; }
    /// What the motor gets in a torque mode.
    [[nodiscard]] double torque(const MotorControl& motor) const noexcept;
    /// What it gets beside the loops' `torque`.
    [[nodiscard]] double with_offset(const MotorControl& motor, double torque) const noexcept;

private:
    double target_ = 0, demand_ = 0, offset_ = 0;
    double fastest_ = 0;  ///< counts/s; 0 = no limit
};

}  // namespace taktwerk::axes::sim
