#include "axes/axis/search_motion.hpp"

#include <algorithm>
#include <cmath>

#include "axes/axis/aim.hpp"
#include "axes/axis/homing_reference.hpp"

namespace taktwerk::axes {

SearchInput SearchMotion::input(const TriggerRef& reference) noexcept {
    const auto latch = runs_.latch.take(measured_.feedback);
    return {.signal = reference_.level(reference),
            .negative_limit = measured_.negative_switch,
            .positive_limit = measured_.positive_switch,
            .position = measured_.feedback.position,
            .latched = latch.has_value(),
            .latch = latch.value_or(0),
            .set_velocity = motion_.setpoint.state().velocity,
            .velocity = measured_.feedback.velocity / body_.units.counts_per_unit(),
            .torque = body_.config.gearing.inverted ? -measured_.feedback.torque : measured_.feedback.torque,
            .now = body_.now};
}

void SearchMotion::drive(const TriggerRef& reference, const MotionLimits& dynamics) noexcept {
    runs_.step.step(input(reference), measured_.feedback.fresh,
                    motion_.setpoint.at_rest() && motion_.setpoint.finished() && !motion_.goal_pending);
    const double velocity = runs_.step.velocity();
    const bool forbidden = (velocity > 0 && !body_.permit_positive) || (velocity < 0 && !body_.permit_negative);
    if (runs_.step.busy() && runs_.step.demand() == StepRun::Demand::velocity && forbidden) runs_.step.end(StepRun::End::not_permitted);
    if (!runs_.step.busy()) return;
    switch (runs_.step.demand()) {
        case StepRun::Demand::stop:
            if (motion_.goal.kind != Goal::Kind::stop) aim_.at_rest(dynamics);
            break;
        case StepRun::Demand::velocity: {
            // Homing has velocities of its own; only the axis' limit holds them down.
            const double speed = std::min(std::abs(velocity), body_.config.limits.velocity_towards(velocity));
            const double wanted = std::copysign(speed, velocity);
            if (motion_.goal.kind != Goal::Kind::velocity || motion_.goal.value != wanted)
                aim_.at(Goal::Kind::velocity, wanted, dynamics, VelocityLimiter::command);
            break;
        }
        case StepRun::Demand::place: {
            const double there = body_.units.local(runs_.step.place());
            if (motion_.goal.kind != Goal::Kind::position || motion_.goal.value != there)
                aim_.at(Goal::Kind::position, there, dynamics, VelocityLimiter::command);
            break;
        }
    }
}

}  // namespace taktwerk::axes
