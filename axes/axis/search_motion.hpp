#pragma once
// A search of a homing says what shall happen; this moves the axis for it.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/homing_runs.hpp"
#include "axes/axis/measured.hpp"
#include "axes/planner/motion.hpp"

namespace taktwerk::axes {

class Aim;
class HomingReference;

class SearchMotion {
public:
    SearchMotion(const AxisBody& body, const Measured& measured, AxisMotion& motion, Aim& aim, HomingRuns& runs,
                 const HomingReference& reference) noexcept
        : body_(body), measured_(measured), motion_(motion), aim_(aim), runs_(runs), reference_(reference) {}

    /// Carries out what the step asks for, until it is over.
    void drive(const TriggerRef& reference, const MotionLimits& dynamics) noexcept;

private:
    [[nodiscard]] SearchInput input(const TriggerRef& reference) noexcept;

    const AxisBody& body_;
    const Measured& measured_;
    AxisMotion& motion_;
    Aim& aim_;
    HomingRuns& runs_;
    const HomingReference& reference_;
};

}  // namespace taktwerk::axes
