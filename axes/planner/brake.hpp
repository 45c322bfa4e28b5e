#pragma once
// Bringing a start outside the limits inside them. Internal to the planner.

#include <array>
#include <span>

#include "axes/planner/motion_frame.hpp"
#include "axes/planner/profile.hpp"

namespace taktwerk::axes {

/// What every motion from (v, a) has to begin with, whatever its target: acceleration beyond its limit is given back with full jerk, then a
/// velocity that would exceed its limit is reduced with full deceleration, until just giving the deceleration back ends on the limit.
/// Empty for a start inside the limits. At most two stretches, and one more after go_to_limit().
class Brake {
public:
    Brake(double v, double a, const FrameLimits& limits) noexcept;

    [[nodiscard]] std::span<const Stretch> stretches() const noexcept { return {stretches_.data(), static_cast<std::size_t>(count_)}; }
    /// Where it ends.
    [[nodiscard]] double velocity() const noexcept { return velocity_; }
    [[nodiscard]] double acceleration() const noexcept { return acceleration_; }
    /// A velocity beyond its limit had to be reduced.
    [[nodiscard]] bool reduced_velocity() const noexcept { return reduced_velocity_; }
    /// What the velocity becomes from there when the deceleration is given back.
    [[nodiscard]] double released() const noexcept { return released_; }
    /// How many times the limit the fastest velocity was that had to be reduced with a jerk; 0: none.
    [[nodiscard]] double beyond() const noexcept { return beyond_; }
    /// Sense of the velocity that was reduced.
    [[nodiscard]] double sense() const noexcept { return sense_; }
    /// Gives the deceleration back as well: to exactly the limit, at rest there. Only after a velocity was reduced with a jerk.
    void go_to_limit(const FrameLimits& limits) noexcept;
    [[nodiscard]] double travel() const noexcept { return travel_; }
    [[nodiscard]] double path() const noexcept { return path_; }
    [[nodiscard]] double duration() const noexcept { return duration_; }

private:
    void give_acceleration_back(const FrameLimits& limits) noexcept;
    bool give_velocity_back(const FrameLimits& limits) noexcept;
    void add(double duration, double acceleration, double jerk, double end_acceleration) noexcept;
    void jump(double dv) noexcept;

    std::array<Stretch, 4> stretches_;  // the first count_
    int count_ = 0;
    double sign_ = 1;  // the frame is mirrored where it is -1
    double velocity_ = 0;
    double acceleration_ = 0;
    double released_ = 0;
    double fastest_ = 0;
    double beyond_ = 0;
    double sense_ = 1;
    bool reduced_velocity_ = false;
    double travel_ = 0;
    double path_ = 0;
    double duration_ = 0;
};

/// Could a motion inside the limits be in this state? `slack` is relative.
[[nodiscard]] bool keeps_limits(double v, double a, const FrameLimits& limits, double slack) noexcept;

}  // namespace taktwerk::axes
