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
    : options_(options), parameters_(profile.parameters), plant_(plant) {
    for (const auto& alarm : profile.alarms) clearable_.emplace_back(alarm.code, alarm.resettable);
}

void Servo::power_on(Instant now) noexcept {
    if (state_ != State::off) return;
    now_ = now;
    parameters_.restart();
    state_ = State::starting;
    ready_at_ = now + options_.start_up;
    zero_ = plant_.position();  // incremental: it counts from where it wakes up (1.3, not stated)
    alarm_ = torn_save_ ? 20 : cause_;
    torn_save_ = encoder_broken_ = index_seen_ = port_enable_ = clear_was_on_ = false;
    raw_command_ = 0;
    heat_ = peak_ = 0;
}

void Servo::power_off() noexcept {
    torn_save_ = save_pending_;
    save_pending_ = false;
    saving_until_ = {};
    state_ = State::off;
    switch_current(false);
    brake_released_ = false;
    alarm_ = 0;
}

void Servo::advance(Instant now) noexcept {
    while (now_ + inner_step <= now) {
        now_ += inner_step;
        step();
    }
}

void Servo::step() noexcept {
    if (state_ != State::off) {
        if (save_pending_ && now_ >= saving_until_) {
            save_pending_ = false;
            parameters_.save();
        }
        inputs_.step(parameters_, now_);
        if (inputs_[Input::alarm_clear] && !clear_was_on_) clear_alarm();
        clear_was_on_ = inputs_[Input::alarm_clear];
        run_state();
    }
    take_pulses();
    torque_ = current_on_ ? drive_torque() : 0;
    run_brake();
    plant_.hold(options_.brake && !brake_released_);
    const double before = plant_.position();
    plant_.step(to_seconds(inner_step), torque_);
    const auto turns = [&](double at) { return std::floor((at - plant_.config().index_pulse) / counts_per_turn()); };
    index_seen_ = index_seen_ || turns(before) != turns(plant_.position());
    if (state_ != State::off) watch();
}

double Servo::speed() const noexcept { return plant_.velocity() / counts_per_turn() * 60; }

std::int64_t Servo::position() const noexcept {
    return encoder_broken_ ? frozen_ : static_cast<std::int64_t>(std::floor(plant_.position() - zero_));
}

// --- enabling (5.5 SON, 4.7, 5.7) ---------------------------------------------------------------------------------------------

void Servo::run_state() noexcept {
    // How SON, its forced digit, Pr098 and function 42h rank the manual does not say: any of them enables.
    const bool wanted = inputs_[Input::servo_on] || port_enable_ || p(pr::forced_enable) == 1;
    const bool stands = std::abs(speed()) < static_cast<double>(p(pr::standstill_speed));
    const bool coasts = inputs_[Input::emergency] && p(pr::emergency_mode) == 0;
    switch (state_) {
        case State::off: return;
        case State::starting:
            if (now_ >= ready_at_) state_ = alarm_ != 0 ? State::alarm : State::ready;
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
        brake_released_ = false;
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
        enabled_at_ = now_;
        ramped_ = 0;
        clamped_ = false;
        command_ = plant_.position();
        loop_.reset();
    } else {
        torque_ = 0;
        brake_drop_at_ = now_ + milliseconds{p(pr::brake_wait)};
    }
}

/// 4.8: released Pr169 after current; while moving it falls after Pr167, or below Pr168.
void Servo::run_brake() noexcept {
    if (state_ == State::off) return;
    if (state_ == State::enabled && current_on_) {
        if (now_ - enabled_at_ >= milliseconds{p(pr::brake_release)}) brake_released_ = true;
    } else if (brake_released_ && !current_on_) {
        brake_released_ = now_ < brake_drop_at_ && std::abs(speed()) >= static_cast<double>(p(pr::brake_speed));
    }
}

// --- alarms (6.1) -------------------------------------------------------------------------------------------------------------

void Servo::raise(std::uint16_t alarm) noexcept {
    if (state_ == State::off || alarm_ != 0) return;
    alarm_ = alarm;
    port_enable_ = false;
    if (state_ == State::starting) return;
    state_ = State::alarm;
    if (p(pr::stop_mode) == 0 || leaves_nothing_to_brake_with(alarm)) switch_current(false);
}

void Servo::clear_alarm() noexcept {
    if (alarm_ == cause_) return;
    for (const auto& [code, clearable] : clearable_)
        if (code == alarm_ && !clearable) return;
    alarm_ = 0;
    if (state_ == State::alarm) {
        switch_current(false);
        state_ = State::ready;
    }
}

void Servo::break_encoder() noexcept {
    frozen_ = position();
    encoder_broken_ = true;
    raise(9);
}

void Servo::begin_saving() noexcept {
    save_pending_ = true;
    saving_until_ = now_ + options_.saving;
}

void Servo::watch() noexcept {
    watch_peaks();
    const auto highest = static_cast<double>(p(pr::highest_speed));
    if (std::abs(speed()) > options_.overspeed * highest && state_ != State::starting) raise(1);
    if (!current_on_ || state_ == State::alarm) {
        overload_since_ = stalled_since_ = now_;
        return;
    }
    if (limit_used(true) && limit_used(false) && !allowed(true) && !allowed(false)) raise(7);
    const double percent = 100 * torque_ / plant_.config().rated_torque;
    const bool over = percent > static_cast<double>(p(pr::overload_ccw)) || percent < static_cast<double>(p(pr::overload_cw));
    if (!over) overload_since_ = now_;
    else if (now_ - overload_since_ > milliseconds{p(pr::overload_time)}) raise(29);
    const double most = most_torque(torque_ > 0);
    const bool stalled = most > 0 && std::abs(torque_) > 0.99 * most && std::abs(speed()) < static_cast<double>(p(pr::standstill_speed));
    if (!stalled) stalled_since_ = now_;
    else if (now_ - stalled_since_ > options_.stalled) raise(6);
    if (heat_ > options_.overload * options_.overload) raise(13);
    const double deviation = command_ - plant_.position();
    if (mode() == Mode::position && std::abs(deviation) > 0.01 * static_cast<double>(p(pr::deviation_limit)) * counts_per_turn()) raise(4);
}

void Servo::watch_peaks() noexcept {
    const double share = torque_ / plant_.config().rated_torque;
    heat_ += (share * share - heat_) * to_seconds(inner_step) / to_seconds(options_.heat);
    if (std::abs(share) >= peak_ || now_ - peak_at_ > std::chrono::seconds{1}) {
        peak_ = std::abs(share);
        peak_at_ = now_;
    }
}

}  // namespace taktwerk::axes::sim::xp200
