#include "axes/sim/homing_run.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes::sim {

bool HomingRun::level(const SwitchStates& switches) const noexcept {
    switch (method_->uses) {
        case Switch::negative_limit: return switches.negative_limit;
        case Switch::positive_limit: return switches.positive_limit;
        case Switch::home: break;
    }
    return switches.home;
}

void HomingRun::start(const HomingSettings& settings, const SwitchStates& switches) noexcept {
    settings_ = settings;
    method_ = find_homing_method(settings.method);
    velocity_ = acceleration_ = 0;
    move_ = 0;
    if (!method_ || !(settings.fast > 0) || !(settings.slow > 0) || !(settings.acceleration > 0)) {
        state_ = State::failed;
        return;
    }
    from_active_ = level_ = level(switches);
    state_ = State::moving;
}

void HomingRun::ramp(double target, double dt) noexcept {
    const double most = settings_.acceleration * dt;
    const double change = std::clamp(target - velocity_, -most, most);
    velocity_ += change;
    acceleration_ = change / dt;
}

void HomingRun::step(double dt, const SwitchStates& switches, double position) noexcept {
    if (state_ == State::stopping) {
        ramp(0, dt);
        if (velocity_ == 0) state_ = State::attained;
        return;
    }
    if (state_ == State::failed) {
        ramp(0, dt);
        return;
    }
    if (state_ != State::moving) return;

    const auto& moves = from_active_ ? method_->active : method_->inactive;
    const auto count = from_active_ ? method_->active_count : method_->inactive_count;
    const auto& move = moves[move_];
    const bool now = level(switches);
    const bool edge = move.until == Edge::rising ? (now && !level_) : (!now && level_);
    level_ = now;
    if (edge) {
        if (++move_ == count) {
            reference_ = position;
            state_ = State::stopping;
            ramp(0, dt);
            return;
        }
    } else if (method_->uses == Switch::home &&
               ((velocity_ > 0 && switches.positive_limit) || (velocity_ < 0 && switches.negative_limit))) {
        // Neither manual says what methods 19..22 do at a limit; running on into the stop would be the worst answer.
        state_ = State::failed;
        ramp(0, dt);
        return;
    }
    const auto& next = moves[move_];
    ramp((next.forward ? 1.0 : -1.0) * (next.fast ? settings_.fast : settings_.slow), dt);
}

}  // namespace taktwerk::axes::sim
