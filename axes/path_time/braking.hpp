#pragma once
// Braking to rest, or to a lower velocity, with constant limits: jerk, then deceleration, then jerk again. Where a search begins.

#include <cmath>

namespace taktwerk::axes {

class Braking {
public:
    /// From velocity v > to >= 0 and acceleration a [u/s, u/s2], which may be of either sign; deceleration and jerk > 0. Where it speeds up, and `rise_jerk` is given, its acceleration goes
    /// with that first; v may be at most a a / (2 rise_jerk) below `to` then.
    Braking(double from, double a, double deceleration, double jerk, double to = 0, double rise_jerk = 0) noexcept
        : to_(to), v_(from - to), a_(a), jerk_(jerk) {
        if (rise_jerk > 0 && a > 0) {
            rise_from_ = v_, rise_a_ = a, rise_jerk_ = rise_jerk;
            rise_ = a / rise_jerk;
            const State top = rising(rise_);
            rise_way_ = top.way;
            v_ = std::fmax(top.velocity, 0.0);
            a_ = a = 0;
        }
        const double v = v_;
        const double most = std::sqrt(std::fmax(jerk * v + a * a / 2, 0.0));
        peak_ = std::fmax(std::fmin(most, deceleration), std::fmax(-a, 0.0));
        ramp_ = (a + peak_) / jerk;
        last_ = peak_ / jerk;
        hold_ = peak_ > 0 ? std::fmax((v + (a * a / 2 - peak_ * peak_) / jerk) / peak_, 0.0) : 0.0;
    }
    [[nodiscard]] double duration() const noexcept { return rise_ + ramp_ + hold_ + last_; }
    /// Until the deceleration is there, and from where it goes.
    [[nodiscard]] double ramp_way() const noexcept { return at(rise_ + ramp_).way; }
    [[nodiscard]] double last_way() const noexcept { return way() - at(rise_ + ramp_ + hold_).way; }
    [[nodiscard]] double way() const noexcept { return at(duration()).way; }
    /// The highest velocity on the way.
    [[nodiscard]] double top() const noexcept { return to_ + v_ + std::fmax(a_, 0.0) * std::fmax(a_, 0.0) / (2 * jerk_); }

    struct State {
        double way, velocity;
    };
    /// Behind its end it stays at the lower velocity.
    [[nodiscard]] State at(double t) const noexcept {
        const State s = beyond(t);
        return {s.way + to_ * t, s.velocity + to_};
    }

private:
    [[nodiscard]] State rising(double t) const noexcept {
        return {t * (rise_from_ + t * (rise_a_ / 2 - t * rise_jerk_ / 6)), rise_from_ + t * (rise_a_ - t * rise_jerk_ / 2)};
    }
    [[nodiscard]] State beyond(double t) const noexcept {
        if (t < rise_) return rising(t);
        const State s = braked(t - rise_);
        return {s.way + rise_way_, s.velocity};
    }
    [[nodiscard]] State braked(double t) const noexcept {
        const double one = std::fmin(t, ramp_);
        State s{one * (v_ + one * (a_ / 2 - one * jerk_ / 6)), v_ + one * (a_ - one * jerk_ / 2)};
        if (t <= ramp_) return s;
        const double two = std::fmin(t - ramp_, hold_);
        s = {s.way + two * (s.velocity - two * peak_ / 2), s.velocity - two * peak_};
        if (t <= ramp_ + hold_) return s;
        const double three = std::fmin(t - ramp_ - hold_, last_);
        return {s.way + three * (s.velocity - three * (peak_ / 2 - three * jerk_ / 6)), s.velocity - three * (peak_ - three * jerk_ / 2)};
    }

    double to_;
    double rise_from_ = 0, rise_a_ = 0, rise_jerk_ = 0;  // while it still speeds up; velocity above that
    double rise_ = 0, rise_way_ = 0;                     // its time and way
    double v_, a_, jerk_;                                // behind that; v: above the lower velocity
    double peak_, ramp_, hold_, last_;                   // deceleration; times of the three parts
};

/// The same by its way; asked for in ascending order.
class BrakingByWay {
public:
    explicit BrakingByWay(const Braking& braking) noexcept : braking_(braking), way_(braking.way()) {}

    /// Behind its end it stays at the lower velocity.
    [[nodiscard]] double velocity(double way) noexcept {
        if (way >= way_) return braking_.at(braking_.duration()).velocity;
        // Newton from where it was asked for before, kept between what is too early and too late: as exact as the parts themselves, whose jerk a search has to see.
        double early = time_, late = braking_.duration();
        Braking::State now = braking_.at(time_);
        for (int i = 0; i < most_steps && std::fabs(way - now.way) > exact * way_; ++i) {
            (now.way < way ? early : late) = time_;
            const double next = time_ + (way - now.way) / now.velocity;
            time_ = next > early && next < late ? next : (early + late) / 2;
            now = braking_.at(time_);
        }
        return std::fmax(now.velocity, 0.0);
    }

private:
    static constexpr int most_steps = 60;
    static constexpr double exact = 1e-13;
    Braking braking_;
    double way_;
    double time_ = 0;
};

}  // namespace taktwerk::axes
