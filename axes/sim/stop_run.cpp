#include "axes/sim/stop_run.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes::sim {

namespace {

/// The velocity loop takes the demanded speed down to 0, with no more than `limit` N m.
double slowed(MotorControl& motor, const StopOrder& order, double limit, double dt) noexcept {
    auto demand = motor.demand();
    const double most = order.at_once ? std::abs(demand.velocity) : order.ramp * dt;
    demand.velocity -= std::clamp(demand.velocity, -most, most);
    if (!motor.without_encoder()) demand.position += demand.velocity * dt;
    motor.demand(demand);
    return motor.velocity_torque(demand.velocity, 0, limit, dt);
}

}  // namespace

double StopRun::slowing_torque(MotorControl& motor, TorqueTarget& target, const AxisInputs& settings, double dt) const noexcept {
    switch (order_.by) {
        case StopBy::coast: return 0;
        case StopBy::dynamic_brake: return motor.brake_torque();
        case StopBy::torque_slope:
            target.aim(0);
            target.ramp(motor, settings.torque_slope, dt);
            return target.torque(motor);
        case StopBy::emergency_torque: {
            const double own = motor.torque_of(settings.emergency_torque);
            return slowed(motor, order_, own > 0 ? std::min(own, motor.torque_limit()) : motor.torque_limit(), dt);
        }
        case StopBy::ramp:
        case StopBy::quick_ramp:
        case StopBy::zero_speed: return slowed(motor, order_, motor.torque_limit(), dt);
    }
    return 0;
}

double StopRun::torque(MotorControl& motor, TorqueTarget& target, const StopView& view, double dt) noexcept {
    if (!done_) {
        const double torque = slowing_torque(motor, target, view.settings, dt);
        const bool by_speed = order_.by != StopBy::coast && order_.by != StopBy::dynamic_brake && order_.by != StopBy::torque_slope;
        done_ =
            motor.stands() && (!by_speed || motor.demand().velocity == 0) && (order_.by != StopBy::torque_slope || target.demanded() == 0);
        if (done_) motor.demand_rest();
        return torque;
    }
    const auto held = [&] { return motor.velocity_torque(0, 0, motor.torque_limit(), dt); };
    switch (order_.then) {
        case StopThen::lock: return motor.position_torque(view.zero, dt);
        case StopThen::clamp: return held();
        case StopThen::dynamic_brake: return view.enabled || winding_down_ ? held() : motor.brake_torque();
        case StopThen::free: break;
    }
    // While the brake still closes, or the state has not followed yet, the motor holds (SV33-E 3.1.2(3)).
    return view.enabled ? 0 : held();
}

bool StopRun::wind_down(const StopOrder& order, bool holds, Instant until) noexcept {
    phases_shorted_ = order.then == StopThen::dynamic_brake;
    winding_down_ = order.by != StopBy::coast || holds;
    winding_down_until_ = until;
    return winding_down_;
}

void StopRun::step(bool stands, Instant now, Duration hold) noexcept {
    if (!winding_down_) return;
    if (!stands) winding_down_until_ = now + hold;
    else if (now >= winding_down_until_) winding_down_ = false;
}

}  // namespace taktwerk::axes::sim
