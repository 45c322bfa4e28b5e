// Limits that no set-point passes, whatever made it: switches, permitted directions, software limits. They look at the total.

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

namespace {

/// More than a stop from there takes, whatever its acceleration is on: cheap, for every cycle.
double stops_within(const MotionState& state, const AxisLimits& limits) noexcept {
    const double ease = 1 / limits.jerk;
    const double a = std::abs(state.acceleration);
    const double speed = std::abs(state.velocity) + a * a * ease / 2;
    return speed * (a * ease + (speed / limits.deceleration + std::max(limits.deceleration, a) * ease));
}

/// The acceleration that brakes a motion in `sense` turns it round while it runs out.
bool turns_back(const MotionState& from, const MotionLimits& limits, double sense) noexcept {
    const double speed = sense * from.velocity, braking = -sense * from.acceleration;
    return speed > 0 && braking > 0 && braking * braking > 2 * limits.jerk * speed;
}

/// How far a stop gets in `sense`, u. Where the acceleration drives the axis back, the stop ends on this side of that.
double reach_of_stop(const MotionState& from, const MotionLimits& limits, double sense) noexcept {
    if (!turns_back(from, limits, sense)) return sense * stopping_distance(from, limits);
    const double speed = sense * from.velocity, braking = -sense * from.acceleration;
    const double turns = braking * braking - 2 * limits.jerk * speed;
    const double time = 2 * speed / (braking + std::sqrt(turns));  // until it turns, the acceleration running out
    return time * (speed + time * (limits.jerk * time / 6 - braking / 2));
}

}  // namespace

void AxisCore::guard(const MotionState& before, Duration period) noexcept {
    if (view_.state == AxisState::Homing || (goal_.kind == Goal::Kind::rest && !setpoint_.layered())) return;
    if (!guard_switches() && !guard_software_limits(before)) return;
    setpoint_.restore(before);
    run_goal(0);
    setpoint_.advance(period);
}

bool AxisCore::guard_switches() noexcept { return guard_limit_switches() || guard_permits(); }

bool AxisCore::guard_limit_switches() noexcept {
    const double velocity = setpoint_.state().velocity;
    if (!(velocity > 0 ? positive_switch_ : velocity < 0 && negative_switch_)) return false;
    if (view_.state == AxisState::ErrorStop && goal_.kind == Goal::Kind::stop) return false;  // it brakes as hard as it can
    fail(velocity > 0 ? AxisAlarm::positive_limit_switch : AxisAlarm::negative_limit_switch, units_.to_program(setpoint_.state().position));
    aim_at_rest(stop_limits(config_.limits));  // also on the way to a software limit
    return true;
}

/// A command that moves on ends; one that stops goes on, as hard as the axis does by itself.
bool AxisCore::guard_permits() noexcept {
    if (!barred(setpoint_.state().velocity)) return false;
    if (goal_.kind != Goal::Kind::stop || setpoint_.layered()) {
        queue_.finish_active(Outcome::error, ErrorId::interlocked);
        halt_on_own_account();
        return true;
    }
    const auto hard = full_limits(config_.limits);
    auto& soft = goal_.limits;
    if (soft.deceleration >= hard.deceleration && soft.jerk >= hard.jerk) return false;
    soft.deceleration = std::max(soft.deceleration, hard.deceleration);
    soft.jerk = std::max(soft.jerk, hard.jerk);
    goal_pending_ = true;
    return true;
}

bool AxisCore::guard_software_limits(const MotionState& before) noexcept {
    const bool stops_inside = goal_.kind == Goal::Kind::stop && refuse_place(units_.to_program(setpoint_.end().position)) == ErrorId::none;
    const bool base_might_pass = watch_limits_ && goal_.kind != Goal::Kind::rest && !stops_inside;
    if (!(base_might_pass || setpoint_.layered()) || !software_limits_hold() || goal_.limiter == VelocityLimiter::software_limit)
        return false;
    const auto& next = setpoint_.state();
    if ((next.velocity == 0 && next.acceleration == 0) || (!base_might_pass && sum_stays_inside())) return false;
    auto limits = full_limits(config_.limits);
    // What is planned to end on the limit must not be taken for more because of its last digits.
    const double surely = goal_.kind == Goal::Kind::velocity ? 1 : 1 - 1e-9;
    // Also the one in the back of an axis that is turning round: two layers may do that harder than one can brake.
    double sense = 0, edge = 0, edge_local = 0;
    for (const double way : {1.0, -1.0}) {
        const double limit = way > 0 ? config_.limits.position_max : config_.limits.position_min;
        const double local = units_.to_local(limit);
        const double room = way * (local - next.position);
        if (room > stops_within(next, config_.limits)) continue;
        const double reach = reach_of_stop(next, limits, way);
        if (reach <= 0 || reach * surely <= room) continue;
        sense = way;
        edge = limit;
        edge_local = local;
    }
    if (sense == 0) return false;

    // One period ago stopping was still possible: from there the way to the limit ends exactly on it.
    double fastest = std::max(std::abs(next.velocity), std::abs(before.velocity));
    if (sense * next.velocity <= 0)  // what it cannot help having once it has turned
        fastest = std::max(fastest, sense * next.velocity + next.acceleration * next.acceleration / (2 * limits.jerk));
    limits.velocity = std::min(limits.velocity, fastest);
    // A jog ends there and is done; whatever else was to go further is cut off.
    if (view_.state != AxisState::ErrorStop && queue_.active().command.kind != CommandKind::jog)
        fail(AxisAlarm::software_limit_reached, units_.to_program(before.position), edge);
    // An addition that began in this very cycle has not moved yet: it is not two motions that became one.
    const bool two = summed_ || setpoint_.superimposed_has_moved(cycle_);
    end_superimposed(Outcome::error, ErrorId::beyond_software_limit);
    summed_ = summed_ && two;
    const double room = sense * (edge_local - before.position);
    brake_as_both_layers(before, sense, room, limits);
    // Coordinates were moved and the limit with them (MC_SetPosition, homing in motion): no stop turns round to run back to it.
    constexpr double rounding = 1e-6;
    if (const double reach = reach_of_stop(before, limits, sense); reach * (1 - rounding) > room && reach > 0) {
        aim_at_rest(stop_limits(config_.limits));
        return true;
    }
    // Also in ErrorStop: its own stop might be softer and pass the limit.
    aim(Goal::Kind::position, edge_local, limits, VelocityLimiter::software_limit);
    return true;
}

/// Both layers are on their way to rest, and whatever part of its way each has done, the sum is inside: then it may brake with both ramps
/// at once, harder than the axis would alone.
bool AxisCore::sum_stays_inside() const noexcept {
    if (setpoint_.end().velocity != 0) return false;
    const double base = setpoint_.base().position, part = setpoint_.superimposed().position;
    const double base_way = setpoint_.end().position - base, part_way = setpoint_.superimposed_rest();
    const double highest = base + part + std::max(base_way, 0.0) + std::max(part_way, 0.0);
    const double lowest = base + part + std::min(base_way, 0.0) + std::min(part_way, 0.0);
    const double rounding = 1e-12 * (std::abs(highest) + std::abs(lowest));
    return highest <= units_.to_local(config_.limits.position_max) + rounding &&
           lowest >= units_.to_local(config_.limits.position_min) - rounding;
}

/// Ramps that would carry the axis past a software limit become as hard as the axis can.
void AxisCore::brake_inside_limits(const MotionState& from, MotionLimits& limits) const noexcept {
    if (!software_limits_hold() || (from.velocity == 0 && from.acceleration == 0)) return;
    for (const double sense : {1.0, -1.0}) {
        const double edge = units_.to_local(sense > 0 ? config_.limits.position_max : config_.limits.position_min);
        const double room = sense * (edge - from.position);
        if (room > stops_within(from, {.deceleration = limits.deceleration, .jerk = limits.jerk})) continue;
        // What turns back in front of the limit was within it by that only: the next command could not rely on it.
        const double reach = reach_of_stop(from, limits, sense);
        if (reach <= 0 || (reach <= room && !turns_back(from, limits, sense))) continue;
        limits.deceleration = std::max(limits.deceleration, config_.limits.deceleration);
        limits.jerk = std::max(limits.jerk, config_.limits.jerk);
        brake_as_both_layers(from, sense, room, limits);
    }
}

/// Two layers brake with a ramp each (P1-155). What they would have stopped within, one motion of both does with twice the ramps: the sum of
/// theirs is no harder. Where a new one moves on top it has its own, and the base one: no more than two.
double AxisCore::layers_in_base() const noexcept { return summed_ && setpoint_.superimposed_finished() ? 2 : 1; }

void AxisCore::brake_as_both_layers(const MotionState& from, double sense, double room, MotionLimits& limits) const noexcept {
    if (layers_in_base() == 1 || reach_of_stop(from, limits, sense) <= room) return;
    limits.deceleration = std::max(limits.deceleration, layers_in_base() * config_.limits.deceleration);
    limits.jerk = std::max(limits.jerk, layers_in_base() * config_.limits.jerk);
}

/// The acceleration the axis has now was built up with another jerk. Taken away with a smaller one it would carry the velocity beyond the
/// axis' limit, also through zero to the one of the other sense: then it is taken away as fast as that needs.
bool AxisCore::release_below_limit(const MotionState& from, MotionLimits& limits) const noexcept {
    if (from.acceleration == 0) return false;
    const double sense = from.acceleration > 0 ? 1 : -1;
    const double beside = superimposed_reach(sense);
    const double room = config_.limits.velocity - beside - sense * from.velocity;
    const double needed = from.acceleration * from.acceleration / 2;
    if (needed <= limits.jerk * room) return false;
    constexpr double surely = 1 + 1e-9;
    const double most = config_.limits.jerk * layers_in_base();
    limits.jerk = std::max(limits.jerk, room > 0 ? std::min(surely * needed / room, most) : most);
    return true;
}

/// Does it go further than both its ends and the software limits?
bool AxisCore::leaves_limits(const Profile& profile) const noexcept {
    if (!software_limits_hold()) return false;
    const double low = units_.to_local(config_.limits.position_min);
    const double high = units_.to_local(config_.limits.position_max);
    const auto outside = [&](double position) noexcept { return position < low || position > high; };
    if (profile.end().velocity != 0) return true;  // it goes on
    for (int i = 0; i < profile.piece_count(); ++i) {
        const double begin = profile.piece_begin(i);
        const double length = profile.piece_end(i) - begin;
        const auto first = profile.on_piece(i, begin);
        const auto last = profile.on_piece(i, begin + length);
        // Inside a piece the position turns where the velocity is 0; no further away than the way at its highest speed.
        const double jerk = profile.piece_jerk(i);
        const double top = jerk != 0 ? -first.acceleration / jerk : -1;  // where the acceleration is 0
        const double extreme = top > 0 && top < length ? first.velocity + first.acceleration * top / 2 : first.velocity;
        const double most = length * std::max({std::abs(first.velocity), std::abs(last.velocity), std::abs(extreme)});
        const bool turns = first.velocity * last.velocity < 0 || first.velocity * extreme < 0;
        if (i > 0 && outside(first.position)) return true;
        if (turns && (outside(first.position - most) || outside(first.position + most))) return true;
    }
    return false;
}

}  // namespace taktwerk::axes
