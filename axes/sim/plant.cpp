#include "axes/sim/plant.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace taktwerk::axes::sim {

Plant::Plant(const PlantConfig& config) noexcept
    : config_(config),
      rad_per_count_(2.0 * std::numbers::pi / static_cast<double>(config.counts_per_revolution)),
      position_(config.start),
      load_position_(config.start) {
    const double omega = 2.0 * std::numbers::pi * config.elastic.frequency;
    if (config.elastic.load_inertia > 0) stiffness_ = omega * omega * config.elastic.load_inertia;
}

void Plant::rescale(double factor) noexcept {
    auto& c = config_;
    for (double* count : {&c.start, &c.negative_stop, &c.positive_stop, &c.negative_limit, &c.positive_limit, &c.home_from, &c.home_to,
                          &c.index_pulse, &c.probe[0].from, &c.probe[0].to, &c.probe[0].every, &c.probe[1].from, &c.probe[1].to,
                          &c.probe[1].every, &position_, &velocity_, &load_position_, &load_velocity_})
        *count *= factor;
    c.counts_per_revolution = std::llround(static_cast<double>(c.counts_per_revolution) * factor);
    rad_per_count_ /= factor;
}

/// N m, of the twisted shaft on the motor.
double Plant::shaft_torque() const noexcept {
    return (stiffness_ * (load_position_ - position_) + config_.elastic.damping * (load_velocity_ - velocity_)) * rad_per_count_;
}

void Plant::step(double dt, double torque) noexcept {
    double inertia = config_.inertia;
    if (stiffness_ > 0) {
        const double shaft = shaft_torque();
        inertia -= config_.elastic.load_inertia;
        load_velocity_ -= (shaft + config_.load_torque) / config_.elastic.load_inertia / rad_per_count_ * dt;
        load_position_ += load_velocity_ * dt;
        torque += shaft + config_.load_torque;  // the weight hangs on the load: the motor feels it through the shaft
    }
    if (config_.cogging.amplitude > 0) torque -= config_.cogging.amplitude * std::sin(config_.cogging.periods * position_ * rad_per_count_);
    if (jammed_ || (held_ && velocity_ == 0)) {
        velocity_ = 0;
        return;
    }
    const double friction = config_.coulomb_friction + (held_ ? brake_friction * config_.rated_torque : 0);
    const double omega = velocity_ * rad_per_count_;
    const double driving = torque - config_.load_torque - config_.viscous_friction * omega;
    double next = 0;
    if (velocity_ == 0 && std::abs(driving) <= std::max(friction, config_.breakaway_torque)) {
        next = 0;  // sticks
    } else {
        const double direction = velocity_ != 0 ? (velocity_ > 0 ? 1.0 : -1.0) : (driving > 0 ? 1.0 : -1.0);
        const double net = driving - direction * friction;
        next = velocity_ + net / inertia / rad_per_count_ * dt;
        // Friction stops a motion, it never reverses one: within the step that crosses zero the axis stands.
        if (velocity_ != 0 && (next > 0) != (velocity_ > 0) && std::abs(driving) <= friction) next = 0;
    }
    velocity_ = next;
    position_ += velocity_ * dt;
    if (position_ < config_.negative_stop) {
        position_ = config_.negative_stop;
        if (velocity_ < 0) velocity_ = 0;
    } else if (position_ > config_.positive_stop) {
        position_ = config_.positive_stop;
        if (velocity_ > 0) velocity_ = 0;
    }
}

}  // namespace taktwerk::axes::sim
