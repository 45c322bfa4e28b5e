#pragma once
// What the base of the motion goes for from here on.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/measured.hpp"

namespace taktwerk::axes {

class Aim {
public:
    Aim(AxisBody& body, const Measured& measured, AxisMotion& motion) noexcept : body_(body), measured_(measured), motion_(motion) {}

    void at(Goal::Kind kind, double value, const MotionLimits& limits, VelocityLimiter limiter) noexcept;
    /// Every stop of a planned motion begins here, whoever asked for it.
    void at_rest(const MotionLimits& limits) noexcept;
    void at_velocity(double velocity, const MotionLimits& dynamics) noexcept;
    /// `target` is local.
    void at_target(const AxisCommand& command, double target) noexcept;
    void at_stop(const AxisCommand& command) noexcept;
    /// Of what moves the axis now, base and addition together. That of a slave, a table or a fed set-point is not limited once it has moved the axis: until
    /// then it is that of the motion before.
    [[nodiscard]] double jerk_of_motion() const noexcept;
    /// The command begins here: with what was superimposed so far, near the anchor. A goal must follow.
    void start_at_base() noexcept;
    /// Only while nothing is planned: every local coordinate becomes another.
    void anchor_near_actual() noexcept;
    /// A profile must follow.
    void reanchor() noexcept;
    void keep_close_to_anchor() noexcept;
    /// Program coordinates grow by `delta`; nothing moves, but the way to an absolute target becomes another.
    void shift_coordinates(double delta) noexcept;

private:
    AxisBody& body_;
    const Measured& measured_;
    AxisMotion& motion_;
};

}  // namespace taktwerk::axes
