#include "axes/planner/ramp.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

// In the plane of velocity and acceleration a jerk of constant magnitude draws parabolas, v = c + a^2/2j and v = c - a^2/2j.
// With the eases r = 1/j of the rise and f of the fall, a climb of dv from a0 over the peak p to a1 has
//     dv = (p^2 - a0^2) r/2 + (p^2 - a1^2) f/2,   also for a0 < 0.

namespace taktwerk::axes {

Ramp::Ramp(const Climb& c, const FrameLimits& limits) noexcept : limits_{limits}, velocity_{c.v0}, turn_velocity_{c.v0} {
    const double before = limits.up.slowing_down;
    const double after = limits.up.speeding_up;
    const double rise = limits.up.ease;
    const double fall = limits.down.ease;
    if (limits.jerk_free()) {
        if (c.v0 < 0 && c.v1 > 0) {
            gain(-c.v0, before);
            gain(c.v1, after);
        } else {
            gain(c.fall_square, c.v1 > 0 ? after : before);
        }
        return;
    }
    if (before == after || !(c.lowest < 0 && c.v1 > 0)) {
        // At standstill alone, acceleration only comes and goes: whichever side it is of has it.
        const double bound = c.v1 > 0 ? after : (c.lowest < 0 ? before : std::max(before, after));
        leg(c.a0, c.a1, c.fall_square, c.rise_square, bound);
        return;
    }
    // Two legs. The first one may arrive at velocity 0 only with what the second one can take over: its own limit, and what can
    // still be taken away before the end.
    const double room = fall > 0 ? std::sqrt(c.a1 * c.a1 + 2 * c.v1 / fall) : std::numeric_limits<double>::infinity();
    const double crossing = leg_to_standstill(c.a0, std::min({before, after, room}), before);
    const double difference = (c.a1 - crossing) * (c.a1 + crossing);
    const double fall_square = (2 * c.v1 - difference * rise) / (rise + fall);
    const double first_peak = peak_;
    const double first_turn = turn_velocity_;
    const double first_fall = fall_duration_;
    leg(crossing, c.a1, fall_square, fall_square + difference, after);
    if (crossing < room) return;
    // The second leg only goes on falling: one fall, which began in the first.
    peak_ = first_peak;
    turn_velocity_ = first_turn;
    fall_duration_ += first_fall;
}

void Ramp::add(double duration, double acceleration, double jerk) noexcept {
    if (!(duration > 0)) return;
    stretches_[static_cast<std::size_t>(count_++)] = {duration, acceleration, jerk, 0};
    const double way = duration * (velocity_ + duration * (acceleration / 2 + duration * (jerk / 6)));
    velocity_ += duration * (acceleration + duration * (jerk / 2));
    travel_ += way;
    path_ += std::abs(way);
    duration_ += duration;
}

/// Without a jerk limit: a straight line, or a jump where the acceleration has no limit either.
void Ramp::gain(double dv, double bound) noexcept {
    peak_ = bound;
    if (!(dv > 0)) return;
    if (std::isinf(bound)) {
        stretches_[static_cast<std::size_t>(count_++)] = {0, 0, 0, dv};
        velocity_ += dv;
    } else {
        add(dv / bound, bound, 0);
    }
    turn_velocity_ = velocity_;
}

/// Rise, hold, fall.
void Ramp::leg(double a0, double a1, double fall_square, double rise_square, double bound) noexcept {
    const double rise = limits_.up.ease;
    const double fall = limits_.down.ease;
    fall_square = std::max(fall_square, 0.0);
    const double square = a1 * a1 + fall_square;
    double drop = 0;
    if (square <= bound * bound) {
        peak_ = std::sqrt(square);
        const double climb = a0 > 0 ? std::max(rise_square, 0.0) / (peak_ + a0) : peak_ - a0;
        add(climb * rise, a0, limits_.up.jerk);
        drop = fall_square > 0 ? fall_square / (peak_ + a1) : 0;
    } else {
        peak_ = bound;
        add((bound - a0) * rise, a0, limits_.up.jerk);
        add((fall_square + (a1 - bound) * (a1 + bound)) * (rise + fall) / (2 * bound), bound, 0);
        drop = bound - a1;
    }
    turn_velocity_ = velocity_;
    fall_duration_ = drop * fall;
    add(fall_duration_, peak_, -limits_.down.jerk);
}

/// The leg up to velocity 0, with acceleration a1 there if possible: less where the gain is too short to build it up, more where
/// it is too short to take it away. Returns what it is.
double Ramp::leg_to_standstill(double a0, double a1, double bound) noexcept {
    const double rise = limits_.up.ease;
    const double fall = limits_.down.ease;
    const double dv = -velocity_;
    const double difference = (a1 - a0) * (a1 + a0);
    const double fall_square = (2 * dv - difference * rise) / (rise + fall);
    const double rise_square = fall_square + difference;
    if (fall_square < 0) {
        const double end = std::sqrt(std::max(a0 * a0 + 2 * dv / rise, 0.0));
        add((end - a0) * rise, a0, limits_.up.jerk);
        peak_ = end;
        turn_velocity_ = 0;
        return end;
    }
    if (a0 > 0 && rise_square < 0) {
        const double end = std::sqrt(std::max(a0 * a0 - 2 * dv / fall, 0.0));
        peak_ = a0;
        fall_duration_ = (a0 - end) * fall;
        add(fall_duration_, a0, -limits_.down.jerk);
        return end;
    }
    leg(a0, a1, fall_square, rise_square, bound);
    return a1;
}

}  // namespace taktwerk::axes
