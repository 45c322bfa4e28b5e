// MC_SetOverride: factors on what commands ask for. They act at once, by planning anew from the present state.

#include <cmath>

#include "axes/axis/axis_core.hpp"
#include "axes/axis/plannable.hpp"

namespace taktwerk::axes {

ErrorId AxisCore::set_override(const Override& factors) noexcept {
    const auto in_range = [](double factor) noexcept { return factor >= 0 && factor <= 1; };
    if (!in_range(factors.velocity) || !in_range(factors.acceleration) || !in_range(factors.jerk)) return ErrorId::invalid_override;
    if (factors.acceleration < least_share || factors.jerk < least_share) return ErrorId::invalid_override;
    auto taken = factors;
    if (taken.velocity < least_share) taken.velocity = 0;  // the end of a filter that never reaches it
    if (taken == override_) return ErrorId::none;          // called each scan
    override_ = taken;
    goal_.kept = false;
    // A coupling that has just been commanded may have to wait.
    if (override_counts() && (!begin_pending_ || couples(queue_.active().command.kind))) goal_pending_ = true;
    if (queue_.beside(SideSlot::superimposed) != 0) superimposed_.pending = true;
    publish();
    return ErrorId::none;
}

/// Not where the axis follows a master (P1-208) or a table over time (P1-211), stops, or searches its reference with velocities of its own; nor
/// on a velocity that a released slave keeps (P1-271). While a coupling waits, the motion before goes on, and its override with it (P1-281).
bool AxisCore::override_counts() const noexcept {
    const auto kind = queue_.active().command.kind;
    if (kind == CommandKind::velocity_profile || kind == CommandKind::acceleration_profile) return false;
    const bool moves = goal_.kind == Goal::Kind::position || goal_.kind == Goal::Kind::velocity;
    const bool commanded = view_.state == AxisState::DiscreteMotion || view_.state == AxisState::ContinuousMotion ||
                           view_.state == AxisState::SynchronizedMotion;
    return moves && commanded && !goal_.kept && goal_.limiter != VelocityLimiter::software_limit;
}

/// Ramps only: what a velocity means depends on the kind of motion.
MotionLimits AxisCore::with_override(const MotionLimits& limits) const noexcept {
    if (!override_counts()) return limits;
    return {limits.velocity, limits.acceleration * override_.acceleration, limits.deceleration * override_.acceleration,
            limits.jerk * override_.jerk};
}

}  // namespace taktwerk::axes
