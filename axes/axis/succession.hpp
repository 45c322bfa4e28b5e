#pragma once
// What comes after what: how a command begins, its end, and the one that waits behind it.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/measured.hpp"
#include "axes/axis/mode_state.hpp"

namespace taktwerk::axes {

class Admission;
class Aim;
class AxisCoupling;
class AxisHoming;
class AxisSettings;
class Conduct;
class DriveModes;
class DriveProfiles;
class GivenMotion;
class HomingSteps;
class JogLease;
class Targets;

class Succession {
public:
    Succession(AxisBody& body, const Measured& measured, AxisMotion& motion, GivenMotion& given, Aim& aim, Conduct& conduct,
               const Targets& targets, ModeState& modes, HomingSteps& steps, AxisHoming& homing, DriveProfiles& profiles,
               DriveModes& switching, AxisCoupling& coupling, AxisSettings& settings, const Admission& admission,
               const JogLease& jog) noexcept
        : body_(body),
          measured_(measured),
          motion_(motion),
          given_(given),
          aim_(aim),
          conduct_(conduct),
          targets_(targets),
          modes_(modes),
          steps_(steps),
          homing_(homing),
          profiles_(profiles),
          switching_(switching),
          coupling_(coupling),
          settings_(settings),
          admission_(admission),
          jog_(jog) {}

    void begin_command() noexcept;
    /// A command that has shown its Inxxx output for a cycle gives way to what waits behind it: it has no Done, so it counts as aborted.
    void hand_over() noexcept;
    void complete() noexcept;
    void start_waiting(double late) noexcept;

    /// Cheap, for every cycle: false where complete() would find nothing.
    [[nodiscard]] static bool may_complete(const AxisBody& body, const AxisMotion& motion) noexcept {
        const auto& goal = motion.goal;
        if (goal.kind == Goal::Kind::rest) return body.queue.has_active();
        return motion.setpoint.finished() || goal.kind == Goal::Kind::given || goal.kind == Goal::Kind::coupled ||
               body.state == AxisState::ContinuousMotion;
    }

private:
    ErrorId begin_home(const AxisCommand& command) noexcept;
    void decouple() noexcept;
    ErrorId set_goal(const AcceptedCommand& accepted) noexcept;
    [[nodiscard]] bool complete_active() noexcept;

    AxisBody& body_;
    const Measured& measured_;
    AxisMotion& motion_;
    GivenMotion& given_;
    Aim& aim_;
    Conduct& conduct_;
    const Targets& targets_;
    ModeState& modes_;
    HomingSteps& steps_;
    AxisHoming& homing_;
    DriveProfiles& profiles_;
    DriveModes& switching_;
    AxisCoupling& coupling_;
    AxisSettings& settings_;
    const Admission& admission_;
    const JogLease& jog_;
};

}  // namespace taktwerk::axes
