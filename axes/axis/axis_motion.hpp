#pragma once
// The motion that an axis is in: its set-point, the goal of its base, and what is to be remembered between two plans.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/setpoint_generator.hpp"
#include "axes/planner/motion.hpp"

namespace taktwerk::axes {

/// What the base of the set-point is on its way to. `value`: local position u, or velocity u/s. `given`: no plan, something else says where
/// it is in each cycle (a table over time, a fed set-point, the motor itself). Limits and velocities are those commanded and allowed; overrides
/// enter where the profile is made.
struct Goal {
    enum class Kind : std::uint8_t { rest, position, velocity, stop, given, coupled } kind = Kind::rest;
    double value = 0;
    MotionLimits limits;
    VelocityLimiter limiter = VelocityLimiter::none;
    bool goes_on = false;     ///< position: passes it with end_velocity and keeps that (MC_MoveContinuous...)
    double end_velocity = 0;  ///< u/s, signed
    double former_jerk =
        0;  ///< u/s3, of the motion before: a stop's; a coupling's, table's or feed's until it has moved the axis, then that of the feed
    bool kept = false;  ///< velocity: that of a motion that is over; an override counts from its next change on
};

struct AxisMotion {
    explicit AxisMotion(const AxisBody& of_axis) : body(of_axis) {}

    const AxisBody& body;
    Goal goal;
    bool goal_pending = false;   ///< the goal has no profile yet
    bool held = false;           ///< override 0: the axis waits on its way to a position
    bool releases = false;       ///< the plan has another jerk than the command, until the acceleration it found is gone
    bool summed = false;         ///< two layers in motion became one: until it rests, its ramps may be as hard as both together were
    bool watch_limits = true;    ///< the base might pass a software limit
    bool backwards = false;      ///< sense of the last motion
    double wants_speed = 0;      ///< u/s, signed, that the base will have once what is superimposed has made room; 0: it waits for nothing
    SetpointGenerator setpoint;  ///< what is read in every cycle stands at its beginning
    double folded_jerk = 0;      ///< u/s3 of an addition that ended in motion, until the goal after it has its profile
    Override factors;            ///< in effect: what a program has set, times what the operator has
    Override asked;              ///< MC_SetOverride
    double operators = 1;        ///< 0..1, on the velocity alone
    // The running command's start, for its relative inputs; and the last target of a motion to a position, for MC_MoveAdditive.
    double origin = 0;               ///< local
    bool started_backwards = false;  ///< sense of motion there
    double commanded_target = 0;     ///< local
    bool has_commanded_target = false;

    /// MC_SetOverride: factors on what commands ask for. They act at once, by planning anew from the present state. True: they are others.
    [[nodiscard]] ErrorId take_override(const Override& wanted, bool& changed) noexcept;
    /// The operator's, beside them; likewise.
    [[nodiscard]] ErrorId take_operators_override(double wanted, bool& changed) noexcept;
    [[nodiscard]] bool override_counts() const noexcept;
    /// Ramps only: what a velocity means depends on the kind of motion.
    [[nodiscard]] MotionLimits with_override(const MotionLimits& limits) const noexcept;
    /// What holds the velocity of the base down. An override has no part in a stop, which may also be a velocity of 0.
    [[nodiscard]] VelocityLimiter limiter() const noexcept {
        const bool overridden = factors.velocity < 1 && goal.limiter != VelocityLimiter::stopping && override_counts();
        return overridden ? VelocityLimiter::override_factor : goal.limiter;
    }
    /// Whatever it is on its way to: the base is about to stop, or does.
    [[nodiscard]] bool base_comes_to_rest() const noexcept;
    [[nodiscard]] bool heads_backwards() const noexcept {
        const double velocity = setpoint.base().velocity;
        return velocity != 0 ? velocity < 0 : backwards;
    }
    /// The axis comes to rest after a command that ended with an error; nobody's command.
    [[nodiscard]] bool halts_alone() const noexcept {
        return body.state == AxisState::DiscreteMotion && goal.kind == Goal::Kind::stop && !body.queue.has_active();
    }

private:
    void join_overrides() noexcept;
};

}  // namespace taktwerk::axes
