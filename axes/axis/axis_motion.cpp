#include "axes/axis/axis_motion.hpp"

#include "axes/axis/command_kinds.hpp"
#include "axes/axis/plannable.hpp"

namespace taktwerk::axes {

ErrorId AxisMotion::take_override(const Override& wanted, bool& changed) noexcept {
    const auto in_range = [](double factor) noexcept { return factor >= 0 && factor <= 1; };
    if (!in_range(wanted.velocity) || !in_range(wanted.acceleration) || !in_range(wanted.jerk)) return ErrorId::invalid_override;
    if (wanted.acceleration < least_share || wanted.jerk < least_share) return ErrorId::invalid_override;
    auto taken = wanted;
    if (taken.velocity < least_share) taken.velocity = 0;  // the end of a filter that never reaches it
    changed = !(taken == asked);                           // called each scan
    if (!changed) return ErrorId::none;
    asked = taken;
    join_overrides();
    return ErrorId::none;
}

ErrorId AxisMotion::take_operators_override(double wanted, bool& changed) noexcept {
    if (!(wanted >= 0 && wanted <= 1)) return ErrorId::invalid_override;
    const double taken = wanted < least_share ? 0 : wanted;
    changed = taken != operators;
    if (!changed) return ErrorId::none;
    operators = taken;
    join_overrides();
    return ErrorId::none;
}

void AxisMotion::join_overrides() noexcept {
    const double velocity = asked.velocity * operators;
    factors = {velocity < least_share ? 0 : velocity, asked.acceleration, asked.jerk};
    goal.kept = false;
    // A coupling that has just been commanded may have to wait.
    if (override_counts() && (!body.begin_pending || couples(body.queue.active().command.kind))) goal_pending = true;
}

/// Not where the axis follows a master (P1-208) or a table over time (P1-211), stops, or searches its reference with velocities of its own; nor
/// on a velocity that a released slave keeps (P1-271). While a coupling waits, the motion before goes on, and its override with it (P1-281).
bool AxisMotion::override_counts() const noexcept {
    const auto kind = body.queue.active().command.kind;
    if (kind == CommandKind::velocity_profile || kind == CommandKind::acceleration_profile) return false;
    const bool moves = goal.kind == Goal::Kind::position || goal.kind == Goal::Kind::velocity;
    const bool commanded =
        body.state == AxisState::DiscreteMotion || body.state == AxisState::ContinuousMotion || body.state == AxisState::SynchronizedMotion;
    return moves && commanded && !goal.kept && goal.limiter != VelocityLimiter::software_limit;
}

MotionLimits AxisMotion::with_override(const MotionLimits& limits) const noexcept {
    if (!override_counts()) return limits;
    return {limits.velocity, limits.acceleration * factors.acceleration, limits.deceleration * factors.acceleration,
            limits.jerk * factors.jerk};
}

bool AxisMotion::base_comes_to_rest() const noexcept {
    const bool no_speed = override_counts() && factors.velocity == 0;
    return goal.kind == Goal::Kind::stop || (goal.kind == Goal::Kind::velocity && (goal.value == 0 || no_speed)) ||
           (goal.kind == Goal::Kind::position && no_speed);
}

}  // namespace taktwerk::axes
