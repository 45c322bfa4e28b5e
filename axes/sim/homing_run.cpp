#include "axes/sim/homing_run.hpp"

#include <algorithm>

namespace taktwerk::axes::sim {

namespace {

constexpr double block_torque = 0.95, block_time = 0.05;  // of the torque limit; s

}  // namespace

bool HomingRun::level(const SwitchStates& switches) const noexcept {
    switch (method_.sees) {
        case Switch::negative_limit: return switches.negative_limit;
        case Switch::positive_limit: return switches.positive_limit;
        case Switch::home: return switches.home;
        case Switch::none: break;
    }
    return false;
}

/// The switch at the end of this move's way is active.
bool HomingRun::at_limit(Switch limit, const SwitchStates& switches) const noexcept {
    if (limit == Switch::positive_limit) return move_.way == Way::forward && switches.positive_limit;
    return limit == Switch::negative_limit && move_.way == Way::reverse && switches.negative_limit;
}

void HomingRun::start(const HomingSettings& settings, const HomingMethod& method, const HomingView& view) noexcept {
    settings_ = settings;
    method_ = method;
    failure_ = Failure::none;
    next_ = 0;
    turned_ = false;
    elapsed_ = pressed_ = 0;
    before_ = reference_ = view.position;
    level_ = level(view.switches);
    if (method.number == 0) return fail(Failure::method);
    if (method.number == homing::here) {
        state_ = State::stopping;
        return;
    }
    if (!(settings.fast > 0) || !(settings.slow > 0) || !(settings.acceleration > 0)) return fail(Failure::speed);
    move_ = level_ ? method_.retreat : method_.approach;
    if (move_.until == Until::nothing) next();
    state_ = State::moving;
}

void HomingRun::abort() noexcept {
    if (busy()) state_ = State::breaking_off;
    else if (state_ != State::breaking_off) cancel();
}

void HomingRun::cancel() noexcept {
    state_ = State::idle;
    velocity_ = 0;
}

void HomingRun::fail(Failure failure) noexcept {
    failure_ = failure;
    state_ = State::failed;
}

void HomingRun::next() noexcept {
    move_ = next_ < method_.moves.size() ? method_.moves[next_++] : HomingMove{};
    pressed_ = 0;
}

void HomingRun::ramp(double target, double dt) noexcept {
    const double most = settings_.acceleration * dt;
    velocity_ += std::clamp(target - velocity_, -most, most);
}

/// The present move has found what it looks for; `reference_` is where.
bool HomingRun::over(double dt, const HomingView& view) noexcept {
    const bool now = level(view.switches);
    const bool rising = now && !level_, falling = !now && level_;
    level_ = now;
    reference_ = view.position;
    switch (move_.until) {
        case Until::switched_on: return rising;
        case Until::switched_off: return falling;
        case Until::index: {
            // While the motor still turns round it passes pulses the wrong way: they do not count.
            const bool on_the_way = move_.way == Way::forward ? view.position > before_ : view.position < before_;
            const auto pulse = view.pulses.between(before_, view.position);
            if (!on_the_way || !pulse) return false;
            reference_ = *pulse;
            return true;
        }
        case Until::block:
            pressed_ = view.torque >= block_torque && view.stands ? pressed_ + dt : 0;
            if (pressed_ < block_time) return false;
            velocity_ = 0;
            return true;
        case Until::nothing: break;
    }
    return true;
}

void HomingRun::step(double dt, const HomingView& view) noexcept {
    switch (state_) {
        case State::idle:
        case State::attained: return;
        case State::stopping:
            ramp(0, dt);
            if (velocity_ == 0) state_ = State::attained;
            return;
        case State::breaking_off:
            ramp(0, dt);
            if (velocity_ == 0) state_ = State::idle;
            return;
        case State::failed: ramp(0, dt); return;
        case State::moving: break;
    }
    elapsed_ += dt;
    const bool found = over(dt, view);
    before_ = view.position;
    if (found) {
        next();
        if (move_.until == Until::nothing) {
            state_ = State::stopping;
            return ramp(0, dt);
        }
    } else if (!turned_ && next_ == 0 && at_limit(method_.turns_at, view.switches)) {
        turned_ = true;
        move_.way = move_.way == Way::forward ? Way::reverse : Way::forward;
    } else if ((method_.sees != Switch::negative_limit && at_limit(Switch::negative_limit, view.switches)) ||
               (method_.sees != Switch::positive_limit && at_limit(Switch::positive_limit, view.switches))) {
        fail(Failure::limit);
        return ramp(0, dt);
    }
    if (settings_.time_limit > 0 && elapsed_ > settings_.time_limit) {
        fail(Failure::time);
        return ramp(0, dt);
    }
    const double pace = move_.pace == Pace::fast ? settings_.fast : settings_.slow;
    ramp(move_.way == Way::forward ? pace : -pace, dt);
}

}  // namespace taktwerk::axes::sim
