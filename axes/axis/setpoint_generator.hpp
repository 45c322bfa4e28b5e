#pragma once
// Where the set-point is now and where the running profile takes it. Advances in motion time: exactly one period per call.

#include "axes/planner/plan.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

class SetpointGenerator {
public:
    [[nodiscard]] const MotionState& state() const noexcept { return state_; }
    [[nodiscard]] double jerk() const noexcept { return moving_profile_ ? profile_.jerk_at(time()) : jerk_; }

    /// Stands at `position`, without a profile.
    void place(double position) noexcept { set({position, 0, 0}); }
    /// The same motion seen from another anchor; a profile must follow before the next advance() where it moves.
    void rebase(double position) noexcept {
        state_.position = position;
        moving_profile_ = false;
        jerk_ = 0;
    }
    /// Where something else than a profile (a table over time, a fed set-point, the motor itself) has taken the set-point this cycle.
    void set(const MotionState& state, double jerk = 0) noexcept {
        state_ = state;
        moving_profile_ = false;
        jerk_ = jerk;
    }
    /// Takes back the last advance(); a profile must follow.
    void restore(const MotionState& state) noexcept { set(state); }
    /// `profile` begins at the present state, `late` seconds ago.
    void run(const Profile& profile, double late = 0) noexcept {
        profile_ = profile;
        offset_ = late;
        elapsed_ = Duration{};
        moving_profile_ = true;
    }
    /// One period on.
    void advance(Duration period) noexcept {
        elapsed_ += period;
        sample();
    }
    /// Takes the present time of the profile again, after run(profile, late).
    void sample() noexcept {
        if (moving_profile_) state_ = profile_.at(time());
    }
    /// The profile has reached its end state (a velocity profile then moves on).
    [[nodiscard]] bool finished() const noexcept { return !moving_profile_ || time() >= profile_.duration(); }
    /// Seconds since the profile reached its end; only when finished().
    [[nodiscard]] double overtime() const noexcept { return moving_profile_ ? time() - profile_.duration() : 0.0; }
    [[nodiscard]] const MotionState& end() const noexcept { return moving_profile_ ? profile_.end() : state_; }
    /// Goes to the profile's end state: where the next command of a queue begins.
    void go_to_end() noexcept { state_ = end(); }
    [[nodiscard]] bool at_rest() const noexcept { return state_.velocity == 0 && state_.acceleration == 0; }

private:
    [[nodiscard]] double time() const noexcept { return offset_ + to_seconds(elapsed_); }

    Profile profile_;
    MotionState state_;
    Duration elapsed_{};
    double offset_ = 0;
    double jerk_ = 0;  // without a profile
    bool moving_profile_ = false;
};

}  // namespace taktwerk::axes
