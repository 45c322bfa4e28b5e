#include "axes/planner/ramp.hpp"

namespace taktwerk::axes {

void Ramp::jerk_free(const Climb& c, const FrameLimits& limits) noexcept {
    const double before = limits.up.slowing_down;
    const double after = limits.up.speeding_up;
    if (c.v0 < 0 && c.v1 > 0) {
        gain(-c.v0, before);
        gain(c.v1, after);
    } else {
        gain(c.fall_square, c.v1 > 0 ? after : before);
    }
}

/// A straight line, or a jump where the acceleration has no limit either.
void Ramp::gain(double dv, double bound) noexcept {
    peak_ = bound;
    if (!(dv > 0)) return;
    if (std::isinf(bound)) {
        stretches_[static_cast<std::size_t>(count_++)] = {0, 0, 0, dv};
        velocity_ += dv;
    } else {
        add(dv / bound, bound, bound, 0);
    }
    turn_velocity_ = velocity_;
}

/// The first leg may arrive at velocity 0 only with what the second one can take over: its own limit, and what can still be taken away
/// before the end.
void Ramp::two_legs(const Climb& c, const FrameLimits& limits) noexcept {
    const double before = limits.up.slowing_down;
    const double after = limits.up.speeding_up;
    const double rise = limits.up.ease;
    const double fall = limits.down.ease;
    const double room = fall > 0 ? std::sqrt(c.a1 * c.a1 + 2 * c.v1 / fall) : std::numeric_limits<double>::infinity();
    const double crossing = leg_to_standstill(c.a0, std::min({before, after, room}), before, limits);
    const double difference = (c.a1 - crossing) * (c.a1 + crossing);
    const double fall_square = (2 * c.v1 - difference * rise) / (rise + fall);
    const double first_peak = peak_;
    const double first_turn = turn_velocity_;
    const double first_fall = fall_duration_;
    leg(crossing, c.a1, fall_square, fall_square + difference, after, limits);
    if (crossing < room) return;
    // The second leg only goes on falling: one fall, which began in the first.
    peak_ = first_peak;
    turn_velocity_ = first_turn;
    fall_duration_ += first_fall;
}

/// The leg up to velocity 0, with acceleration a1 there if possible: less where the gain is too short to build it up, more where
/// it is too short to take it away. Returns what it is.
double Ramp::leg_to_standstill(double a0, double a1, double bound, const FrameLimits& limits) noexcept {
    const double rise = limits.up.ease;
    const double fall = limits.down.ease;
    const double dv = -velocity_;
    const double difference = (a1 - a0) * (a1 + a0);
    const double fall_square = (2 * dv - difference * rise) / (rise + fall);
    const double rise_square = fall_square + difference;
    if (fall_square < 0) {
        const double end = std::sqrt(std::max(a0 * a0 + 2 * dv / rise, 0.0));
        add((end - a0) * rise, a0, end, limits.up.jerk);
        peak_ = end;
        turn_velocity_ = 0;
        return end;
    }
    if (a0 > 0 && rise_square < 0) {
        const double end = std::sqrt(std::max(a0 * a0 - 2 * dv / fall, 0.0));
        peak_ = a0;
        fall_duration_ = (a0 - end) * fall;
        add(fall_duration_, a0, end, -limits.down.jerk);
        return end;
    }
    leg(a0, a1, fall_square, rise_square, bound, limits);
    return a1;
}

}  // namespace taktwerk::axes
