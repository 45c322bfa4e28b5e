#pragma once
// ContinuousUpdate: a command goes on with other inputs. Never a re-trigger: no state changes, relative inputs keep the start's conditions
// (P1-103 to P1-110). One case per kind of command in update_active.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/measured.hpp"

namespace taktwerk::axes {

class Admission;
class Aim;
class AxisCoupling;
class DriveModes;
class GivenMotion;
class SuperimposedMotion;
class Targets;

class ContinuousUpdate {
public:
    ContinuousUpdate(AxisBody& body, const Measured& measured, AxisMotion& motion, GivenMotion& given, SuperimposedMotion& addition,
                     Aim& aim, const Targets& targets, AxisCoupling& coupling, DriveModes& switching, const Admission& admission) noexcept
        : body_(body),
          measured_(measured),
          motion_(motion),
          given_(given),
          addition_(addition),
          aim_(aim),
          targets_(targets),
          coupling_(coupling),
          switching_(switching),
          admission_(admission) {}

    ErrorId update(CommandId id, const AxisCommand& command) noexcept;

private:
    ErrorId update_waiting(AcceptedCommand& waiting, const AxisCommand& command) noexcept;
    ErrorId update_active(const AxisCommand& command) noexcept;
    ErrorId update_target(const AxisCommand& command) noexcept;
    ErrorId update_superimposed(const AxisCommand& command) noexcept;
    ErrorId refuse_as_new(const AxisCommand& command, bool starts_now) noexcept;

    AxisBody& body_;
    const Measured& measured_;
    AxisMotion& motion_;
    GivenMotion& given_;
    SuperimposedMotion& addition_;
    Aim& aim_;
    const Targets& targets_;
    AxisCoupling& coupling_;
    DriveModes& switching_;
    const Admission& admission_;
};

}  // namespace taktwerk::axes
