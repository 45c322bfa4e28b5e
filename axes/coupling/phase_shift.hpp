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
        if (plan.error != PlanError::none) return false;
        profile_ = plan.profile;
        elapsed_ = {};
        from_ = state_.position;
        running_ = true;
        return true;
    }
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

private:
    Profile profile_;
    MotionState state_;
    Duration elapsed_{};
    double from_ = 0;
    bool running_ = false;
};

}  // namespace taktwerk::axes
