#include "axes/homing/switch_homing.hpp"

namespace taktwerk::axes {

void SwitchHoming::start(const SwitchHomingSettings& settings, Instant now) noexcept {
    settings_ = settings;
    start_ = now;
    begun_ = reversed_ = stopping_ = false;
    velocity_ = 0;
    phase_ = Phase::search;
}

void SwitchHoming::begin(Phase phase) noexcept {
    phase_ = phase;
    stopping_ = false;
    const double sense = settings_.negative ? -1.0 : 1.0;
    switch (phase) {
        case Phase::search: velocity_ = sense * settings_.search_velocity; break;
        case Phase::back_off:
            velocity_ = -sense * settings_.latch_velocity;
            was_on_ = false;
            break;
        case Phase::leave:
        case Phase::pass_on:
        case Phase::pass_off: velocity_ = -sense * settings_.search_velocity; break;
        case Phase::idle:
        case Phase::finished:
        case Phase::failed:
        case Phase::timed_out: velocity_ = 0; break;
    }
}

void SwitchHoming::step(const SwitchHomingInput& in) noexcept {
    if (!busy()) return;
    if (stopping_) {
        if (in.standing) begin(next_);
        return;
    }
    if (in.now - start_ >= settings_.timeout) {
        fail(Phase::timed_out);
        return;
    }
    if (!in.fresh) return;
    if (!begun_) {
        begun_ = true;
        begin(in.home_switch ? Phase::leave : Phase::search);
        return;
    }
    const bool forward_limit = settings_.negative ? in.negative_limit : in.positive_limit;
    const bool backward_limit = settings_.negative ? in.positive_limit : in.negative_limit;
    switch (phase_) {
        case Phase::search:
            if (in.home_switch) stop_then(Phase::back_off);
            else if (forward_limit) {
                if (reversed_) fail(Phase::failed);
                else {
                    reversed_ = true;
                    stop_then(Phase::pass_on);
                }
            }
            break;
        case Phase::back_off:
            if (in.home_switch) was_on_ = true;
            if (was_on_ && !in.home_switch) {
                reference_ = in.position;
                stop_then(Phase::finished);
            } else if (backward_limit) fail(Phase::failed);
            break;
        case Phase::leave:
            if (!in.home_switch) stop_then(Phase::search);
            else if (backward_limit) fail(Phase::failed);
            break;
        case Phase::pass_on:
            if (in.home_switch) phase_ = Phase::pass_off;
            else if (backward_limit) fail(Phase::failed);
            break;
        case Phase::pass_off:
            if (!in.home_switch) stop_then(Phase::search);
            else if (backward_limit) fail(Phase::failed);
            break;
        case Phase::idle:
        case Phase::finished:
        case Phase::failed:
        case Phase::timed_out: break;
    }
}

}  // namespace taktwerk::axes
