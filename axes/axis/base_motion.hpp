#pragma once
// From the goal to a profile of the base, and to the next command's where one blends into it.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/measured.hpp"
#include "axes/planner/plan.hpp"

namespace taktwerk::axes {

class GivenMotion;
class SoftwareLimits;
class SuperimposedMotion;
class Targets;

class BaseMotion {
public:
    BaseMotion(const AxisBody& body, const Measured& measured, AxisMotion& motion, GivenMotion& given, SuperimposedMotion& addition,
               const SoftwareLimits& limits, const Targets& targets) noexcept
        : body_(body), measured_(measured), motion_(motion), given_(given), addition_(addition), limits_(limits), targets_(targets) {}

    /// The goal gets its profile, which began `late` seconds ago. False: the planner refused; a stop is under way.
    [[nodiscard]] bool plan_goal(double late) noexcept;
    /// The rest of the way belongs to the command's own jerk.
    void end_release() noexcept;
    /// What the planner makes nothing of ends in a stop.
    void stop_instead(double late) noexcept;

private:
    [[nodiscard]] Plan plan_way(const MotionState& from, MotionLimits limits, double most) noexcept;
    void wait_for_room(const MotionState& from, MotionLimits limits, Plan& plan) noexcept;
    void stop_as_one() noexcept;
    void run_profile(const Plan& plan, double late) noexcept;
    [[nodiscard]] double velocity_at_junction(const MotionState& from, const MotionLimits& limits) const noexcept;

    const AxisBody& body_;
    const Measured& measured_;
    AxisMotion& motion_;
    GivenMotion& given_;
    SuperimposedMotion& addition_;
    const SoftwareLimits& limits_;
    const Targets& targets_;
};

}  // namespace taktwerk::axes
