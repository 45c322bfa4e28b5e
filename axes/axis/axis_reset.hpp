#pragma once
// MC_Reset: out of ErrorStop, once the cause is gone and the drive has taken it.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/measured.hpp"
#include "axes/axis/state_machine.hpp"

namespace taktwerk::axes {

class Conduct;

class AxisReset {
public:
    AxisReset(AxisBody& body, const Measured& measured, AxisMotion& motion, Conduct& conduct) noexcept
        : body_(body), measured_(measured), motion_(motion), conduct_(conduct) {}

    ErrorId request() noexcept;
    void run() noexcept;

    [[nodiscard]] bool resetting() const noexcept { return resetting_; }

private:
    void end(AxisEvent event) noexcept;

    AxisBody& body_;
    const Measured& measured_;
    AxisMotion& motion_;
    Conduct& conduct_;

    bool resetting_ = false;  // waits for the drive or for standstill
    Instant since_{};
};

}  // namespace taktwerk::axes
