#pragma once
// Limits that no set-point passes, whatever made it: switches, permitted directions, software limits. They look at the total.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/measured.hpp"
#include "axes/axis/mode_state.hpp"

namespace taktwerk::axes {

class Aim;
class Conduct;
class SoftwareLimits;
class SuperimposedMotion;
class Targets;

class LimitGuard {
public:
    LimitGuard(AxisBody& body, const Measured& measured, AxisMotion& motion, const ModeState& modes, SuperimposedMotion& addition, Aim& aim,
               const SoftwareLimits& limits, const Targets& targets, Conduct& conduct) noexcept
        : body_(body),
          measured_(measured),
          motion_(motion),
          modes_(modes),
          addition_(addition),
          aim_(aim),
          limits_(limits),
          targets_(targets),
          conduct_(conduct) {}

    /// True: the set-point is another one.
    bool watch(const MotionState& before, Duration period) noexcept;
    [[nodiscard]] bool switches() noexcept;
    [[nodiscard]] bool limit_switches() noexcept;
    /// As the guards of planned motion, but early by what leaving the mode takes.
    void motor(const MotionLimits& braking) noexcept;
    [[nodiscard]] bool drive_speed(double velocity) noexcept;

    /// Cheap, for every cycle: false where watch() would find nothing.
    [[nodiscard]] static bool may_meet_limit(const AxisBody& body, const Measured& measured, const AxisMotion& motion) noexcept {
        const double velocity = motion.setpoint.state().velocity;
        const bool barred =
            velocity > 0 ? measured.positive_switch || !body.permit_positive : measured.negative_switch || !body.permit_negative;
        return velocity != 0 && (barred || ((motion.watch_limits || motion.setpoint.layered()) && body.software_limits_hold()));
    }

private:
    [[nodiscard]] bool guard_permits() noexcept;
    [[nodiscard]] bool guard_software_limits(const MotionState& before) noexcept;

    AxisBody& body_;
    const Measured& measured_;
    AxisMotion& motion_;
    const ModeState& modes_;
    SuperimposedMotion& addition_;
    Aim& aim_;
    const SoftwareLimits& limits_;
    const Targets& targets_;
    Conduct& conduct_;
};

}  // namespace taktwerk::axes
