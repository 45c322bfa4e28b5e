// Modes, set-points, ramps and torque (manual 4.2 to 4.4, 5.4).

#include <algorithm>
#include <cmath>

#include "axes/sim/xp200/servo.hpp"

namespace taktwerk::axes::sim::xp200 {

namespace pr = axes::xp200::pr;

namespace {

constexpr double step_seconds = 250e-6;

}  // namespace

Servo::Mode Servo::mode() const noexcept {
    const bool other = inputs_[Input::mode];
    switch (p(pr::control_mode)) {
        case 1: return Mode::speed;
        case 2: return Mode::torque;
        case 3: return other ? Mode::speed : Mode::position;
        case 4: return other ? Mode::torque : Mode::position;
        case 5: return other ? Mode::torque : Mode::speed;
        default: return Mode::position;
    }
}

/// Units digit of Pr097 (4.6): 0 both used, 1 CWL, 2 CCWL, 3 none.
bool Servo::limit_used(bool ccw) const noexcept {
    const auto use = p(pr::limit_use) % 10;
    return use == 0 || use == (ccw ? 2 : 1);
}
bool Servo::allowed(bool ccw) const noexcept { return inputs_[ccw ? Input::ccw_allowed : Input::cw_allowed]; }

/// r/min, before the ramp (4.3.3). No analog voltage is modelled: it is 0.
double Servo::wanted_speed() const noexcept {
    const int selected = (inputs_[Input::speed_1] ? 1 : 0) + (inputs_[Input::speed_2] ? 2 : 0) + (inputs_[Input::speed_3] ? 4 : 0);
    const auto source = p(pr::speed_source);
    const bool internal = source == 1 || (source == 2 && selected != 0);
    double wanted = internal ? static_cast<double>(p(static_cast<std::uint16_t>(pr::speed_1 + selected))) : 0;
    if (inputs_[Input::zero_command] || inputs_[Input::emergency]) wanted = 0;
    if (inputs_[Input::invert]) wanted = -wanted;
    const auto highest = static_cast<double>(p(pr::highest_speed));
    return std::clamp(wanted, -highest, highest);
}

/// Fraction of rated torque (4.4.3).
double Servo::wanted_torque() const noexcept {
    const int selected = (inputs_[Input::torque_1] ? 1 : 0) + (inputs_[Input::torque_2] ? 2 : 0);
    const auto source = p(pr::torque_source);
    const bool internal = source == 1 || (source == 2 && selected != 0);
    double wanted = internal ? static_cast<double>(p(static_cast<std::uint16_t>(pr::torque_1 + selected))) / 100 : 0;
    if (inputs_[Input::zero_command] || inputs_[Input::emergency]) wanted = 0;
    return inputs_[Input::invert] ? -wanted : wanted;
}

/// N m: the least of what the motor can, Pr065/066, and Pr067/068 while TCCW/TCW is on (5.6); none against a limit switch (4.6).
double Servo::most_torque(bool ccw) const noexcept {
    if (limit_used(ccw) && !allowed(ccw)) return 0;
    double share =
        std::min(plant_.config().maximum_torque, std::abs(static_cast<double>(p(ccw ? pr::torque_limit_ccw : pr::torque_limit_cw))) / 100);
    if (inputs_[ccw ? Input::ccw_torque_limit : Input::cw_torque_limit])
        share = std::min(share, std::abs(static_cast<double>(p(ccw ? pr::external_limit_ccw : pr::external_limit_cw))) / 100);
    return share * plant_.config().rated_torque;
}

/// Linear, in ms for 1000 r/min (4.3.4); through zero with the braking time first, then the other (not stated).
void Servo::ramp(double target, double up_ms, double down_ms) noexcept {
    const auto most = [](double ms) { return ms > 0 ? 1e6 / ms * step_seconds : 1e9; };
    const bool brakes = ramped_ * target < 0 || std::abs(target) < std::abs(ramped_);
    const double goal = ramped_ * target < 0 ? 0 : target;
    const double change = most(brakes ? down_ms : up_ms);
    ramped_ += std::clamp(goal - ramped_, -change, change);
}

/// Pr078, Pr079 (5.4.1): beyond the limit speed is fed back and takes torque away, the more the smaller Pr079; "the real speed is slightly above
/// the limit". How much the manual does not say: here the highest torque there is (300 %, Pr065) makes an excess of Pr079, its "speed limit
/// error"; also beyond zero, so that a pulling load is held as well.
double Servo::limited_by_speed(double torque) const noexcept {
    const double excess = std::abs(speed()) - static_cast<double>(p(pr::torque_speed_limit));
    if (excess <= 0) return torque;
    return torque - std::copysign(3 * excess / static_cast<double>(std::max<std::int64_t>(p(pr::torque_speed_slope), 1)), speed());
}

double Servo::drive_torque() noexcept {
    const double ccw = most_torque(true), cw = most_torque(false);
    const double most = std::max(ccw, cw);
    const auto up = static_cast<double>(p(pr::acceleration_time)), down = static_cast<double>(p(pr::deceleration_time));
    const auto stop = static_cast<double>(p(pr::stop_time));
    const bool stopping = state_ == State::stopping || state_ == State::alarm || inputs_[Input::emergency];
    const double per_speed = counts_per_turn() / 60;  // counts/s for 1 r/min
    double torque = 0;
    if (stopping) {
        if (mode() != Mode::speed) ramped_ = std::abs(ramped_) > std::abs(speed()) || ramped_ == 0 ? speed() : ramped_;
        ramp(0, stop, stop);
        clamped_ = false;
        torque = loop_.velocity_control(plant_, ramped_ * per_speed, 0, most, step_seconds);
    } else if (mode() == Mode::torque) {
        clamped_ = false;
        torque = std::clamp(limited_by_speed(wanted_torque()) * plant_.config().rated_torque, -most, most);
        loop_.take_over(torque);
        ramped_ = speed();  // a change to speed mode begins with the speed it has
    } else if (mode() == Mode::position) {
        torque = position_torque();
    } else {
        const double wanted = wanted_speed();
        const auto zero = static_cast<double>(p(pr::zero_speed));
        const bool clamp = inputs_[Input::zero_clamp] && std::abs(wanted) < zero && std::abs(ramped_) < zero;
        if (clamp && p(pr::zero_clamp) == 0) {
            if (!clamped_) clamp_at_ = plant_.position();
            ramped_ = 0;
            torque = loop_.position_control(plant_, {clamp_at_, 0, 0}, plant_.position(), most, step_seconds);
        } else {
            ramp(clamp ? 0 : wanted, up, down);
            torque = loop_.velocity_control(plant_, ramped_ * per_speed, 0, most, step_seconds);
        }
        clamped_ = clamp;
    }
    const double given = std::clamp(torque, -cw, ccw);
    if (given != torque) loop_.take_over(given);
    return given;
}

double Servo::position_torque() noexcept {
    const auto highest = static_cast<double>(p(pr::highest_speed)) * counts_per_turn() / 60;
    const double wanted = std::clamp(static_cast<double>(p(pr::position_gain)) * (pulses_.at() - plant_.position()), -highest, highest);
    return loop_.velocity_control(plant_, wanted, 0, plant_.config().rated_torque * plant_.config().maximum_torque, step_seconds);
}

/// The gear that the inputs choose (4.2.3).
void Servo::take_pulses() noexcept {
    if (!pulses_.waits() && !inputs_[Input::clear_deviation]) return;
    if (inputs_[Input::clear_deviation]) pulses_.hold(plant_.position());
    if (current_on_ && mode() == Mode::position && !inputs_[Input::inhibit_pulses]) {
        const bool first = inputs_[Input::gear_1], second = inputs_[Input::gear_2];
        const auto by = p(34) % 10;
        const int numerator = by == 1 ? (first ? 2 : 0) : by == 2 && (first || second) ? 1 + (first ? 1 : 0) + (second ? 2 : 0) : 0;
        const auto n = p(numerator == 0 ? pr::gear_numerator : static_cast<std::uint16_t>(29 + numerator));
        pulses_.take(n, p(pr::gear_denominator));
    }
    pulses_.drop();
}

// --- what it shows ------------------------------------------------------------------------------------------------------------

bool Servo::on(Output function) const noexcept {
    const double deviation = std::abs(pulses_.at() - plant_.position());
    const bool positions = mode() == Mode::position && current_on_;
    switch (function) {
        case Output::off: return false;
        case Output::on: return true;
        case Output::ready: return alarms_.code() == 0 && state_ != State::off && state_ != State::starting;
        case Output::no_alarm: return alarms_.code() == 0 && state_ != State::off;
        case Output::zero_speed: return std::abs(speed()) < static_cast<double>(p(pr::zero_speed));
        case Output::in_position: return positions && deviation <= static_cast<double>(p(pr::in_position));
        case Output::at_speed: return std::abs(speed()) > std::abs(static_cast<double>(p(pr::reached_speed)));
        case Output::at_torque:
            return 100 * std::abs(torque_) / plant_.config().rated_torque > std::abs(static_cast<double>(p(pr::reached_torque)));
        case Output::brake_released: return brake_.released();
        case Output::running: return current_on_;
        case Output::near_position: return positions && deviation <= static_cast<double>(p(pr::near_range));
        case Output::torque_limited: return current_on_ && std::abs(torque_) >= 0.99 * most_torque(torque_ > 0);
        case Output::speed_limited:
            return current_on_ && mode() == Mode::torque && std::abs(speed()) >= static_cast<double>(p(pr::torque_speed_limit));
    }
    return false;
}

bool Servo::output(int terminal) const noexcept {
    const auto function = p(static_cast<std::uint16_t>(pr::output_function + terminal));
    return state_ != State::off && on(static_cast<Output>(std::abs(function))) == (function >= 0);
}

std::uint16_t Servo::status(std::uint16_t index) const noexcept {
    namespace s = axes::xp200::status;
    const auto word = [](double value) { return static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(value))); };
    const auto half = [&](std::int64_t value, std::uint16_t first) {
        const auto bits = static_cast<std::uint32_t>(value);
        return static_cast<std::uint16_t>(index == first ? bits & 0xFFFFu : bits >> 16);
    };
    const auto percent = [&](double torque) { return word(100 * torque / plant_.config().rated_torque); };
    const auto turn = static_cast<std::int64_t>(counts_per_turn());
    const auto since_zero = encoder_.since_index(plant_.position(), plant_.config().index_pulse);  // 3.3 note 6
    const auto in_turn = ((since_zero % turn) + turn) % turn;
    const auto rated_current = static_cast<double>(p(204));  // 0.1 A
    switch (index) {
        case s::speed: return word(speed());
        case s::raw_command:
        case s::raw_command + 1: return half(pulses_.raw(), s::raw_command);
        case s::command:
        case s::command + 1: return half(static_cast<std::int64_t>(pulses_.at() - encoder_.zero()), s::command);
        case s::position:
        case s::position + 1: return half(position(), s::position);
        case s::deviation:
        case s::deviation + 1:
            return half(mode() == Mode::position ? static_cast<std::int64_t>(pulses_.at() - plant_.position()) : 0, s::deviation);
        case s::torque: return percent(torque_);
        case s::peak_torque: return word(100 * load_.peak());
        case s::current: return word(rated_current * std::abs(torque_) / plant_.config().rated_torque);
        case s::peak_current: return word(rated_current * load_.peak());
        case s::speed_command: return word(mode() == Mode::speed ? wanted_speed() : 0);
        case s::torque_command: return word(mode() == Mode::torque ? 100 * wanted_torque() : 0);
        case s::inputs: {
            unsigned bits = 0;
            for (int i = 0; i < axes::xp200::input_count; ++i)
                if (inputs_.conducting(i) == (options_.inputs == ConductingReads::one)) bits |= 1u << i;
            return static_cast<std::uint16_t>(bits);
        }
        case s::outputs: {
            unsigned bits = 0;
            for (int i = 0; i < axes::xp200::output_count; ++i)
                if (output(i) == (options_.outputs == ConductingReads::one)) bits |= 1u << i;
            return static_cast<std::uint16_t>(bits);
        }
        case s::single_turn:
        case s::single_turn + 1: return half(in_turn, s::single_turn);
        case s::average_load: return word(100 * std::sqrt(load_.heat()));
        case s::alarm: return alarms_.code();
        case s::fine_speed: return word(std::clamp(10 * speed(), -32768.0, 32767.0));
        case s::absolute:
        case s::absolute + 1: return half(position(), s::absolute);
        default: return 0;  // reserved, or not there with an incremental encoder
    }
}

}  // namespace taktwerk::axes::sim::xp200
