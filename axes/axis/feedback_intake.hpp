#pragma once
// What comes from the drive, at the beginning of a cycle: taken in, and watched.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/homing_runs.hpp"
#include "axes/axis/measured.hpp"
#include "axes/axis/mode_state.hpp"

namespace taktwerk::axes {

class Aim;
class Conduct;
class RetainedCoordinates;

class FeedbackIntake {
public:
    FeedbackIntake(AxisBody& body, Measured& measured, AxisMotion& motion, Aim& aim, const HomingRuns& runs, const ModeState& modes,
                   RetainedCoordinates& retained, Conduct& conduct) noexcept
        : body_(body),
          measured_(measured),
          motion_(motion),
          aim_(aim),
          runs_(runs),
          modes_(modes),
          retained_(retained),
          conduct_(conduct) {}

    /// True: the set-point has been placed anew.
    [[nodiscard]] bool read(const DriveFeedback& from_drive) noexcept;
    void watch_drive() noexcept;
    /// Instead, of an axis that only measures: whether its position holds.
    void watch_encoder() noexcept;
    /// Nothing for watch_drive() and run_power(): power is on and stays on, and the drive says nothing to the contrary.
    [[nodiscard]] static bool as_wanted(const AxisBody& body, const Measured& measured, const HomingRuns& runs,
                                        const ModeState& modes) noexcept {
        const bool well = measured.feedback.fresh && measured.feedback.online && measured.feedback.power == PowerState::enabled &&
                          !measured.feedback.fault && !measured.feedback.setup_refused && !measured.feedback.warning &&
                          measured.feedback.mode == modes.own;
        const bool stays_on = body.power.on() && body.state != AxisState::Disabled && body.state != AxisState::ErrorStop;
        return well && stays_on && body.driven && modes.phase == ModePhase::steady && !runs.drive.busy() && body.alarms.active().empty();
    }

private:
    [[nodiscard]] bool tell_found() noexcept;

    AxisBody& body_;
    Measured& measured_;
    AxisMotion& motion_;
    Aim& aim_;
    const HomingRuns& runs_;
    const ModeState& modes_;
    RetainedCoordinates& retained_;
    Conduct& conduct_;
};

}  // namespace taktwerk::axes
