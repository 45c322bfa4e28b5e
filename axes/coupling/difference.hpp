#pragma once
// What a slave still differs from its relation: a motion of its own that runs down. Real-time safe.
//
// It is planned for a relation that keeps its acceleration, and beside it.

#include "axes/planner/plan.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

class Difference {
public:
    [[nodiscard]] static Plan plan(const MotionState& from, const SignedLimits& limits) noexcept { return plan_to_state(from, {}, limits); }
    void run(const Profile& profile) noexcept {
        profile_ = profile;
        state_ = profile.start();
        elapsed_ = {};
    }
    void clear() noexcept {
        profile_ = Profile{};
        state_ = {};
        elapsed_ = {};
    }
    [[nodiscard]] const MotionState& advance(Duration period) noexcept {
        elapsed_ += period;
        state_ = profile_.at(to_seconds(elapsed_));
        return state_;
    }
    [[nodiscard]] const MotionState& state() const noexcept { return state_; }
    /// s
    [[nodiscard]] double remaining() const noexcept { return profile_.duration() - to_seconds(elapsed_); }
    [[nodiscard]] bool finished() const noexcept { return to_seconds(elapsed_) >= profile_.duration(); }

private:
    Profile profile_;
    MotionState state_;
    Duration elapsed_{};
};

}  // namespace taktwerk::axes
