#pragma once
// A stepping motor without an encoder: the drive turns a field, the rotor is drawn after it like a mass on a magnetic spring. A load below the
// pull-out torque only makes it lag; beyond that it falls back by whole electrical periods and is caught again. Steps are lost then, and the
// drive, which knows its own command only, does not notice (SE-808X 2.4: no encoder on open-loop motors).
//
// The motor is taken to be a hybrid one with 50 rotor teeth: 200 full steps are the coarsest setting of the SE-808X (1.3, 4.4), and four of
// them are one period. Its pull-out torque is the greatest torque of the plant. At standstill the drive holds it with less current (4.4,
// 2000h:1B); how long it waits for that is not stated.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "axes/sim/plant.hpp"
#include "axes/sim/servo_loop.hpp"

namespace taktwerk::axes::sim {

class OpenLoopMotor {
public:
    static constexpr double periods_per_turn = 50;  ///< electrical periods; a slip costs a whole number of them
    static constexpr double standby_after = 0.5;    ///< s of standstill

    /// `standby`: share of the pull-out torque that is left at standstill.
    explicit OpenLoopMotor(double standby) noexcept : standby_(standby) {}

    /// Torque of the field at `field` on the rotor for one inner step; `pull_out` N m is the most there is.
    [[nodiscard]] double torque(const Plant& plant, const Demand& field, double pull_out, double dt) noexcept {
        stood_ = field.velocity == 0 ? stood_ + dt : 0;
        const double most = stood_ >= standby_after ? pull_out * standby_ : pull_out;
        const double turn = static_cast<double>(plant.config().counts_per_revolution);
        const double angle = 2 * std::numbers::pi * periods_per_turn * (field.position - plant.position()) / turn;
        // What swings after a step dies out: losses in motor and current loop, here 0.3 of the critical damping, a tenth of the torque at most,
        // so that a rotor which has fallen out of step is not dragged along.
        const double stiffness = most * periods_per_turn;  // N m/rad around the field
        const double inertia = plant.config().inertia;
        const double slip = plant.torque_for(field.velocity - plant.velocity()) / inertia;  // rad/s
        const double damping = std::clamp(2 * damping_ratio * std::sqrt(stiffness * inertia) * slip, -0.1 * most, 0.1 * most);
        return std::clamp(most * std::sin(angle) + damping, -most, most);
    }
    /// The field is off.
    void release() noexcept { stood_ = 0; }

private:
    static constexpr double damping_ratio = 0.3;
    double standby_;
    double stood_ = 0;  ///< s
};

}  // namespace taktwerk::axes::sim
