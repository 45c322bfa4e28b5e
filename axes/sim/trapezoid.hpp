#pragma once
// The profile that a drive makes by itself: constant accelerations, in continuous time, from any state of motion to a position. Made apart
// from the runtime's own planner on purpose, so that each can be held against the other. Real-time safe.

#include <array>
#include <cstddef>

#include "axes/sim/servo_loop.hpp"

namespace taktwerk::axes::sim {

/// 6081h, 6083h, 6084h. A drive with one of them at 0 does not move (SV33-E 8.5.5, SE-808X 4.2 note on 1601h).
struct TrapezoidLimits {
    double velocity = 0;                        ///< counts/s
    double acceleration = 0, deceleration = 0;  ///< counts/s2
    [[nodiscard]] bool usable() const noexcept { return velocity > 0 && acceleration > 0 && deceleration > 0; }
};

class Trapezoid {
public:
    /// Rests at `position` for ever.
    void rest(double position) noexcept;
    /// To `target`; arrives with `through` (>= 0) counts/s in the sense of the way, as far as acceleration allows. A motion that is too fast
    /// or heads away brakes first, passes the target where it must, and comes back. Not usable limits: stays where it is.
    void go(double position, double velocity, double target, const TrapezoidLimits& limits, double through = 0) noexcept;

    [[nodiscard]] double duration() const noexcept { return duration_; }  ///< s
    /// `t` from the start, >= 0; beyond the end it goes on with the velocity of the end.
    [[nodiscard]] Demand at(double t) const noexcept;

private:
    struct Phase {
        double seconds = 0, acceleration = 0;
    };
    void add(double seconds, double acceleration) noexcept;

    std::array<Phase, 5> phases_{};
    std::size_t count_ = 0;
    double position_ = 0, velocity_ = 0;  // at the start
    double target_ = 0, end_velocity_ = 0, duration_ = 0;
};

}  // namespace taktwerk::axes::sim
