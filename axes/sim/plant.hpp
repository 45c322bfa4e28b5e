#pragma once
// Motor and load of a simulated axis: torque in, position out. Semi-implicit Euler at a fixed inner step, so that results do
// not depend on when somebody looks. Allocation-free.

#include <cmath>

#include "axes/sim/plant_config.hpp"

namespace taktwerk::axes::sim {

class Plant {
public:
    explicit Plant(const PlantConfig& config) noexcept;

    /// One inner step of `dt` seconds with `torque` N m at the shaft (0 = motor free).
    void step(double dt, double torque) noexcept;

    [[nodiscard]] double position() const noexcept { return position_; }  ///< counts, machine coordinates
    [[nodiscard]] double velocity() const noexcept { return velocity_; }  ///< counts/s
    /// counts; of an elastic load, else the motor's.
    [[nodiscard]] double load_position() const noexcept { return stiffness_ > 0 ? load_position_ : position_; }
    [[nodiscard]] bool negative_limit() const noexcept { return position_ <= config_.negative_limit; }
    [[nodiscard]] bool positive_limit() const noexcept { return position_ >= config_.positive_limit; }
    [[nodiscard]] bool home_switch() const noexcept {
        const auto& c = config_;
        if (c.home_from > c.home_to) return false;
        const double in = position_ - c.home_from, length = c.home_to - c.home_from;
        return c.home_every > 0 ? in - std::floor(in / c.home_every) * c.home_every <= length : in >= 0 && in <= length;
    }
    [[nodiscard]] const PlantConfig& config() const noexcept { return config_; }
    /// The drive counts `factor` times as many counts for the same way: the mechanics stay where they are.
    void rescale(double factor) noexcept;
    /// A jammed mechanism does not move whatever the torque.
    void jam(bool jammed) noexcept { jammed_ = jammed; }
    /// A holding brake: an axis at rest stays there whatever the torque, a turning one is slowed by `brake_friction`. Called each step; apart
    /// from a jam.
    void hold(bool held) noexcept { held_ = held; }
    /// Torque that accelerates the load by `counts_per_s2`, without friction: what a tuned drive feeds forward.
    [[nodiscard]] double torque_for(double counts_per_s2) const noexcept { return counts_per_s2 * rad_per_count_ * config_.inertia; }

    static constexpr double brake_friction = 2;  ///< rated torques

private:
    [[nodiscard]] double shaft_torque() const noexcept;

    PlantConfig config_;
    double rad_per_count_;
    double position_, velocity_ = 0;
    double stiffness_ = 0;                      // N m/rad, of the shaft to an elastic load
    double load_position_, load_velocity_ = 0;  // counts, counts/s; of it
    bool jammed_ = false, held_ = false;
};

}  // namespace taktwerk::axes::sim
