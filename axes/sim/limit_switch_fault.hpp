#pragma once
// A drive to which a limit switch is a fault in the position modes: running onto it, or pressing on against it. Whoever stands there may be
// enabled, to drive away. Source: SV-DA200 5.3.

#include "axes/sim/cia402_axis.hpp"
#include "axes/sim/position_targets.hpp"

namespace taktwerk::axes::sim {

class LimitSwitchFault {
public:
    explicit LimitSwitchFault(const DriveProfile& profile);

    /// Each exchange, with what the axis is about to take.
    void watch(const AxisInputs& in, const PositionTargets& targets, Cia402Axis& axis) noexcept;

private:
    bool is_one_;  ///< to this drive
    AlarmCode negative_, positive_;
    bool at_negative_ = false, at_positive_ = false;
};

}  // namespace taktwerk::axes::sim
