#pragma once
// The set-point follows the motor: in torque, while the drive makes the profile, and on the way back.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/measured.hpp"
#include "axes/axis/mode_state.hpp"

namespace taktwerk::axes {

class MotorLead {
public:
    MotorLead(const AxisBody& body, const Measured& measured, AxisMotion& motion, ModeState& modes) noexcept
        : body_(body), measured_(measured), motion_(motion), modes_(modes) {}

    /// Where the motor will be when this cycle's set-point takes effect, once the drive has been seen in a mode that takes none.
    void follow() noexcept;
    /// The motor stands by then, if the drive stops along a ramp of its own. `deceleration` u/s2; 0: unknown.
    [[nodiscard]] Duration longest_ramp(double deceleration) const noexcept;

private:
    const AxisBody& body_;
    const Measured& measured_;
    AxisMotion& motion_;
    ModeState& modes_;
};

}  // namespace taktwerk::axes
