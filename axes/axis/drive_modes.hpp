#pragma once
// The cyclic mode the drive runs in. Each axis has one of its own, position or velocity (the position loop is closed here then), and
// stays in it for every motion. Only MC_Home by the drive, MC_TorqueControl, the drive's own profiles and an explicit set_controller_mode change it.
//
//   steady -> entering -> torque -> leaving -> steady      MC_TorqueControl and whatever ends it
//   steady -> changing -> steady                           set_controller_mode, at standstill
//   steady -> profile_entering -> profile -> (profile_halting ->) leaving -> steady   a profile of the drive: drive_profiles.hpp
//
// In torque, and while the drive makes the profile, the set-point follows the motor, so that leaving begins where the motor is and as fast as it is.
// A drive that was asked for another mode and has not shown it yet takes set-points as ever: there the set-point follows nothing, and goes on.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/measured.hpp"
#include "axes/axis/mode_state.hpp"
#include "axes/axis/mode_step.hpp"

namespace taktwerk::axes {

class Aim;
class Conduct;
class DriveOutput;
class DriveProfiles;
class LimitGuard;
class MotorLead;
class SuperimposedMotion;
class Targets;

class DriveModes {
public:
    DriveModes(AxisBody& body, const Measured& measured, AxisMotion& motion, SuperimposedMotion& addition, Aim& aim, const Targets& targets,
               ModeState& modes, MotorLead& lead, Conduct& conduct, LimitGuard& guard, DriveProfiles& profiles,
               const DriveOutput& output) noexcept
        : body_(body),
          measured_(measured),
          motion_(motion),
          addition_(addition),
          aim_(aim),
          targets_(targets),
          modes_(modes),
          lead_(lead),
          conduct_(conduct),
          guard_(guard),
          profiles_(profiles),
          output_(output) {}

    [[nodiscard]] ErrorId refuse(const AxisCommand& command, bool starts_now) const noexcept;
    void begin_torque(const AxisCommand& command) noexcept;
    void begin_mode_change(const AxisCommand& command) noexcept;
    /// True: this cycle's set-point is made.
    [[nodiscard]] ModeStep step(Duration period) noexcept;

private:
    void note_asked() noexcept;
    [[nodiscard]] bool mode_confirmed() noexcept;
    [[nodiscard]] ModeStep leave(bool confirmed, bool late) noexcept;
    [[nodiscard]] ModeStep enter_torque(bool confirmed, bool late) noexcept;
    [[nodiscard]] ModeStep run_torque(Duration period) noexcept;
    [[nodiscard]] ModeStep change_mode(bool confirmed, bool late) noexcept;
    void go_on_from_motor() noexcept;
    void stop_or_stand() noexcept;

    AxisBody& body_;
    const Measured& measured_;
    AxisMotion& motion_;
    SuperimposedMotion& addition_;
    Aim& aim_;
    const Targets& targets_;
    ModeState& modes_;
    MotorLead& lead_;
    Conduct& conduct_;
    LimitGuard& guard_;
    DriveProfiles& profiles_;
    const DriveOutput& output_;
};

}  // namespace taktwerk::axes
