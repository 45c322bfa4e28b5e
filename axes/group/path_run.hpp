#pragma once
// One way with its time: a scalar s(t), jerk-limited, from rest at its beginning to rest at its end, under the members' limits along it. Override,
// halts and stops act on s alone, so that the way is the same whatever they do; and whatever they do the run ends at rest on the way. Real-time safe.
//
// This is what a group asks of a path. Stretches of axes/path/ (curves, blends, look-ahead) take its place with the same questions.

#include "axes/group/group_command.hpp"
#include "axes/group/group_view.hpp"
#include "axes/group/straight_way.hpp"
#include "axes/planner/profile.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

class PathRun {
public:
    /// From rest. `wanted`: 0 = what `limits` leave; more is held down to them. False: no motion can be planned (a limit is no number), and it is
    /// over where it begins.
    bool begin(const StraightWay& way, const WayLimits& limits, const PathDynamics& wanted, const Override& factors) noexcept;
    /// Nothing to run; the members stand.
    void clear() noexcept { *this = {}; }

    /// One period on.
    void advance(Duration period) noexcept;

    /// Other factors, from now on. Where the way left is too short for less acceleration or jerk they wait until it is not (G-071).
    void override_with(const Override& factors) noexcept;
    /// Comes to rest on the way, at its end at the latest. `ramp`: deceleration and jerk, 0 = the limits'.
    void stop(const PathDynamics& ramp, const Override& factors, Duration period) noexcept;
    /// After a stop: on to the end.
    void resume(const Override& factors) noexcept;

    [[nodiscard]] bool exists() const noexcept { return exists_; }
    /// At rest, and stays so by itself.
    [[nodiscard]] bool over() const noexcept { return !exists_ || to_seconds(elapsed_) >= profile_.duration(); }
    /// At rest at the end.
    [[nodiscard]] bool arrived() const noexcept { return over() && s_.position == way_.length; }
    [[nodiscard]] bool stops() const noexcept { return stops_; }

    [[nodiscard]] const MotionState& along() const noexcept { return s_; }
    [[nodiscard]] MotionState of(std::size_t place) const noexcept { return way_.at(place, s_); }
    [[nodiscard]] const JointVector& end() const noexcept { return way_.to; }
    [[nodiscard]] double length() const noexcept { return way_.length; }
    [[nodiscard]] double remaining() const noexcept { return way_.length - s_.position; }
    /// s, of the plan that holds now; 0 where it does not lead to the end.
    [[nodiscard]] double remaining_time() const noexcept;
    [[nodiscard]] PathLimiter limiter() const noexcept;
    [[nodiscard]] std::uint8_t narrowest() const noexcept { return limits_.narrowest; }

private:
    [[nodiscard]] bool plan() noexcept;
    void take(const Profile& profile) noexcept;

    StraightWay way_;
    WayLimits limits_;
    PathDynamics wanted_;  // resolved: what the command may have, without factors
    Override factors_;
    Profile profile_;
    Duration elapsed_{};  // since the profile began
    int piece_ = 0;
    MotionState s_;
    bool exists_ = false;
    bool stops_ = false;         // the goal is rest, not the end
    bool plan_pending_ = false;  // factors that could not be taken yet
};

}  // namespace taktwerk::axes
