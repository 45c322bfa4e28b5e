#pragma once
// What the numbers of a command mean as places, senses and torques of this axis.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/drive_profile_run.hpp"
#include "axes/axis/measured.hpp"

namespace taktwerk::axes {

class Targets {
public:
    Targets(const AxisBody& body, const Measured& measured, const AxisMotion& motion) noexcept
        : body_(body), measured_(measured), motion_(motion) {}

    /// `program` as a target: inside the range of a modulo axis, inside the software limits.
    [[nodiscard]] ErrorId refuse_place(double program) const noexcept;
    [[nodiscard]] ErrorId refuse_place(const AxisCommand& command) const noexcept;
    [[nodiscard]] double signed_velocity(const AxisCommand& command, bool backwards) const noexcept;
    /// Local target of a motion to a position that begins at `from`.
    [[nodiscard]] double target_of(const AxisCommand& command, const MotionState& from, bool backwards) const noexcept;
    /// Which repetition of a modulo axis' position is meant: the first from `from` in the direction; the next one after where the axis can
    /// stop, when it already moves that way with a direction it must keep (P1-095). WholeTurns come on top.
    [[nodiscard]] double repetition_of(const AxisCommand& command, const MotionState& from, bool backwards) const noexcept;
    /// Local target of a move that begins at `from`.
    [[nodiscard]] double drive_target(const AxisCommand& command, const MotionState& from) const noexcept;
    [[nodiscard]] double torque_of(const AxisCommand& command) const noexcept;
    [[nodiscard]] ErrorId refuse_drive_way(const DriveProfileRun::Way& way) const noexcept;

private:
    const AxisBody& body_;
    const Measured& measured_;
    const AxisMotion& motion_;
};

}  // namespace taktwerk::axes
