#include "axes/sim/profile_position.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes::sim {

void ProfilePosition::reset(double position) noexcept {
    forget(position);
    acknowledged_ = edge_ = false;
}

void ProfilePosition::forget(double position) noexcept {
    first_ = waiting_ = 0;
    running_ = clipped_ = false;
    now_ = {position, 0, 0};
    target_ = position;
    elapsed_ = 0;
    profile_.rest(position);
}

void ProfilePosition::exchange(bool new_setpoint, bool bit_five, const ProfileTarget& wanted) noexcept {
    const bool rises = new_setpoint && !edge_;
    edge_ = new_setpoint;
    const bool idle = !running_ && waiting_ == 0;
    if (rises && (waiting_ < room_ || idle || (bit_five && meaning_ == BitFive::replaces))) {
        acknowledged_ = true;
        const double asked = wanted.relative ? target_ + wanted.position : wanted.position;
        target_ = std::clamp(asked, wanted.lowest, wanted.highest);
        clipped_ = target_ != asked;
        const Setpoint setpoint{target_, wanted.limits, bit_five && meaning_ == BitFive::blends};
        if (idle || (bit_five && meaning_ == BitFive::replaces)) {
            waiting_ = 0;
            start(setpoint);
        } else {
            buffer_[(first_ + waiting_++) % most_waiting] = setpoint;
            if (setpoint.blends && waiting_ == 1) plan(now_);
        }
    }
    // Bit 12 falls with bit 4, but not before there is room again (CiA 402-2; SV33-E 3.4.3(5) case 2).
    if (!new_setpoint && (waiting_ < room_ || (!running_ && waiting_ == 0))) acknowledged_ = false;
}

void ProfilePosition::start(const Setpoint& setpoint) noexcept {
    active_ = setpoint;
    running_ = true;
    plan(now_);
}

void ProfilePosition::plan(const Demand& from) noexcept {
    elapsed_ = 0;
    double through = 0;
    if (waiting_ > 0 && buffer_[first_].blends) {  // straight on only: a set-point that turns round is reached first
        const bool onwards = (buffer_[first_].target - active_.target) * (active_.target - from.position) > 0;
        if (onwards) through = active_.limits.velocity;
    }
    profile_.go(from.position, from.velocity, active_.target, active_.limits, through);
}

Demand ProfilePosition::step(double dt) noexcept {
    if (!running_) return now_;
    elapsed_ += dt;
    now_ = profile_.at(elapsed_);
    if (elapsed_ < profile_.duration() || !active_.limits.usable()) return now_;
    const double over = elapsed_ - profile_.duration();
    running_ = false;
    if (waiting_ > 0 && next_may_start()) {
        start_next();
        elapsed_ = over;
        now_ = profile_.at(over);
    }
    return now_;
}

void ProfilePosition::start_next() noexcept {
    now_ = profile_.at(profile_.duration());
    const auto next = buffer_[first_];
    first_ = (first_ + 1) % most_waiting;
    --waiting_;
    start(next);
}

void ProfilePosition::reached_was_told() noexcept {
    if (!running_ && waiting_ > 0) start_next();
}

void ProfilePosition::resume(const Demand& from) noexcept {
    now_ = from;
    if (running_) plan(from);
}

}  // namespace taktwerk::axes::sim
