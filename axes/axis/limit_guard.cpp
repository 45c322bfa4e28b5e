#include "axes/axis/limit_guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/axis/aim.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/conduct.hpp"
#include "axes/axis/direction_limits.hpp"
#include "axes/axis/software_limits.hpp"
#include "axes/axis/stop_reach.hpp"
#include "axes/axis/superimposed_motion.hpp"
#include "axes/axis/targets.hpp"

namespace taktwerk::axes {

namespace {

constexpr double dead_cycles = 5;  // from seeing that a torque must end to the first cycle that brakes
constexpr double too_fast = 1.2;   // times the velocity limit: more than a loop overshoots

}  // namespace

bool LimitGuard::watch(const MotionState& before, Duration period) noexcept {
    if (body_.state == AxisState::Homing || (motion_.goal.kind == Goal::Kind::rest && !motion_.setpoint.layered())) return false;
    if (!switches() && !guard_software_limits(before)) return false;
    motion_.setpoint.restore(before);
    conduct_.run_goal(0);
    motion_.setpoint.advance(period);
    return true;
}

bool LimitGuard::switches() noexcept { return limit_switches() || guard_permits(); }

bool LimitGuard::limit_switches() noexcept {
    const double velocity = motion_.setpoint.state().velocity;
    if (!(velocity > 0 ? measured_.positive_switch : velocity < 0 && measured_.negative_switch)) return false;
    if (body_.state == AxisState::ErrorStop && motion_.goal.kind == Goal::Kind::stop) return false;  // it brakes as hard as it can
    conduct_.fail(velocity > 0 ? AxisAlarm::positive_limit_switch : AxisAlarm::negative_limit_switch,
                  body_.units.to_program(motion_.setpoint.state().position));
    aim_.at_rest(stop_limits(body_.config.limits));  // also on the way to a software limit
    return true;
}

/// A command that moves on ends; one that stops goes on, as hard as the axis does by itself.
bool LimitGuard::guard_permits() noexcept {
    if (!body_.barred(motion_.setpoint.state().velocity)) return false;
    if (motion_.goal.kind != Goal::Kind::stop || motion_.setpoint.layered()) {
        body_.queue.finish_active(Outcome::error, ErrorId::interlocked);
        conduct_.halt_on_own_account();
        return true;
    }
    const auto hard = full_limits(body_.config.limits);
    auto& soft = motion_.goal.limits;
    if (soft.deceleration >= hard.deceleration && soft.jerk >= hard.jerk) return false;
    soft.deceleration = std::max(soft.deceleration, hard.deceleration);
    soft.jerk = std::max(soft.jerk, hard.jerk);
    motion_.goal_pending = true;
    return true;
}

bool LimitGuard::guard_software_limits(const MotionState& before) noexcept {
    const bool stops_inside = motion_.goal.kind == Goal::Kind::stop &&
                              targets_.refuse_place(body_.units.to_program(motion_.setpoint.end().position)) == ErrorId::none;
    const bool base_might_pass = motion_.watch_limits && motion_.goal.kind != Goal::Kind::rest && !stops_inside;
    if (!(base_might_pass || motion_.setpoint.layered()) || !body_.software_limits_hold() ||
        motion_.goal.limiter == VelocityLimiter::software_limit)
        return false;
    const auto& next = motion_.setpoint.state();
    if ((next.velocity == 0 && next.acceleration == 0) || (!base_might_pass && limits_.sum_stays_inside())) return false;
    auto limits = full_limits(body_.config.limits);
    // What is planned to end on the limit must not be taken for more because of its last digits.
    const bool planned = motion_.goal.kind != Goal::Kind::velocity;
    const double surely = planned ? 1 - 1e-9 : 1;
    // Also the one in the back of an axis that is turning round: two layers may do that harder than one can brake.
    double sense = 0, edge = 0, edge_local = 0;
    for (const double way : {1.0, -1.0}) {
        const double limit = way > 0 ? body_.config.limits.position_max : body_.config.limits.position_min;
        const double local = body_.units.to_local(limit);
        const double room = way * (local - next.position);
        if (room > stops_within(next, body_.config.limits)) continue;
        const double reach = reach_of_stop(next, in_each_direction(limits, body_.config.limits), way);
        // Within microseconds of its end the room is a difference of some last digits, and more of them than of what is left.
        const double grain = planned ? 8 * std::numeric_limits<double>::epsilon() * std::max(std::abs(local), std::abs(next.position)) : 0;
        if (reach <= 0 || reach * surely <= room + grain) continue;
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
    if (body_.state != AxisState::ErrorStop && body_.queue.active().command.kind != CommandKind::jog)
        conduct_.fail(AxisAlarm::software_limit_reached, body_.units.to_program(before.position), edge);
    // An addition that began in this very cycle has not moved yet: it is not two motions that became one.
    const bool two = motion_.summed || motion_.setpoint.superimposed_has_moved(body_.cycle);
    addition_.end(Outcome::error, ErrorId::beyond_software_limit);
    motion_.summed = motion_.summed && two;
    const double room = sense * (edge_local - before.position);
    limits_.brake_as_both_layers(before, sense, room, limits);
    // Coordinates were moved and the limit with them (MC_SetPosition, homing in motion): no stop turns round to run back to it.
    constexpr double rounding = 1e-6;
    if (const double reach = reach_of_stop(before, in_each_direction(limits, body_.config.limits), sense);
        reach * (1 - rounding) > room && reach > 0) {
        aim_.at_rest(stop_limits(body_.config.limits));
        return true;
    }
    // Also in ErrorStop: its own stop might be softer and pass the limit.
    aim_.at(Goal::Kind::position, edge_local, limits, VelocityLimiter::software_limit);
    return true;
}

void LimitGuard::motor(const MotionLimits& braking) noexcept {
    if (body_.state == AxisState::ErrorStop || limit_switches()) return;
    const bool stops = body_.state == AxisState::Stopping || motion_.halts_alone();
    if ((!stops && guard_permits()) || !body_.software_limits_hold()) return;
    auto reach = motion_.setpoint.state();
    if (reach.velocity == 0) return;
    const auto& drive = body_.port.capabilities();
    const double delay = dead_cycles * to_seconds(body_.cycle) + to_seconds(drive.mode_change_delay + body_.round_trip());
    // Until then it may get faster, up to the velocity commanded: by its torque, or along the ramp of the drive.
    const double sense = reach.velocity > 0 ? 1 : -1, speed = std::abs(reach.velocity);
    double push = 0, most = speed;
    if (modes_.phase == ModePhase::torque) {
        push = sense * modes_.torque.torque() * body_.config.control.rated_acceleration;
        most = modes_.torque_velocity;
    } else if (modes_.phase == ModePhase::profile && modes_.run.mode() == DriveMode::profile_velocity) {
        push = modes_.run.setpoint().acceleration / std::abs(body_.units.counts_per_unit());
        most = sense * modes_.run.setpoint().velocity / body_.units.counts_per_unit();
    }
    const double gain = std::clamp(push * delay, 0.0, std::max(most - speed, 0.0));
    reach.position += (reach.velocity + sense * gain / 2) * delay;
    reach.velocity += sense * gain;
    const double end = body_.units.to_program(reach.position + stopping_distance(reach, in_each_direction(braking, body_.config.limits)));
    const double edge = reach.velocity > 0 ? body_.config.limits.position_max : body_.config.limits.position_min;
    if (reach.velocity > 0 ? end > edge : end < edge)
        conduct_.fail(AxisAlarm::software_limit_reached, body_.units.to_program(motion_.setpoint.state().position), edge);
}

bool LimitGuard::drive_speed(double velocity) noexcept {
    const double most = body_.config.limits.velocity_towards(velocity);
    if (!(std::abs(velocity) > too_fast * most)) return false;
    conduct_.fail(AxisAlarm::drive_too_fast, std::abs(velocity), most);
    return true;
}

}  // namespace taktwerk::axes
