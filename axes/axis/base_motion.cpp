#include "axes/axis/base_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "axes/axis/command_check.hpp"
#include "axes/axis/direction_limits.hpp"
#include "axes/axis/given_motion.hpp"
#include "axes/axis/junction.hpp"
#include "axes/axis/software_limits.hpp"
#include "axes/axis/stop_ramp.hpp"
#include "axes/axis/superimposed_motion.hpp"
#include "axes/axis/targets.hpp"

namespace taktwerk::axes {

namespace {

/// Limits lowered since the command came hold from here on. A stop, and the way to a software limit, are as hard as they have to be.
template <class Goal>
void hold_to_limits(Goal& goal, const AxisLimits& now, double from) noexcept {
    const bool velocity = goal.kind == Goal::Kind::velocity;
    if ((!velocity && goal.kind != Goal::Kind::position) || goal.limiter == VelocityLimiter::software_limit) return;
    auto& limits = goal.limits;
    const double wanted = velocity ? std::abs(goal.value) : limits.velocity;
    limits = {std::min(limits.velocity, now.velocity), std::min(limits.acceleration, now.acceleration),
              std::min(limits.deceleration, now.deceleration), std::min(limits.jerk, now.jerk)};
    const double most = now.velocity_towards(velocity ? goal.value : goal.value - from);
    if (wanted <= most) return;
    if (velocity) goal.value = std::copysign(most, goal.value);
    goal.limiter = VelocityLimiter::axis_limit;
}

}  // namespace

bool BaseMotion::plan_goal(double late) noexcept {
    if (addition_.abandoned_moves() && motion_.base_comes_to_rest()) {
        stop_as_one();
        late = 0;  // both are where they are now
    }
    motion_.goal_pending = motion_.held = false;
    motion_.wants_speed = motion_.folded_jerk = 0;
    auto from = motion_.setpoint.base();
    hold_to_limits(motion_.goal, body_.config.limits, from.position);
    auto limits = motion_.with_override(motion_.goal.limits);
    if (motion_.goal.kind == Goal::Kind::stop && from.velocity * from.acceleration > 0) {
        // What speeds up loses its acceleration with the jerk it was built up with, at once where none limited that: with less the axis would get
        // faster after the stop than it was ever meant to.
        if (std::isfinite(motion_.goal.former_jerk)) {
            limits.jerk = std::max(limits.jerk, motion_.goal.former_jerk);
        } else {
            from.acceleration = 0;
            motion_.setpoint.set(from);
        }
    }
    motion_.releases = limits_.release_below_limit(from, limits);
    Plan plan;
    switch (motion_.goal.kind) {
        case Goal::Kind::rest:
        case Goal::Kind::coupled: return true;
        case Goal::Kind::given: given_.start(late); return true;
        case Goal::Kind::position: plan = plan_way(from, limits, body_.config.limits.velocity_towards(motion_.goal.end_velocity)); break;
        case Goal::Kind::velocity: {
            const double velocity = motion_.override_counts() ? motion_.goal.value * motion_.factors.velocity : motion_.goal.value;
            if (velocity == 0) limits = never_reversing(from, limits, to_seconds(body_.cycle));
            limits_.brake_inside_limits(from, limits);
            plan = plan_to_velocity(from, velocity, in_each_direction(limits, body_.config.limits));
            motion_.watch_limits = true;
            break;
        }
        case Goal::Kind::stop:
            limits = never_reversing(from, limits, to_seconds(body_.cycle));
            limits_.brake_inside_limits(from, limits);
            plan = plan_stop(from, in_each_direction(limits, body_.config.limits));
            motion_.watch_limits = false;
            break;
    }
    if (motion_.setpoint.layered()) wait_for_room(from, limits, plan);
    if (plan.error != PlanError::none) return false;
    run_profile(plan, late);
    return true;
}

/// `most`: u/s that also an end velocity may not pass.
Plan BaseMotion::plan_way(const MotionState& from, MotionLimits limits, double most) noexcept {
    // A new target with gentle dynamics must not carry a fast axis past a software limit on its way back.
    limits_.brake_inside_limits(from, limits);
    if (motion_.override_counts()) {
        motion_.held = motion_.factors.velocity == 0;
        limits.velocity *= motion_.factors.velocity;
    }
    Plan plan;
    if (motion_.held) {
        limits.velocity = body_.config.limits.velocity;
        plan = plan_stop(from, in_each_direction(never_reversing(from, limits, to_seconds(body_.cycle)), body_.config.limits));
    } else if (motion_.goal.goes_on) {
        const double factor = motion_.override_counts() ? motion_.factors.velocity : 1;
        const double end = std::clamp(motion_.goal.end_velocity * factor, -most, most);
        plan = plan_through(from, {motion_.goal.value, end, 0}, in_each_direction(limits, body_.config.limits));
    } else if (const double through = velocity_at_junction(from, limits); through != 0) {
        plan = plan_through(from, {motion_.goal.value, through, 0}, in_each_direction(limits, body_.config.limits));
    } else {
        plan = plan_to_position(from, motion_.goal.value, in_each_direction(limits, body_.config.limits));
    }
    motion_.watch_limits = limits_.leaves_limits(plan.profile);
    return plan;
}

/// `plan` of the base would add up to more than the limit with what still moves on top of it: as fast as there is room, for now.
void BaseMotion::wait_for_room(const MotionState& from, MotionLimits limits, Plan& plan) noexcept {
    if (motion_.goal.kind == Goal::Kind::stop || motion_.held || plan.error != PlanError::none) return;
    const double limit = body_.config.limits.velocity;
    double sense = 0, room = 0, wanted = 0;
    for (const double way : {1.0, -1.0}) {
        const double reach = addition_.reach(way);
        if (reach == 0) continue;
        const double left = std::max({0.0, body_.config.limits.velocity_towards(way) - reach, way * from.velocity});
        const double top = plan.profile.top_velocity(way);
        if (top <= left + SuperimposedMotion::room_grain * limit || top - left <= wanted - room) continue;
        sense = way;
        room = left;
        wanted = top;
    }
    if (sense == 0) return;
    motion_.wants_speed = sense * wanted;
    if (!(room > SuperimposedMotion::least_speed * limit)) {
        motion_.held = true;
        plan = plan_stop(from, in_each_direction(limits, body_.config.limits));
    } else if (motion_.goal.kind == Goal::Kind::velocity) {
        plan = plan_to_velocity(from, sense * std::min(sense * plan.profile.end().velocity, room),
                                in_each_direction(limits, body_.config.limits));
    } else {
        limits.velocity = std::min(limits.velocity, motion_.override_counts() ? room / motion_.factors.velocity : room);
        plan = plan_way(from, limits, room);
    }
}

void BaseMotion::end_release() noexcept {
    const bool planned =
        motion_.goal.kind == Goal::Kind::position || motion_.goal.kind == Goal::Kind::velocity || motion_.goal.kind == Goal::Kind::stop;
    auto limits = motion_.with_override(motion_.goal.limits);
    motion_.releases = planned && limits_.release_below_limit(motion_.setpoint.base(), limits);
    if (planned && !motion_.releases) motion_.goal_pending = true;
}

/// The base stops and so does what was given up on top of it, each with its own ramp: between them they would turn the axis round. One motion does
/// not. It may go on later (an override): what was covered on top is part of where it goes.
void BaseMotion::stop_as_one() noexcept {
    if (motion_.goal.kind == Goal::Kind::stop) motion_.goal.former_jerk += addition_.jerk();
    if (motion_.goal.kind == Goal::Kind::position) motion_.goal.value += motion_.setpoint.superimposed().position;
    addition_.end(Outcome::aborted);
}

void BaseMotion::stop_instead(double late) noexcept {
    const auto& from = motion_.setpoint.base();
    const auto plan = plan_stop(
        from, in_each_direction(never_reversing(from, stop_limits(body_.config.limits), to_seconds(body_.cycle)), body_.config.limits));
    motion_.goal_pending = false;
    run_profile(plan, late);
}

void BaseMotion::run_profile(const Plan& plan, double late) noexcept {
    motion_.setpoint.run(plan.profile, late);
    motion_.setpoint.sample();
    if (body_.queue.beside(SideSlot::superimposed) != 0) addition_.plan_anew();
}

double BaseMotion::velocity_at_junction(const MotionState& from, const MotionLimits& limits) const noexcept {
    const auto& active = body_.queue.active().command;
    if (body_.queue.waiting() == 0 || !blends(body_.queue.waiting_at(0).command.buffer_mode) || !ends_at_position(active.kind)) return 0;
    if (motion_.goal.limiter == VelocityLimiter::software_limit) return 0;

    const double factor = motion_.override_counts() ? motion_.factors.velocity : 1;
    const double superimposed = motion_.setpoint.superimposed().position + motion_.setpoint.superimposed_rest();
    std::array<ChainMove, CommandQueue::capacity + 1> chain{};
    const auto& axis = body_.config.limits;
    const auto first = towards(limits, axis, motion_.goal.value - from.position);
    chain[0] = {.way = motion_.goal.value - from.position, .speed = first.velocity, .limits = first};
    std::size_t length = 1;
    MotionState place{motion_.goal.value, 0, 0};
    for (std::size_t i = 0; i < body_.queue.waiting(); ++i) {
        const auto& command = body_.queue.waiting_at(i).command;
        const auto& before = chain[length - 1];
        if (!blends(command.buffer_mode) || before.end != ChainMove::End::rest) break;

        ChainMove move;
        move.mode = command.buffer_mode;
        move.limits = motion_.with_override(dynamics_of(command, axis, body_.config.defaults));
        const bool backwards = before.way < 0;
        if (command.kind == CommandKind::move_velocity) {
            move.end = ChainMove::End::none;
            move.way = targets_.signed_velocity(command, backwards);
        } else if (ends_at_position(command.kind) || moves_continuously(command.kind)) {
            const bool absolute = command.kind == CommandKind::move_absolute || command.kind == CommandKind::move_continuous_absolute;
            // Its turn on a modulo axis is the one that it would take from a stop, as Buffered.
            const double target =
                absolute ? targets_.repetition_of(command, place, backwards) - superimposed : place.position + command.position;
            const double sense = target - place.position;
            if (!measured_.permitted(sense) ||
                (body_.software_limits_hold() && targets_.refuse_place(body_.units.to_program(target)) != ErrorId::none))
                break;
            move.way = sense;
            place.position = target;
            if (moves_continuously(command.kind)) {
                move.end = ChainMove::End::velocity;
                const auto end =
                    allowed_speed(std::abs(command.end_velocity), axis.velocity_towards(command.end_velocity), body_.velocity_cap());
                move.end_velocity = factor * std::copysign(end.speed, command.end_velocity);
            }
        } else break;
        move.speed = factor * allowed_speed(std::abs(command.velocity), axis.velocity_towards(move.way), body_.velocity_cap()).speed;
        move.limits = move.way * move.end_velocity < 0 ? gentlest(move.limits, axis) : towards(move.limits, axis, move.way);
        chain[length++] = move;
    }
    const double wanted = junction_velocity({chain.data(), length});
    return nearest_reachable(wanted, from, motion_.goal.value, in_each_direction(limits, axis));
}

}  // namespace taktwerk::axes
