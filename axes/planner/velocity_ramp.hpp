#pragma once
// The one brick every profile is built from: the fastest change of velocity, ending without acceleration.
// Internal to the planner; planners outside use plan.hpp.

#include <array>
#include <span>

#include "axes/planner/motion.hpp"
#include "axes/planner/profile.hpp"

namespace taktwerk::axes {

/// Limits as seen when pushing in one direction, called "up" below: coordinates are mirrored so that up is positive.
struct PushLimits {
    double velocity = 0;      ///< the fastest up, u/s
    double speeding_up = 0;   ///< acceleration while moving up, u/s2
    double slowing_down = 0;  ///< acceleration while still moving down, u/s2
    double jerk_on = 0;       ///< magnitude of the jerk that adds push, u/s3
    double jerk_off = 0;      ///< magnitude of the jerk that takes it away
};

/// Both directions. PLCopen's limits are the same both ways; limits of their own per sign fit in here.
struct TwoWayLimits {
    PushLimits up;
    PushLimits down;

    [[nodiscard]] TwoWayLimits mirrored() const noexcept { return {down, up}; }
};

[[nodiscard]] TwoWayLimits two_way(const MotionLimits& limits) noexcept;

/// The fastest way from (velocity, acceleration) to (target, 0). In its crossing of velocity 0 the acceleration is one that both
/// sides allow, so a reversal does not stop in between. A start outside the limits is brought inside with full jerk first.
class VelocityRamp {
public:
    VelocityRamp(double velocity, double acceleration, double target, const TwoWayLimits& limits) noexcept;

    [[nodiscard]] std::span<const Stretch> stretches() const noexcept { return {stretches_.data(), static_cast<std::size_t>(count_)}; }
    /// Signed way from beginning to end, u.
    [[nodiscard]] double travel() const noexcept { return travel_; }
    /// Sum of the ways without regard to sign: the scale of rounding errors in travel().
    [[nodiscard]] double path() const noexcept { return path_; }
    [[nodiscard]] double duration() const noexcept { return duration_; }

private:
    void add(double duration, double acceleration, double jerk) noexcept;
    void rise(double velocity, double acceleration, double target, const PushLimits& limits) noexcept;
    double leg(double dv, double a0, double a1, double bound, const PushLimits& limits) noexcept;
    void step(double velocity, double target, const PushLimits& limits) noexcept;

    std::array<Stretch, 6> stretches_{};
    int count_ = 0;
    double sign_ = 1;
    double velocity_ = 0;  // at the end of what was added so far
    double travel_ = 0;
    double path_ = 0;
    double duration_ = 0;
};

}  // namespace taktwerk::axes
