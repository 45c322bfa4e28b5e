#pragma once
// Braking to rest with constant limits: jerk, then deceleration, then jerk again. Where a halt begins to search.

#include <cmath>

namespace taktwerk::axes {

class Braking {
public:
    /// From velocity v > 0 and acceleration a [u/s, u/s2], which may be of either sign; deceleration and jerk > 0.
    Braking(double v, double a, double deceleration, double jerk) noexcept : v_(v), a_(a), jerk_(jerk) {
        const double most = std::sqrt(std::fmax(jerk * v + a * a / 2, 0.0));
        peak_ = std::fmax(std::fmin(most, deceleration), std::fmax(-a, 0.0));
        ramp_ = (a + peak_) / jerk;
        last_ = peak_ / jerk;
        hold_ = peak_ > 0 ? std::fmax((v + (a * a / 2 - peak_ * peak_) / jerk) / peak_, 0.0) : 0.0;
    }
    [[nodiscard]] double duration() const noexcept { return ramp_ + hold_ + last_; }
    [[nodiscard]] double way() const noexcept { return at(duration()).way; }

    struct State {
        double way, velocity;
    };
    [[nodiscard]] State at(double t) const noexcept {
        const double one = std::fmin(t, ramp_);
        State s{one * (v_ + one * (a_ / 2 - one * jerk_ / 6)), v_ + one * (a_ - one * jerk_ / 2)};
        if (t <= ramp_) return s;
        const double two = std::fmin(t - ramp_, hold_);
        s = {s.way + two * (s.velocity - two * peak_ / 2), s.velocity - two * peak_};
        if (t <= ramp_ + hold_) return s;
        const double three = std::fmin(t - ramp_ - hold_, last_);
        return {s.way + three * (s.velocity - three * (peak_ / 2 - three * jerk_ / 6)), s.velocity - three * (peak_ - three * jerk_ / 2)};
    }

private:
    double v_, a_, jerk_;
    double peak_, ramp_, hold_, last_;  // deceleration; times of the three parts
};

}  // namespace taktwerk::axes
