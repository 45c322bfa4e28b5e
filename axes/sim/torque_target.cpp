#include "axes/sim/torque_target.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes::sim {

namespace {

constexpr std::int64_t torque_at_once = 0xFFFFFFFF;  // 6087h (SV33-E 7.3: default 2^32 - 1)

}  // namespace

void TorqueTarget::limit_speed(double limit) noexcept { fastest_ = std::isfinite(limit) ? limit : 0; }

void TorqueTarget::ramp(const MotorControl& motor, std::int64_t slope, double dt) noexcept {
    if (slope < 0 || slope == torque_at_once) {
        demand_ = target_;
        return;
    }
    const double most = motor.torque_of(slope) * dt;
    demand_ += std::clamp(target_ - demand_, -most, most);
}

double TorqueTarget::torque(const MotorControl& motor) const noexcept {
    return ServoLoop::torque_control(motor.plant(), demand_, fastest_, motor.torque_limit());
}

double TorqueTarget::with_offset(const MotorControl& motor, double torque) const noexcept {
    return std::clamp(torque + offset_, -motor.torque_limit(), motor.torque_limit());
}

}  // namespace taktwerk::axes::sim
