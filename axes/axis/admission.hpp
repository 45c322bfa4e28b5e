#pragma once
// What is accepted: every reason to refuse a command, checked and answered in the same call. It changes nothing.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/measured.hpp"

namespace taktwerk::axes {

class AxisCoupling;
class AxisHoming;
class Conduct;
class DriveModes;
class DriveProfiles;
class GivenMotion;
class HomingSteps;
class Targets;

class Admission {
public:
    Admission(const AxisBody& body, const Measured& measured, const AxisMotion& motion, const Conduct& conduct, const Targets& targets,
              GivenMotion& given, const AxisCoupling& coupling, const AxisHoming& homing, const HomingSteps& steps,
              const DriveModes& switching, const DriveProfiles& profiles) noexcept
        : body_(body),
          measured_(measured),
          motion_(motion),
          conduct_(conduct),
          targets_(targets),
          given_(given),
          coupling_(coupling),
          homing_(homing),
          steps_(steps),
          switching_(switching),
          profiles_(profiles) {}

    [[nodiscard]] bool waits(const AxisCommand& command) const noexcept;
    [[nodiscard]] ErrorId refuse_target(const AxisCommand& command, bool starts_now) const noexcept;
    ErrorId refuse(const AxisCommand& command) noexcept;
    [[nodiscard]] ErrorId refuse_superimposed(const AxisCommand& command) const noexcept;

private:
    [[nodiscard]] bool powers_up() const noexcept;
    [[nodiscard]] bool homes_before() const noexcept;
    [[nodiscard]] ErrorId refuse_state(const AxisCommand& command) const noexcept;

    const AxisBody& body_;
    const Measured& measured_;
    const AxisMotion& motion_;
    const Conduct& conduct_;
    const Targets& targets_;
    GivenMotion& given_;
    const AxisCoupling& coupling_;
    const AxisHoming& homing_;
    const HomingSteps& steps_;
    const DriveModes& switching_;
    const DriveProfiles& profiles_;
};

}  // namespace taktwerk::axes
