#pragma once
// How a plan keeps inside the software limits, and its velocity below the axis' limit: harder ramps, where they are needed.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/planner/plan.hpp"

namespace taktwerk::axes {

class SuperimposedMotion;

class SoftwareLimits {
public:
    SoftwareLimits(const AxisBody& body, const AxisMotion& motion, const SuperimposedMotion& addition) noexcept
        : body_(body), motion_(motion), addition_(addition) {}

    /// Two layers brake with a ramp each (P1-155). What they would have stopped within, one motion of both does with twice the ramps: the sum of
    /// theirs is no harder. Where a new one moves on top it has its own, and the base one: no more than two.
    [[nodiscard]] double layers_in_base() const noexcept;
    void brake_as_both_layers(const MotionState& from, double sense, double room, MotionLimits& limits) const noexcept;
    /// Ramps that would carry the axis past a software limit become as hard as the axis can.
    void brake_inside_limits(const MotionState& from, MotionLimits& limits) const noexcept;
    /// The acceleration the axis has now was built up with another jerk. Taken away with a smaller one it would carry the velocity beyond the
    /// axis' limit, also through zero to the one of the other sense: then it is taken away as fast as that needs.
    [[nodiscard]] bool release_below_limit(const MotionState& from, MotionLimits& limits) const noexcept;
    /// Does it go further than both its ends and the software limits?
    [[nodiscard]] bool leaves_limits(const Profile& profile) const noexcept;
    /// Both layers are on their way to rest, and whatever part of its way each has done, the sum is inside: then it may brake with both ramps
    /// at once, harder than the axis would alone.
    [[nodiscard]] bool sum_stays_inside() const noexcept;

private:
    const AxisBody& body_;
    const AxisMotion& motion_;
    const SuperimposedMotion& addition_;
};

}  // namespace taktwerk::axes
