#include "axes/homing/switch_homing.hpp"

namespace taktwerk::axes {

void SwitchHoming::start(const SwitchHomingSettings& settings, Instant now) noexcept {
    settings_ = settings;
    start_ = now;
    begun_ = reversed_ = stopping_ = false;
    velocity_ = 0;
    phase_ = Phase::search;
}

void SwitchHoming::Edge::see(bool on, std::int64_t at) noexcept {
    if (on) was_on = true;
    if (taken || !was_on || on) return;
    taken = true;
    place = at;
}

void SwitchHoming::take_edges(const SwitchHomingInput& in) noexcept {
    edges_[0].see(in.home_switch, in.position);
    if (settings_.two_sides) edges_[1].see(in.follower_switch, in.position + in.follower_ahead);
    else edges_[1] = edges_[0];
}

void SwitchHoming::begin(Phase phase) noexcept {
    phase_ = phase;
    stopping_ = false;
    const double sense = settings_.negative ? -1.0 : 1.0;
    switch (phase) {
        case Phase::search: velocity_ = sense * settings_.search_velocity; break;
        case Phase::back_off:
            velocity_ = -sense * settings_.latch_velocity;
            edges_ = {};
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
    const bool any_on = in.home_switch || (settings_.two_sides && in.follower_switch);
    const bool all_on = in.home_switch && (!settings_.two_sides || in.follower_switch);
    if (!begun_) {
        begun_ = true;
        begin(any_on ? Phase::leave : Phase::search);
        return;
    }
    const bool forward_limit = settings_.negative ? in.negative_limit : in.positive_limit;
    const bool backward_limit = settings_.negative ? in.positive_limit : in.negative_limit;
    switch (phase_) {
        case Phase::search:
            if (all_on) stop_then(Phase::back_off);
            else if (forward_limit) {
                if (reversed_) fail(Phase::failed);
                else {
                    reversed_ = true;
                    stop_then(Phase::pass_on);
                }
            }
            break;
        case Phase::back_off:
            take_edges(in);
            if (edges_[0].taken && edges_[1].taken) stop_then(Phase::finished);
            else if (backward_limit) fail(Phase::failed);
            break;
        case Phase::leave:
            if (!any_on) stop_then(Phase::search);
            else if (backward_limit) fail(Phase::failed);
            break;
        case Phase::pass_on:
            if (any_on) phase_ = Phase::pass_off;
            else if (backward_limit) fail(Phase::failed);
            break;
        case Phase::pass_off:
            if (!any_on) stop_then(Phase::search);
            else if (backward_limit) fail(Phase::failed);
            break;
        case Phase::idle:
        case Phase::finished:
        case Phase::failed:
        case Phase::timed_out: break;
    }
}

}  // namespace taktwerk::axes
