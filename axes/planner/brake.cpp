#include "axes/planner/brake.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace taktwerk::axes {

namespace {

/// Square of the acceleration with which a rising motion at v < 0 that gives its acceleration back crosses velocity 0; negative where it
/// does not get there.
double crossing_square(double v, double a, const Bounds& down) noexcept { return down.ease > 0 ? a * a + 2 * v / down.ease : 0; }

/// `released`: velocity once the acceleration is given back.
bool keeps_limits_upwards(double v, double a, double released, const Bounds& up, const Bounds& down, double slack) noexcept {
    const double more = 1 + slack;
    if (!(released <= up.velocity * more)) return false;
    if (!(a > 0)) return true;
    if (v < 0) {
        const double most = up.speeding_up * more;
        return a <= up.slowing_down * more && crossing_square(v, a, down) <= most * most;
    }
    return a <= up.speeding_up * more;
}

}  // namespace

bool keeps_limits(double v, double a, const FrameLimits& limits, double slack) noexcept {
    const double released = released_velocity(v, a, limits);
    return keeps_limits_upwards(v, a, released, limits.up, limits.down, slack) &&
           keeps_limits_upwards(-v, -a, -released, limits.down, limits.up, slack);
}

Brake::Brake(double v, double a, const FrameLimits& limits) noexcept : velocity_{v}, acceleration_{limits.jerk_free() ? 0 : a} {
    released_ = released_velocity(velocity_, acceleration_, limits);
    if (keeps_limits(velocity_, acceleration_, limits, 0)) return;
    const FrameLimits mirrored = limits.mirrored();
    const auto in_both_frames = [&](auto step) noexcept {
        for (const FrameLimits* l : {&limits, &mirrored}) {
            sign_ = l == &limits ? 1 : -1;
            velocity_ *= sign_;
            acceleration_ *= sign_;
            step(*l);
            velocity_ *= sign_;
            acceleration_ *= sign_;
        }
    };
    in_both_frames([&](const FrameLimits& l) noexcept { give_acceleration_back(l); });
    released_ = released_velocity(velocity_, acceleration_, limits);
    in_both_frames([&](const FrameLimits& l) noexcept {
        if (!give_velocity_back(l)) return;
        released_ = sign_ * l.up.velocity;
        reduced_velocity_ = true;
    });
}

void Brake::give_acceleration_back(const FrameLimits& l) noexcept {
    if (!(acceleration_ > 0)) return;
    const double here = velocity_ < 0 ? l.up.slowing_down : l.up.speeding_up;
    const double beyond = l.up.speeding_up;
    const double fall = l.down.ease;
    const double crossing = velocity_ < 0 ? crossing_square(velocity_, acceleration_, l.down) : 0;
    double end = acceleration_;
    bool to_standstill = false;
    if (velocity_ < 0 && crossing > beyond * beyond) {
        end = beyond;
    } else if (acceleration_ > here) {
        end = here;
        to_standstill = velocity_ < 0 && crossing > here * here;
        if (to_standstill) end = std::sqrt(crossing);
    }
    if (end == acceleration_) return;
    add((acceleration_ - end) * fall, acceleration_, -l.down.jerk, end);
    if (to_standstill) velocity_ = 0;
}

/// Returns whether there was anything to give back.
bool Brake::give_velocity_back(const FrameLimits& l) noexcept {
    const double excess = sign_ * released_ - l.up.velocity;
    if (!(excess > 0)) return false;
    const double hardest = l.down.slowing_down;
    if (l.jerk_free()) {
        if (std::isinf(hardest)) {
            jump(-excess);
        } else {
            add(excess / hardest, -hardest, 0, 0);
            velocity_ = l.up.velocity;
        }
        return true;
    }
    // Deceleration b at the end: half of b^2 times both eases is what building it up and giving it back take off.
    const double ease = l.up.ease + l.down.ease;
    const double a = acceleration_;
    const double square = (a < 0 ? a * a : 0) + 2 * excess / ease;
    if (square <= hardest * hardest) {
        const double end = -std::sqrt(square);
        const double build = a < 0 ? 2 * excess / ease / (-end - a) : a - end;
        add(build * l.down.ease, a, -l.down.jerk, end);
    } else {
        add((a + hardest) * l.down.ease, a, -l.down.jerk, -hardest);
        add((square - hardest * hardest) * ease / (2 * hardest), -hardest, 0, -hardest);
    }
    beyond_ = fastest_ / l.up.velocity;
    sense_ = sign_;
    return true;
}

void Brake::go_to_limit(const FrameLimits& limits) noexcept {
    sign_ = sense_;
    const FrameLimits l = sign_ > 0 ? limits : limits.mirrored();
    velocity_ *= sign_;
    acceleration_ *= sign_;
    add(-acceleration_ * l.up.ease, acceleration_, l.up.jerk, 0);
    velocity_ = sign_ * l.up.velocity;
    acceleration_ = 0;
}

void Brake::add(double duration, double acceleration, double jerk, double end_acceleration) noexcept {
    acceleration_ = end_acceleration;
    if (!(duration > 0)) return;
    fastest_ = std::max(fastest_, std::abs(velocity_));
    const double way = duration * (velocity_ + duration * (acceleration / 2 + duration * (jerk / 6)));
    velocity_ += duration * (acceleration + duration * (jerk / 2));
    travel_ += sign_ * way;
    path_ += std::abs(way);
    duration_ += duration;
    if (count_ > 0 && stretches_[static_cast<std::size_t>(count_ - 1)].jerk == sign_ * jerk && jerk != 0) {
        stretches_[static_cast<std::size_t>(count_ - 1)].duration += duration;  // the same jerk goes on
    } else {
        stretches_[static_cast<std::size_t>(count_++)] = {duration, sign_ * acceleration, sign_ * jerk, 0};
    }
}

void Brake::jump(double dv) noexcept {
    stretches_[static_cast<std::size_t>(count_++)] = {0, 0, 0, sign_ * dv};
    velocity_ += dv;
}

}  // namespace taktwerk::axes
