#pragma once
// The brick every profile is built from: the fastest climb of the velocity. Internal to the planner.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "axes/planner/motion_frame.hpp"
#include "axes/planner/profile.hpp"

// In the plane of velocity and acceleration a jerk of constant magnitude draws parabolas, v = c + a^2/2j and v = c - a^2/2j.
// With the eases r = 1/j of the rise and f of the fall, a climb of dv from a0 over the peak p to a1 has
//     dv = (p^2 - a0^2) r/2 + (p^2 - a1^2) f/2,   also for a0 < 0.

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
    Ramp(const Climb& climb, const FrameLimits& limits) noexcept : velocity_{climb.v0}, turn_velocity_{climb.v0} {
        if (is_one_leg(climb, limits)) leg(climb.a0, climb.a1, climb.fall_square, climb.rise_square, bound_of(climb, limits), limits);
        else if (limits.jerk_free()) jerk_free(climb, limits);
        else two_legs(climb, limits);
    }

    /// Rise, hold and fall on one side of velocity 0, or where both sides have the same bound.
    [[nodiscard]] static bool is_one_leg(const Climb& c, const FrameLimits& l) noexcept {
        return l.up.ease + l.down.ease > 0 && (l.up.slowing_down == l.up.speeding_up || !(c.lowest < 0 && c.v1 > 0));
    }
    /// At standstill alone, acceleration only comes and goes: whichever side it is of has it.
    [[nodiscard]] static double bound_of(const Climb& c, const FrameLimits& l) noexcept {
        if (c.v1 > 0) return l.up.speeding_up;
        return c.lowest < 0 ? l.up.slowing_down : std::max(l.up.slowing_down, l.up.speeding_up);
    }

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
    void jerk_free(const Climb& climb, const FrameLimits& limits) noexcept;
    void gain(double dv, double bound) noexcept;
    void two_legs(const Climb& climb, const FrameLimits& limits) noexcept;
    double leg_to_standstill(double a0, double a1, double bound, const FrameLimits& limits) noexcept;

    /// From acceleration a to b.
    void add(double duration, double a, double b, double jerk) noexcept {
        if (!(duration > 0)) return;
        stretches_[static_cast<std::size_t>(count_++)] = {duration, a, jerk, 0};
        const double way = duration * (velocity_ + duration * ((a + a + b) * (1.0 / 6)));
        velocity_ += duration * ((a + b) / 2);
        travel_ += way;
        path_ += std::abs(way);
        duration_ += duration;
    }

    /// Rise, hold, fall.
    void leg(double a0, double a1, double fall_square, double rise_square, double bound, const FrameLimits& limits) noexcept {
        const double rise = limits.up.ease;
        const double fall = limits.down.ease;
        fall_square = std::max(fall_square, 0.0);
        const double square = a1 * a1 + fall_square;
        double drop = 0;
        if (square <= bound * bound) {
            peak_ = std::sqrt(square);
            const double climb = a0 > 0 ? std::max(rise_square, 0.0) / (peak_ + a0) : peak_ - a0;
            add(climb * rise, a0, peak_, limits.up.jerk);
            if (fall_square > 0) drop = a1 == 0 ? peak_ : fall_square / (peak_ + a1);
        } else {
            peak_ = bound;
            add((bound - a0) * rise, a0, bound, limits.up.jerk);
            add((fall_square + (a1 - bound) * (a1 + bound)) * (rise + fall) / (2 * bound), bound, bound, 0);
            drop = bound - a1;
        }
        turn_velocity_ = velocity_;
        fall_duration_ = drop * fall;
        add(fall_duration_, peak_, a1, -limits.down.jerk);
    }

    std::array<Stretch, 6> stretches_;  // the first count_
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
