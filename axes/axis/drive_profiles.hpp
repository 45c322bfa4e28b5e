#pragma once
// Profiles that the drive makes, in its own modes: PP, PV, PT. The axis stands before the drive is asked for the mode, hands it one set-point
// (and in PP as many ahead as the drive takes), follows the motor, and looks after limits by what the drive reports. Whatever takes the axis
// ends it: bumpless back into the axis' own mode where the drive changes it in motion, else by a halt (6040h bit 8) in the drive's mode first.
//
//   steady          the axis stops along its own ramp
//   entering        the drive is asked for its mode and has no set-point
//   profile         the set-points are the drive's
//   halting         bit 8, until the motor stands
//   leaving         as out of torque (drive_modes.hpp)

#include <utility>

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/measured.hpp"
#include "axes/axis/mode_state.hpp"
#include "axes/axis/mode_step.hpp"

namespace taktwerk::axes {

class Aim;
class Conduct;
class LimitGuard;
class MotorLead;
class SuperimposedMotion;
class Targets;

class DriveProfiles {
public:
    DriveProfiles(AxisBody& body, const Measured& measured, AxisMotion& motion, SuperimposedMotion& addition, Aim& aim,
                  const Targets& targets, ModeState& modes, MotorLead& lead, Conduct& conduct, LimitGuard& guard) noexcept
        : body_(body),
          measured_(measured),
          motion_(motion),
          addition_(addition),
          aim_(aim),
          targets_(targets),
          modes_(modes),
          lead_(lead),
          conduct_(conduct),
          guard_(guard) {}

    [[nodiscard]] bool makes(CommandKind kind) const noexcept;
    [[nodiscard]] ErrorId refuse(const AxisCommand& command, bool starts_now) const noexcept;
    /// From a motion of its own the axis stops first. With the drive's profile running, the next cycle hands the set-point over.
    void begin(const AxisCommand& command) noexcept;
    void ask_for_mode() noexcept;
    [[nodiscard]] ModeStep step(bool confirmed, bool late) noexcept;

private:
    [[nodiscard]] bool goes_on() const noexcept;
    [[nodiscard]] ModeStep enter(bool confirmed, bool late) noexcept;
    [[nodiscard]] ModeStep run() noexcept;
    [[nodiscard]] DriveProfileRun::Setpoint drive_setpoint(const AxisCommand& command, DriveProfileRun::Way& way) const noexcept;
    ErrorId hand_to_drive(const AxisCommand& command) noexcept;
    void hand_ahead() noexcept;
    [[nodiscard]] bool judge() noexcept;
    [[nodiscard]] bool judge_move() noexcept;
    void watch_limits() noexcept;
    [[nodiscard]] ModeStep leave() noexcept;
    [[nodiscard]] ModeStep halt() noexcept;

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

    bool resumed_ = false;  // what waited has had its turn in this cycle
};

}  // namespace taktwerk::axes
