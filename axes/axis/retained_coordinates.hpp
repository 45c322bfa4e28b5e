#pragma once
// The coordinates of an axis over a time without power: what is to be kept, what is made of it, and when it is lost.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/measured.hpp"
#include "axes/axis/retained_position.hpp"

namespace taktwerk::axes {

class Conduct;

class RetainedCoordinates {
public:
    RetainedCoordinates(AxisBody& body, const Measured& measured, Conduct& conduct) noexcept
        : body_(body), measured_(measured), conduct_(conduct) {}

    void restore(const RetainedPosition& position, const Gearing& gearing) noexcept;
    /// At the first position after power-on.
    void apply() noexcept;
    /// What homing gave is gone, and so is what was kept of it.
    void lose_reference() noexcept;

    [[nodiscard]] RetainedPosition now(bool at_rest) const noexcept;

private:
    AxisBody& body_;
    const Measured& measured_;
    Conduct& conduct_;

    RetainedPosition kept_;  // waits for the first position; `homed` false: nothing to restore
};

}  // namespace taktwerk::axes
