#pragma once
// MC_Home: which sequence runs, and how its result becomes the axis' coordinates.

#include <utility>

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/homing_runs.hpp"
#include "axes/axis/measured.hpp"
#include "axes/axis/mode_state.hpp"

namespace taktwerk::axes {

class Aim;
class Conduct;
class HomingReference;
class HomingSteps;
class LimitGuard;
class SearchMotion;

class AxisHoming {
public:
    AxisHoming(AxisBody& body, const Measured& measured, AxisMotion& motion, Aim& aim, HomingRuns& runs, const ModeState& modes,
               HomingReference& reference, SearchMotion& search, HomingSteps& steps, Conduct& conduct, LimitGuard& guard) noexcept
        : body_(body),
          measured_(measured),
          motion_(motion),
          aim_(aim),
          runs_(runs),
          modes_(modes),
          reference_(reference),
          search_(search),
          steps_(steps),
          conduct_(conduct),
          guard_(guard) {}

    [[nodiscard]] ErrorId refuse() const noexcept;
    ErrorId begin(const AxisCommand& command) noexcept;
    void step() noexcept;
    /// What the port makes sure of before it starts the drive's homing. Nothing: the start-up list has it.
    [[nodiscard]] DriveHomingSetup drive_setup() const noexcept;

    /// Once: it has ended, and what waits has its turn.
    [[nodiscard]] bool over() noexcept { return std::exchange(over_, false); }

private:
    [[nodiscard]] StepSettings home_search() const noexcept;
    void search_home_switch() noexcept;
    void take_edge() noexcept;
    [[nodiscard]] MotionLimits dynamics() const noexcept;
    void run_home_search() noexcept;
    void end(std::int64_t reference) noexcept;

    AxisBody& body_;
    const Measured& measured_;
    AxisMotion& motion_;
    Aim& aim_;
    HomingRuns& runs_;
    const ModeState& modes_;
    HomingReference& reference_;
    SearchMotion& search_;
    HomingSteps& steps_;
    Conduct& conduct_;
    LimitGuard& guard_;

    double home_coordinate_ = 0;  // u, of the reference
    bool over_ = false;
};

}  // namespace taktwerk::axes
