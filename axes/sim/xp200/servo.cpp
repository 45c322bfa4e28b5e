// Power, states, brake, alarms.

#include "axes/sim/xp200/servo.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes::sim::xp200 {

namespace pr = axes::xp200::pr;
using std::chrono::milliseconds;

namespace {

constexpr Duration inner_step = std::chrono::microseconds{250};

/// Power stage, encoder, memory: nothing is left to brake with. The manual does not say which alarms allow the ramp of Pr136 = 1.
bool leaves_nothing_to_brake_with(std::uint16_t alarm) noexcept {
    switch (alarm) {
        case 1:
        case 4:
        case 5:
        case 6:
        case 7:
        case 13:
        case 29: return false;
        default: return true;
    }
}

}  // namespace

Servo::Servo(const DriveProfile& profile, const PlantConfig& plant, const Options& options)
    : options_(options), alarms_(profile), parameters_(profile.parameters), plant_(plant) {}

void Servo::power_on(Instant now) noexcept {
    if (state_ != State::off) return;
    now_ = now;
    parameters_.restart();
    state_ = State::starting;
    ready_at_ = now + options_.start_up;
    encoder_.power_on(plant_.position());
    alarms_.power_on(saving_.was_torn());
    port_enable_ = clear_was_on_ = false;
    pulses_.forget_raw();
    load_.power_on();
}

void Servo::power_off() noexcept {
    saving_.power_off();
    state_ = State::off;
    switch_current(false);
    brake_.close();
    alarms_.power_off();
}

void Servo::advance(Instant now) noexcept {
    while (now_ + inner_step <= now) {
        now_ += inner_step;
        step();
    }
}

void Servo::step() noexcept {
    if (state_ != State::off) {
        if (saving_.ends(now_)) parameters_.save();
        inputs_.step(parameters_, now_);
        if (inputs_[Input::alarm_clear] && !clear_was_on_) clear_alarm();
        clear_was_on_ = inputs_[Input::alarm_clear];
        run_state();
    }
    take_pulses();
    torque_ = current_on_ ? drive_torque() : 0;
    run_brake();
    plant_.hold(options_.brake && !brake_.released());
    const double before = plant_.position();
    plant_.step(to_seconds(inner_step), torque_);
    encoder_.step(before, plant_.position(), plant_.config().index_pulse, counts_per_turn());
    if (state_ != State::off) watch();
}

double Servo::speed() const noexcept { return plant_.velocity() / counts_per_turn() * 60; }

// --- enabling (5.5 SON, 4.7, 5.7) ---------------------------------------------------------------------------------------------

void Servo::run_state() noexcept {
    // How SON, its forced digit, Pr098 and function 42h rank the manual does not say: any of them enables.
    const bool wanted = inputs_[Input::servo_on] || port_enable_ || p(pr::forced_enable) == 1;
    const bool stands = std::abs(speed()) < static_cast<double>(p(pr::standstill_speed));
    const bool coasts = inputs_[Input::emergency] && p(pr::emergency_mode) == 0;
    switch (state_) {
        case State::off: return;
        case State::starting:
            if (now_ >= ready_at_) state_ = alarms_.code() != 0 ? State::alarm : State::ready;
            return;
        case State::ready:
            if (!wanted) return;
            if (!stands) ++enabled_in_motion_;
            state_ = State::enabled;
            if (!coasts) switch_current(true);
            return;
        case State::enabled:
            if (!wanted) leave_enabled();
            else if (current_on_ == coasts) switch_current(!coasts);  // EMG released: it runs on by what is selected then (not stated)
            return;
        case State::stopping:
            if (holds_for_brake_) {
                if (now_ < stop_until_) return;
                switch_current(false);
                state_ = State::ready;
            } else if (stands) leave_enabled();
            return;
        case State::alarm:
            if (current_on_ && stands) switch_current(false);
            return;
    }
}

void Servo::leave_enabled() noexcept {
    holds_for_brake_ = std::abs(speed()) < static_cast<double>(p(pr::standstill_speed));
    state_ = State::stopping;
    if (holds_for_brake_) {
        brake_.close();
        stop_until_ = now_ + milliseconds{p(pr::brake_hold)};
    } else if (p(pr::stop_mode) == 0) {
        switch_current(false);
        state_ = State::ready;
    }
}

void Servo::switch_current(bool on) noexcept {
    if (on == current_on_) return;
    current_on_ = on;
    if (on) {
        brake_.current_on(now_);
        ramped_ = 0;
        clamped_ = false;
        pulses_.hold(plant_.position());
        loop_.reset();
    } else {
        torque_ = 0;
        brake_.current_off(now_ + milliseconds{p(pr::brake_wait)});
    }
}

/// 4.8: released Pr169 after current; while moving it falls after Pr167, or below Pr168.
void Servo::run_brake() noexcept {
    if (state_ == State::off) return;
    if (state_ == State::enabled && current_on_) brake_.run(now_, milliseconds{p(pr::brake_release)});
    else if (!current_on_) brake_.fall(now_, std::abs(speed()) >= static_cast<double>(p(pr::brake_speed)));
}

// --- alarms (6.1) -------------------------------------------------------------------------------------------------------------

void Servo::raise(std::uint16_t alarm) noexcept {
    if (state_ == State::off || !alarms_.take(alarm)) return;
    port_enable_ = false;
    if (state_ == State::starting) return;
    state_ = State::alarm;
    if (p(pr::stop_mode) == 0 || leaves_nothing_to_brake_with(alarm)) switch_current(false);
}

void Servo::clear_alarm() noexcept {
    if (!alarms_.clear()) return;
    if (state_ == State::alarm) {
        switch_current(false);
        state_ = State::ready;
    }
}

void Servo::break_encoder() noexcept {
    encoder_.fail(plant_.position());
    raise(9);
}

void Servo::watch() noexcept {
    load_.step(torque_ / plant_.config().rated_torque, to_seconds(inner_step), to_seconds(options_.heat), now_);
    const auto highest = static_cast<double>(p(pr::highest_speed));
    if (std::abs(speed()) > options_.overspeed * highest && state_ != State::starting) raise(1);
    if (!current_on_ || state_ == State::alarm) {
        load_.rest(now_);
        return;
    }
    if (limit_used(true) && limit_used(false) && !allowed(true) && !allowed(false)) raise(7);
    const double percent = 100 * torque_ / plant_.config().rated_torque;
    const bool over = percent > static_cast<double>(p(pr::overload_ccw)) || percent < static_cast<double>(p(pr::overload_cw));
    if (load_.overloaded(over, now_, milliseconds{p(pr::overload_time)})) raise(29);
    const double most = most_torque(torque_ > 0);
    const bool stalled = most > 0 && std::abs(torque_) > 0.99 * most && std::abs(speed()) < static_cast<double>(p(pr::standstill_speed));
    if (load_.stalled(stalled, now_, options_.stalled)) raise(6);
    if (load_.heat() > options_.overload * options_.overload) raise(13);
    const double deviation = pulses_.at() - plant_.position();
    if (mode() == Mode::position && std::abs(deviation) > 0.01 * static_cast<double>(p(pr::deviation_limit)) * counts_per_turn()) raise(4);
}

}  // namespace taktwerk::axes::sim::xp200
