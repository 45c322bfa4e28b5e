#pragma once
// The control loops inside a simulated drive: position P with velocity feed-forward, velocity PI with acceleration
// feed-forward, torque limit. Gains (ServoGains) are those of a plainly tuned servo; they give a small, honest following error.

#include <algorithm>

#include "axes/sim/plant.hpp"

namespace taktwerk::axes::sim {

struct Demand {
    double position = 0;      ///< counts
    double velocity = 0;      ///< counts/s
    double acceleration = 0;  ///< counts/s2
};

class ServoLoop {
public:
    /// Torque for one inner step, limited to +- limit N m. `measured` is the quantised encoder position.
    [[nodiscard]] double position_control(const Plant& plant, const Demand& demand, double measured, double limit, double dt) noexcept {
        const auto& gains = plant.config().gains;
        const double wanted = gains.feed_forward * demand.velocity + gains.position * (demand.position - measured);
        return velocity_control(plant, wanted, demand.acceleration, limit, dt);
    }
    [[nodiscard]] double velocity_control(const Plant& plant, double wanted, double acceleration, double limit, double dt) noexcept {
        const double error = wanted - plant.velocity();
        const double raw = plant.torque_for(acceleration + plant.config().gains.velocity * error) + integral_;
        if (raw > limit) return limit;
        if (raw < -limit) return -limit;
        integral_ += plant.torque_for(plant.config().gains.integral * error) * dt;  // only while unlimited: no wind-up
        return raw;
    }
    /// Torque as demanded, taken back where the motor gets faster than `fastest` counts/s (0 = no limit).
    [[nodiscard]] static double torque_control(const Plant& plant, double wanted, double fastest, double limit) noexcept {
        double torque = std::clamp(wanted, -limit, limit);
        if (fastest > 0) {
            torque = std::min(torque, plant.torque_for(plant.config().gains.velocity * (fastest - plant.velocity())));
            torque = std::max(torque, plant.torque_for(plant.config().gains.velocity * (-fastest - plant.velocity())));
        }
        return std::clamp(torque, -limit, limit);
    }
    void reset() noexcept { integral_ = 0; }
    /// Goes on from a torque that somebody else gave: the motor feels no change of the mode.
    void take_over(double torque) noexcept { integral_ = torque; }

private:
    double integral_ = 0;
};

}  // namespace taktwerk::axes::sim
