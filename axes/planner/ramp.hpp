#pragma once
// The brick every profile is built from: the fastest climb of the velocity. Internal to the planner.

#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "axes/planner/frame.hpp"
#include "axes/planner/profile.hpp"

namespace taktwerk::axes {

/// A climb from (v0, a0) to (v1, a1), a1 >= 0. The two differences of squares are given by who knows them without cancellation: with
/// the peak p that the acceleration would reach without its limit, fall_square = p^2 - a1^2 and rise_square = p^2 - a0^2 (used for a0 > 0).
/// Without a jerk limit there is no such peak; then fall_square is v1 - v0 itself.
struct Climb {
    double v0 = 0;
    double a0 = 0;
    double v1 = 0;
    double a1 = 0;
    double lowest = 0;  ///< velocity on the way
    double fall_square = 0;
    double rise_square = 0;
};

/// The climb that keeps the acceleration, at every velocity, as high as three curves allow: the parabola that rises from the start, the
/// acceleration limit of that velocity, and the parabola that falls into the end. In its crossing of velocity 0 the acceleration is one
/// that both sides allow, so a reversal does not stop in between. The start must be able to keep the limits (see brake.hpp).
class Ramp {
public:
    Ramp(const Climb& climb, const FrameLimits& limits) noexcept;

    [[nodiscard]] std::span<const Stretch> stretches() const noexcept { return {stretches_.data(), static_cast<std::size_t>(count_)}; }
    /// Signed way from beginning to end, u.
    [[nodiscard]] double travel() const noexcept { return travel_; }
    /// Sum of the ways without regard to sign: the scale of rounding errors in travel().
    [[nodiscard]] double path() const noexcept { return path_; }
    [[nodiscard]] double duration() const noexcept { return duration_; }
    /// As it comes out of the stretches: v1 but for rounding.
    [[nodiscard]] double end_velocity() const noexcept { return velocity_; }
    /// The (last) highest acceleration, and the velocity at which it begins to fall.
    [[nodiscard]] double peak() const noexcept { return peak_; }
    [[nodiscard]] double turn_velocity() const noexcept { return turn_velocity_; }
    /// Duration of the (last) fall from there.
    [[nodiscard]] double fall_duration() const noexcept { return fall_duration_; }

private:
    void add(double duration, double acceleration, double jerk) noexcept;
    void gain(double dv, double bound) noexcept;
    void leg(double a0, double a1, double fall_square, double rise_square, double bound) noexcept;
    double leg_to_standstill(double a0, double a1, double bound) noexcept;

    const FrameLimits& limits_;
    std::array<Stretch, 6> stretches_{};
    int count_ = 0;
    double velocity_ = 0;  // at the end of what was added so far
    double travel_ = 0;
    double path_ = 0;
    double duration_ = 0;
    double peak_ = 0;
    double turn_velocity_ = 0;
    double fall_duration_ = 0;
};

/// The climb from (v, a) to `excess` above its `released` velocity, ending without acceleration. excess >= 0; so a bump of 1e-14 on a
/// velocity of 1000 still has all its digits.
[[nodiscard]] inline Climb climb_above_release(double v, double a, double released, double excess, const FrameLimits& limits) noexcept {
    const double ease = limits.up.ease + limits.down.ease;
    const double square = ease > 0 ? 2 * excess / ease : excess;
    const double held = a > 0 && ease > 0 ? a : 0.0;
    return {v, a, released + excess, 0, a < 0 ? released : v, square + held * held, square};
}

}  // namespace taktwerk::axes
