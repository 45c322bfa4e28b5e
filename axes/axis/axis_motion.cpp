// One cycle of the set-point: from the goal to a profile, from the profile to the next set-point.

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_core.hpp"
#include "axes/axis/junction.hpp"
#include "axes/axis/stop_ramp.hpp"

namespace taktwerk::axes {

namespace {

// A way that takes longer than this at the axis' velocity, s, is a long one; all but a third of it is covered in the other.
constexpr double long_way = 1, long_way_time = 0.1;
// Of the axis' velocity: whoever follows it as a master takes twice of it for another zero.
constexpr double followed_by_slaves = 1.9;

/// Limits lowered since the command came hold from here on. A stop, and the way to a software limit, are as hard as they have to be.
template <class Goal>
void hold_to_limits(Goal& goal, const AxisLimits& now) noexcept {
    const bool velocity = goal.kind == Goal::Kind::velocity;
    if ((!velocity && goal.kind != Goal::Kind::position) || goal.limiter == VelocityLimiter::software_limit) return;
    auto& limits = goal.limits;
    const double wanted = velocity ? std::abs(goal.value) : limits.velocity;
    limits = {std::min(limits.velocity, now.velocity), std::min(limits.acceleration, now.acceleration),
              std::min(limits.deceleration, now.deceleration), std::min(limits.jerk, now.jerk)};
    if (wanted <= now.velocity) return;
    if (velocity) goal.value = std::copysign(now.velocity, goal.value);
    goal.limiter = VelocityLimiter::axis_limit;
}

}  // namespace

void AxisCore::plan(Instant now, Duration period) noexcept {
    now_ = now;
    if (coupling_.phasing_next.id != 0) settle_waiting_phasing();
    if (follows_motor()) {
        follow_actual(period);
        settle_couplings();
        step_homing();
        publish();
        return;
    }
    const bool may_be_homed = view_.state == AxisState::Homing || passive_.id != 0;
    const double coordinates = units_.shift();
    if (homes() || latch_.armed()) step_homing();
    if (view_.active_in_target && queue_.waiting() > 0) carry_out_due_settings();
    if (view_.active_in_target && queue_.waiting() > 0) hand_over();
    if (mode_phase_ != ModePhase::steady && step_mode(period)) {
        publish_commands();
        publish_setpoint();
        if (mode_phase_ == ModePhase::profile && drive_run_.mode() == DriveMode::profile_position)
            view_.target_position = units_.to_program(drive_run_.front().target);
        return;
    }
    if (begin_pending_) begin_command();
    if (endless_) keep_close_to_anchor();
    if (coupling_.shown) follow_masters(period);

    const MotionState before = setpoint_.state();
    if (releases_) end_release();
    if (goal_pending_) run_goal(0);
    if (superimposed_.pending) run_superimposed();
    if (goal_.kind == Goal::Kind::given) step_given(period);
    else if (goal_.kind == Goal::Kind::coupled) {
        setpoint_.advance_superimposed(period);
        step_coupled(period);
    } else setpoint_.advance(period);
    if (goal_pending_) {  // what was given has ended badly: the axis brakes from where it is
        run_goal(0);
        setpoint_.advance(period);
    }
    if (may_meet_limit()) guard(before, period);
    // A drive that was told to stop holds no place of ours: where it comes to rest is where the axis is.
    if (port_.capabilities().setpoints == SetpointClass::low_dynamics && goal_.kind == Goal::Kind::stop && !goal_pending_ &&
        setpoint_.finished() && online() && drive_stands() && feedback_.commands_acknowledged)
        setpoint_.place(actual_local());
    if (may_complete()) complete();
    if (goal_.kind == Goal::Kind::given || goal_.kind == Goal::Kind::coupled) goal_.former_jerk = 0;  // it has moved the axis itself
    if (coupling_.shown) complete_phasing();
    if (queue_.beside(SideSlot::superimposed) != 0 || wants_speed_ != 0) complete_superimposed();
    if (const double velocity = setpoint_.state().velocity; velocity != 0) backwards_ = velocity < 0;
    else if (summed_) summed_ = !setpoint_.at_rest();
    publish_commands();
    publish_setpoint();
    if (may_be_homed || units_.shift() != coordinates) publish_feedback(actual_local());  // in other coordinates
}

/// Power would hold it with a jolt: it is asked for when the motor is slow, or not at all.
bool AxisCore::turns_by_itself() const noexcept {
    // What counts as standstill is none, however slow the axis is: the velocity of a drive at rest is seldom 0.
    return !drive_homing_.busy() && !drive_stands() && std::abs(view_.actual_velocity) > turning_by_itself * config_.limits.velocity;
}

void AxisCore::follow_actual(Duration period) noexcept {
    if (!online()) {
        aligned_ = false;
        return;
    }
    // Not faster than the axis may be or its motor turns, so that no trace shows a jump where a drive falls with a following error. But who
    // turned a motor without power by hand, very fast and far, does not wait for it: power is asked for when the set-point has come.
    const double way = actual_local() - setpoint_.state().position;
    const double limit = config_.limits.velocity, turns = std::abs(view_.actual_velocity);
    const double velocity = std::clamp(turns, limit, followed_by_slaves * limit);
    const bool far = std::abs(way) > velocity * long_way;
    const double most = (far ? std::abs(way) / long_way_time : velocity) * to_seconds(period);
    const bool here = drive_homing_.busy() || std::abs(way) <= most;
    aligned_ = here && !turns_by_itself();
    setpoint_.place(here ? actual_local() : setpoint_.state().position + std::copysign(most, way));
    if (endless_ && units_.far_from_anchor(actual_local())) reanchor();  // an encoder turns for years
    if (!power_.follows_actual()) return;
    end_drive_profile();
    torque_idle_ = mode_waits_ = false;
    goal_ = {};
    goal_pending_ = begin_pending_ = held_ = false;
}

/// Whatever it is on its way to: the base is about to stop, or does.
bool AxisCore::base_comes_to_rest() const noexcept {
    const bool no_speed = override_counts() && override_.velocity == 0;
    return goal_.kind == Goal::Kind::stop || (goal_.kind == Goal::Kind::velocity && (goal_.value == 0 || no_speed)) ||
           (goal_.kind == Goal::Kind::position && no_speed);
}

void AxisCore::run_goal(double late) noexcept {
    if (abandoned_addition_moves() && base_comes_to_rest()) {
        stop_as_one();
        late = 0;  // both are where they are now
    }
    goal_pending_ = held_ = false;
    wants_speed_ = folded_jerk_ = 0;
    hold_to_limits(goal_, config_.limits);
    auto from = setpoint_.base();
    auto limits = with_override(goal_.limits);
    if (goal_.kind == Goal::Kind::stop && from.velocity * from.acceleration > 0) {
        // What speeds up loses its acceleration with the jerk it was built up with, at once where none limited that: with less the axis would get
        // faster after the stop than it was ever meant to.
        if (std::isfinite(goal_.former_jerk)) {
            limits.jerk = std::max(limits.jerk, goal_.former_jerk);
        } else {
            from.acceleration = 0;
            setpoint_.set(from);
        }
    }
    releases_ = release_below_limit(from, limits);
    Plan plan;
    switch (goal_.kind) {
        case Goal::Kind::rest:
        case Goal::Kind::coupled: return;
        case Goal::Kind::given: start_given(late); return;
        case Goal::Kind::position: plan = plan_way(from, limits, config_.limits.velocity); break;
        case Goal::Kind::velocity: {
            const double velocity = override_counts() ? goal_.value * override_.velocity : goal_.value;
            if (velocity == 0) limits = never_reversing(from, limits, to_seconds(cycle_));
            brake_inside_limits(from, limits);
            plan = plan_to_velocity(from, velocity, limits);
            watch_limits_ = true;
            break;
        }
        case Goal::Kind::stop:
            limits = never_reversing(from, limits, to_seconds(cycle_));
            brake_inside_limits(from, limits);
            plan = plan_stop(from, limits);
            watch_limits_ = false;
            break;
    }
    if (setpoint_.layered()) wait_for_room(from, limits, plan);
    if (plan.error != PlanError::none) {
        fail(AxisAlarm::planner_refused, units_.to_program(from.position), from.velocity);
        plan = plan_stop(setpoint_.base(), never_reversing(setpoint_.base(), stop_limits(config_.limits), to_seconds(cycle_)));
        goal_pending_ = false;
    }
    setpoint_.run(plan.profile, late);
    setpoint_.sample();
    if (queue_.beside(SideSlot::superimposed) != 0) superimposed_.pending = true;
}

/// The rest of the way belongs to the command's own jerk.
void AxisCore::end_release() noexcept {
    const bool planned = goal_.kind == Goal::Kind::position || goal_.kind == Goal::Kind::velocity || goal_.kind == Goal::Kind::stop;
    auto limits = with_override(goal_.limits);
    releases_ = planned && release_below_limit(setpoint_.base(), limits);
    if (planned && !releases_) goal_pending_ = true;
}

/// `most`: u/s that also an end velocity may not pass.
Plan AxisCore::plan_way(const MotionState& from, MotionLimits limits, double most) noexcept {
    // A new target with gentle dynamics must not carry a fast axis past a software limit on its way back.
    brake_inside_limits(from, limits);
    if (override_counts()) {
        held_ = override_.velocity == 0;
        limits.velocity *= override_.velocity;
    }
    Plan plan;
    if (held_) {
        limits.velocity = config_.limits.velocity;
        plan = plan_stop(from, never_reversing(from, limits, to_seconds(cycle_)));
    } else if (goal_.goes_on) {
        const double factor = override_counts() ? override_.velocity : 1;
        const double end = std::clamp(goal_.end_velocity * factor, -most, most);
        plan = plan_through(from, {goal_.value, end, 0}, limits);
    } else if (const double through = velocity_at_junction(from, limits); through != 0) {
        plan = plan_through(from, {goal_.value, through, 0}, limits);
    } else {
        plan = plan_to_position(from, goal_.value, limits);
    }
    watch_limits_ = leaves_limits(plan.profile);
    return plan;
}

/// Only while nothing is planned: every local coordinate becomes another.
void AxisCore::anchor_near_actual() noexcept {
    if (units_.far_from_anchor(actual_local())) units_.reanchor(actual_local());
}

/// A profile must follow.
void AxisCore::reanchor() noexcept {
    const double here = setpoint_.base().position;
    const double left = units_.reanchor(here);
    const double delta = left - here;
    setpoint_.rebase(left);
    if (goal_.kind == Goal::Kind::position) goal_.value += delta;
    origin_ += delta;
    commanded_target_ += delta;
}

void AxisCore::keep_close_to_anchor() noexcept {
    if (goal_pending_ || goal_.kind != Goal::Kind::velocity || !setpoint_.finished() || !units_.far_from_anchor(setpoint_.base().position))
        return;
    reanchor();
    goal_pending_ = true;
}

}  // namespace taktwerk::axes
