#pragma once
// What phasing adds to the master's position as the slave sees it. Real-time safe.

#include "axes/planner/plan.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

class PhaseShift {
public:
    /// From the present shift, wherever it is on its way, to `target` [u of the master]. False when nothing can be planned.
    [[nodiscard]] bool begin(double target, const MotionLimits& limits) noexcept {
        const auto plan = plan_to_position(state_, target, limits);
        if (!run(plan, limits)) return false;
        from_ = state_.position;
        return true;
    }
    /// Ends the motion where its ramp ends; the shift so far stays. False when nothing can be planned.
    [[nodiscard]] bool stop(const MotionLimits& limits) noexcept { return run(plan_stop(state_, limits), limits); }
    void clear() noexcept { *this = {}; }
    void advance(Duration period) noexcept {
        if (!running_) return;
        elapsed_ += period;
        state_ = profile_.at(to_seconds(elapsed_));
        running_ = to_seconds(elapsed_) < profile_.duration();
        if (!running_) state_ = profile_.end();
    }
    [[nodiscard]] const MotionState& state() const noexcept { return state_; }
    [[nodiscard]] bool running() const noexcept { return running_; }
    /// Since the last begin(), u.
    [[nodiscard]] double covered() const noexcept { return state_.position - from_; }
    /// Which the present motion was planned with.
    [[nodiscard]] double jerk() const noexcept { return jerk_; }

private:
    bool run(const Plan& plan, const MotionLimits& limits) noexcept {
        if (plan.error != PlanError::none) return false;
        profile_ = plan.profile;
        jerk_ = limits.jerk;
        elapsed_ = {};
        running_ = true;
        return true;
    }

    Profile profile_;
    MotionState state_;
    Duration elapsed_{};
    double from_ = 0, jerk_ = 0;
    bool running_ = false;
};

}  // namespace taktwerk::axes
