#pragma once
// PLCopen Part 5: homing step by step. The axis is in Homing from the first step until MC_FinishHoming (or MC_HomeDirect, MC_HomeAbsolute),
// and not homed in between. A step that meets one of its limits, or finds nothing, ends with that error: the axis stops along its ramp and
// stays in Homing, so that the program may try another step; MC_Stop gives up.

#include <utility>

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/homing_runs.hpp"
#include "axes/axis/measured.hpp"

namespace taktwerk::axes {

class Aim;
class HomingReference;
class SearchMotion;

class HomingSteps {
public:
    HomingSteps(AxisBody& body, const Measured& measured, AxisMotion& motion, Aim& aim, HomingRuns& runs, HomingReference& reference,
                SearchMotion& search) noexcept
        : body_(body), measured_(measured), motion_(motion), aim_(aim), runs_(runs), reference_(reference), search_(search) {}

    [[nodiscard]] ErrorId refuse(const HomingStepDetails& step, bool starts_now) const noexcept;
    ErrorId begin(const AxisCommand& command) noexcept;
    void follow() noexcept;
    /// The steps that need no search, once the axis stands. They end the procedure.
    [[nodiscard]] bool complete() noexcept;

    /// Once: a step has ended, and what waits has its turn.
    [[nodiscard]] bool over() noexcept { return std::exchange(over_, false); }

private:
    void guard_finish() noexcept;
    void end_step(ErrorId error) noexcept;

    AxisBody& body_;
    const Measured& measured_;
    AxisMotion& motion_;
    Aim& aim_;
    HomingRuns& runs_;
    HomingReference& reference_;
    SearchMotion& search_;

    bool over_ = false;
};

}  // namespace taktwerk::axes
