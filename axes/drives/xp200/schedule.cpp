// What is asked next.

#include "axes/drives/xp200/schedule.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace taktwerk::axes::xp200 {

using namespace std::chrono_literals;

namespace {

constexpr Duration closed_rest = 500ms;  // between two questions to a drive that does not answer: others use the line
constexpr Duration clear_again = 500ms;
constexpr Duration settings_period = 2s;        // somebody may turn parameters at the panel (3.4)
constexpr std::uint16_t echo_pattern = 0x1234;  // 9.6.5

/// Words of Pr122 that select the first and the second of the two internal values that take turns, and those values.
struct Slots {
    std::uint16_t first, second, select_first, select_second;
};
constexpr Slots speed_slots{pr::speed_1 + 1, pr::speed_1 + 2, force::speed_2, force::speed_3};
constexpr Slots torque_slots{pr::torque_1 + 1, pr::torque_1 + 2, force::torque_2, force::torque_3};

}  // namespace

Schedule::Schedule(const DriveConfig& config) : config_(config), settings_(config), index_(config.counts_per_turn) {}

modbus::Request Schedule::ask(Asked what, const modbus::Request& request) noexcept {
    asked_ = what;
    return request;
}

modbus::Request Schedule::write(std::uint16_t number, std::int64_t value) noexcept {
    settings_.doubt(number);
    return ask(Asked::write, modbus::write_parameter(config_.station, number, static_cast<std::uint16_t>(value)));
}

/// In torque control, and not braking.
bool Schedule::drives_torque() const noexcept { return settings_.knows(pr::force_4, force::mode); }

/// Torque ends here by EMG: torque 0 would let the motor run out, and a load fall.
bool Schedule::must_brake(const Wish& wish) const noexcept {
    return drives_torque() && sample_.running && (wish.halt || wish.power != PowerRequest::on || !wish.torque_mode);
}

/// An internal speed or torque may be selected.
bool Schedule::moves_by_itself() const noexcept { return !settings_.knows(pr::force_3, 0); }

bool Schedule::stands() const noexcept {
    const double standstill = static_cast<double>(std::max<std::int64_t>(settings_.known(pr::standstill_speed), 1));
    return std::abs(sample_.velocity) * 60 / static_cast<double>(config_.counts_per_turn) <= standstill;
}

bool Schedule::urgent(const Wish& wish) const noexcept {
    return phase_ == Phase::running && (((wish.halt || wish.power != PowerRequest::on) && moves_by_itself()) || must_brake(wish));
}

std::optional<modbus::Request> Schedule::next(const Wish& wish, Instant now) {
    if (phase_ != Phase::running) return open(now);
    follow_latch(wish, now);
    auto request = command(wish, now);
    if (!request && (sample_.released || !problems().empty())) obeyed_ = wish.sequence;
    if (request && (urgent(wish) || ++commands_in_a_row_ <= 2)) return request;
    commands_in_a_row_ = 0;
    if (services_.its_turn()) return ask(Asked::service, services_.begin());
    return poll(now);
}

// --- opening ------------------------------------------------------------------------------------------------------------------

std::optional<modbus::Request> Schedule::open(Instant now) {
    switch (phase_) {
        case Phase::closed:
            if (now - last_try_ < closed_rest && last_try_ != Instant{}) return std::nullopt;
            last_try_ = now;
            return ask(Asked::echo, modbus::diagnose(config_.station, echo_pattern));
        // Whatever ran before ends first: the last speed may still be selected, and the drive knows no silence.
        case Phase::stopping: return write(pr::force_3, 0);
        case Phase::disabling: return ask(Asked::servo, modbus::servo(config_.station, modbus::servo_off));
        case Phase::reading:
            if (const auto block = settings_.unread())
                return ask(Asked::parameters, modbus::read_parameters(config_.station, block->first, block->count));
            settings_.restart();
            phase_ = Phase::setting;
            [[fallthrough]];
        case Phase::setting:
            if (const auto setting = settings_.unwritten()) return write(setting->number, setting->value);
            settings_.judge();
            if (sample_.running) watch_release(now);  // read again for a reset: that changes nothing about it
            sample_.setup_refused = !problems().empty();
            phase_ = Phase::running;
            turn_ = 0;
            raw_.reset();
            index_.forget();
            selects_.reset();
            settings_read_ = now;
            ++sample_.epoch;
            return poll(now);
        case Phase::running: break;
    }
    return std::nullopt;
}

// --- commands -----------------------------------------------------------------------------------------------------------------

bool Schedule::may_enable(const Wish& wish) const noexcept {
    const bool seen_off = sample_.released && wish.session == sample_.session;
    return wish.power == PowerRequest::on && seen_off && sample_.alarm == 0 && problems().empty();
}

std::optional<modbus::Request> Schedule::command(const Wish& wish, Instant now) {
    const bool wanted = may_enable(wish);
    orders_.want(wanted, wish.power_turn);
    sample_.power_of = sample_.running ? orders_.power_of() : std::uint16_t{0};
    const bool on = wanted && !orders_.unclear();
    if (must_brake(wish) || (drives_torque() && sample_.running && !on)) return write(pr::force_4, force::mode + force::emergency);
    const bool moves = on && orders_.on() && !wish.halt && (wish.torque_mode ? wish.torque != 0 : wish.speed != 0);
    if (!moves) {
        selects_.reset();
        if (moves_by_itself()) return write(pr::force_3, 0);
    }
    if (!on && orders_.disable(now)) return ask(Asked::servo, modbus::servo(config_.station, modbus::servo_off));
    if (!wish.reset) read_again_ = true;
    if (wish.reset && sample_.alarm != 0 && now - clear_tried_ >= clear_again) {
        clear_tried_ = now;
        return ask(Asked::clear, modbus::clear_alarm(config_.station));
    }
    if (wish.reset && !problems().empty() && std::exchange(read_again_, false)) {
        phase_ = Phase::reading;  // perhaps somebody has put the settings right
        settings_.restart();
        return open(now);
    }
    const std::uint16_t mode = !wish.torque_mode ? 0 : wish.halt ? force::mode + force::emergency : force::mode;
    if (!on) return sample_.running || settings_.knows(pr::force_4, 0) ? std::nullopt : change_mode(0);
    if (!settings_.knows(pr::force_4, mode)) return change_mode(mode);
    if (!orders_.on()) {
        // At standstill only (5.5 SON), and not before it had its time.
        if (!stands() || !orders_.enable(wish.power_turn, now)) return std::nullopt;
        return ask(Asked::servo, modbus::servo(config_.station, modbus::servo_on));
    }
    if (selects_) return write(pr::force_3, *selects_);
    if (!wish.torque_mode && wish.up_ms > 0 && !settings_.knows(pr::acceleration_time, wish.up_ms))
        return write(pr::acceleration_time, wish.up_ms);
    if (!wish.torque_mode && wish.down_ms > 0 && !settings_.knows(pr::deceleration_time, wish.down_ms))
        return write(pr::deceleration_time, wish.down_ms);
    if (wish.torque_mode && wish.speed_limit > 0 && !settings_.knows(pr::torque_speed_limit, wish.speed_limit))
        return write(pr::torque_speed_limit, wish.speed_limit);
    if (!moves) return std::nullopt;
    return wish.torque_mode ? drive(Drives::torque, wish.torque) : drive(Drives::speed, wish.speed);
}

/// With nothing selected, so that neither the other mode nor the end of EMG begins with a motion (the selected one runs on then), and at
/// standstill: a change of CMODE in motion is not described.
std::optional<modbus::Request> Schedule::change_mode(std::uint16_t word) {
    selects_.reset();
    if (moves_by_itself()) return write(pr::force_3, 0);
    if (!stands() && settings_.has(pr::force_4)) return std::nullopt;
    return write(pr::force_4, word);
}

/// The value goes where none is selected, then that is selected: whether a selected one reacts to a write is not stated.
std::optional<modbus::Request> Schedule::drive(Drives what, std::int16_t value) {
    const auto& slots = what == Drives::speed ? speed_slots : torque_slots;
    const bool first = settings_.knows(pr::force_3, slots.select_first), second = settings_.knows(pr::force_3, slots.select_second);
    if ((first && settings_.knows(slots.first, value)) || (second && settings_.knows(slots.second, value))) return std::nullopt;
    const auto slot = first ? slots.second : slots.first;
    const auto select = first ? slots.select_second : slots.select_first;
    if (settings_.knows(slot, value)) return write(pr::force_3, select);
    selects_ = select;
    return write(slot, value);
}

// --- polling ------------------------------------------------------------------------------------------------------------------

modbus::Request Schedule::poll(Instant now) {
    if (now - settings_read_ >= settings_period) {
        settings_read_ = now;
        const auto block = settings_.watched();
        return ask(Asked::parameters, modbus::read_parameters(config_.station, block.first, block.count));
    }
    // Between two positions that are the same, so that all three are of one place.
    if (rests_ && index_.turned() && !index_.known() && !single_turn_)
        return ask(Asked::turn, modbus::read_status(config_.station, status::single_turn, 2));
    if (single_turn_) return ask(Asked::position, modbus::read_status(config_.station, status::position, 5));
    ++turn_;
    if (turn_ % 4 == 1 && !look_for_alarm_) return ask(Asked::terminals, modbus::read_status(config_.station, status::inputs, 2));
    if (turn_ % 4 == 3 || look_for_alarm_) return ask(Asked::alarm, modbus::read_status(config_.station, status::alarm, 1));
    return ask(Asked::position, modbus::read_status(config_.station, status::position, 5));  // position, deviation, torque
}

// --- services -----------------------------------------------------------------------------------------------------------------

bool Schedule::saved_would_be_harmless() const noexcept {
    for (std::uint16_t i = 0; i < 5; ++i)
        if (!settings_.knows(static_cast<std::uint16_t>(pr::force_1 + i), 0)) return false;
    return phase_ == Phase::running && !sample_.running && orders_.off() && settings_.known(pr::forced_enable) == 0;
}

}  // namespace taktwerk::axes::xp200
