#pragma once
// The steps of a plain cycle (plain_cycle.hpp), to be inlined where a cycle begins: axis.cpp.

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

[[gnu::always_inline]] inline bool PlainCycle::update(AxisCore& axis, const DriveFeedback& from_drive) noexcept {
    auto& measured = axis.measured;
    if (!measured.feedback.differs_in_motion_only(from_drive)) {
        disturb();
        return false;
    }
    measured.feedback.take_motion(from_drive);
    measured.counts = from_drive.position;
    axis.probes.track();
    const auto& units = axis.body.units;
    const double actual = units.local(measured.counts);
    if (axis.following.watch(measured, axis.motion.now, actual, false)) {
        fall_behind(axis, actual);
        return true;
    }
    view_.in_position = axis.following.in_position(axis.body);
    view_.following_error = axis.following.error();
    view_.actual_position = units.to_program(actual);
    view_.actual_velocity = measured.velocity();
    view_.actual_torque = measured.torque();
    return true;
}

[[gnu::always_inline]] inline void PlainCycle::show_setpoint(AxisCore& axis) noexcept {
    const auto& set = axis.motion.now.setpoint.state();
    const auto& units = axis.body.units;
    if (set.velocity != 0) axis.motion.now.backwards = set.velocity < 0;
    view_.set_position = units.to_program(set.position);
    if (units.modulo() > 0) view_.turns = units.turns(set.position);
    view_.set_velocity = set.velocity;
    view_.set_acceleration = set.acceleration;
}

[[gnu::always_inline]] inline PlainCycle::Planned PlainCycle::go_along(AxisCore& axis, Duration period) noexcept {
    auto& motion = axis.motion.now;
    auto& generator = motion.setpoint;
    if (drifts_ && axis.body.units.far_from_anchor(generator.state().position)) return Planned::nothing;
    if (guarded_) {
        const MotionState before = generator.state();
        generator.advance_base(period);
        if (LimitGuard::may_meet_limit(axis.body, axis.measured, motion) && axis.guard.watch(before, period)) return Planned::motion;
    } else generator.advance_base(period);
    if (ends_ && generator.finished()) return Planned::motion;
    view_.set_jerk = generator.jerk();
    view_.limiter = generator.rests() ? VelocityLimiter::none : limiter_in_motion_;
    show_setpoint(axis);
    return Planned::all;
}

[[gnu::always_inline]] inline PlainCycle::Planned PlainCycle::plan(AxisCore& axis, Duration period) noexcept {
    if ((straight_ & along_profile) != 0) return go_along(axis, period);
    return coupled() ? follow(axis, period) : Planned::nothing;
}

}  // namespace taktwerk::axes
