#include "axes/drives/xp200/schedule.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace taktwerk::axes::xp200 {

using namespace std::chrono_literals;
using modbus::Outcome;
using std::chrono::milliseconds;

namespace {

constexpr Duration closed_rest = 500ms;  // between two questions to a drive that does not answer: others use the line
constexpr Duration enable_again = 1s;    // RUN needs its time (Pr169, Pr166): not more often
constexpr Duration clear_again = 500ms;
constexpr Duration settings_period = 2s;        // somebody may turn parameters at the panel (3.4)
constexpr std::uint16_t echo_pattern = 0x1234;  // 9.6.5
constexpr std::size_t service_room = 64;

/// Words of Pr122 that select the first and the second of the two internal values that take turns, and those values.
struct Slots {
    std::uint16_t first, second, select_first, select_second;
};
constexpr Slots speed_slots{pr::speed_1 + 1, pr::speed_1 + 2, force::speed_2, force::speed_3};
constexpr Slots torque_slots{pr::torque_1 + 1, pr::torque_1 + 2, force::torque_2, force::torque_3};

}  // namespace

Schedule::Schedule(const DriveConfig& config) : config_(config), settings_(config) {}

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
    auto request = command(wish, now);
    if (!request && (sample_.released || !problems().empty())) sample_.acknowledged = wish.sequence;
    if (request && (urgent(wish) || ++commands_in_a_row_ <= 2)) return request;
    commands_in_a_row_ = 0;
    if (!services_.empty() && ++turn_ % 4 == 0) {
        const auto service = services_.front();
        services_.pop_front();
        serving_ = service.ticket;
        return ask(Asked::service, service.request);
    }
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
            enable_sent_ = false;
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
    const bool on = may_enable(wish);
    if (must_brake(wish) || (drives_torque() && sample_.running && !on)) return write(pr::force_4, force::mode + force::emergency);
    const bool moves = on && sample_.running && !wish.halt && (wish.torque_mode ? wish.torque != 0 : wish.speed != 0);
    if (!moves) {
        selects_.reset();
        if (moves_by_itself()) return write(pr::force_3, 0);
    }
    if (!on && (sample_.running || enable_sent_) && now - disable_tried_ >= enable_again) {
        disable_tried_ = now;
        enable_sent_ = false;
        return ask(Asked::servo, modbus::servo(config_.station, modbus::servo_off));
    }
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
    if (!sample_.running) {
        // At standstill only (5.5 SON), and not before it had its time.
        if (!stands() || now - enable_tried_ < enable_again) return std::nullopt;
        enable_tried_ = now;
        enable_sent_ = true;
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
    ++turn_;
    if (turn_ % 4 == 1 && !look_for_alarm_) return ask(Asked::terminals, modbus::read_status(config_.station, status::inputs, 2));
    if (turn_ % 4 == 3 || look_for_alarm_) return ask(Asked::alarm, modbus::read_status(config_.station, status::alarm, 1));
    return ask(Asked::position, modbus::read_status(config_.station, status::position, 5));  // position, deviation, torque
}

void Schedule::take(const modbus::Answer& answer, Instant now) {
    const auto asked = std::exchange(asked_, Asked::nothing);
    if (asked == Asked::service) {
        served_ = {serving_, answer};
        serving_ = 0;
    }
    if (answer.outcome != Outcome::answered && answer.outcome != Outcome::exception) {
        if (phase_ != Phase::closed && now - sample_.heard >= config_.silence) lost(now);
        return;
    }
    sample_.heard = now;
    sample_.saving = asked == Asked::service && answer.request.function == modbus::Function::save && answer.outcome == Outcome::answered;
    if (answer.outcome == Outcome::exception) {
        // A parameter that the drive does not take: said once, never asked for again in this session.
        if (phase_ == Phase::setting || phase_ == Phase::reading) settings_.done();
        return;
    }
    switch (asked) {
        case Asked::echo:
            phase_ = Phase::stopping;
            ++sample_.session;
            sample_.released = false;
            break;
        case Asked::parameters:
            settings_.learn(answer.request.address, answer.response.values());
            if (phase_ == Phase::reading) settings_.done();
            else watch_settings();
            break;
        case Asked::write:
            settings_.learn(answer.request.address, std::span{answer.request.words}.first(1));
            if (phase_ == Phase::stopping) phase_ = Phase::disabling;
            if (selects_ && answer.request.address == pr::force_3) selects_.reset();
            break;
        case Asked::servo:
            if (phase_ == Phase::disabling) {
                disabled_at_ = now;
                phase_ = Phase::reading;
                settings_.restart();
            }
            break;
        case Asked::position: take_position(answer, now); break;
        case Asked::terminals: take_terminals(answer.response.words[0], answer.response.words[1], now); break;
        case Asked::alarm:
            // 255 and 65535: "none" in some tables; the register's coding is not stated (9.5).
            if (std::exchange(look_for_alarm_, false)) sample_.running = false;
            sample_.alarm = answer.response.words[0] == 0xFF || answer.response.words[0] == 0xFFFF ? 0 : answer.response.words[0];
            break;
        case Asked::clear:
        case Asked::service:
        case Asked::nothing: break;
    }
}

/// What somebody may have turned at the panel has been read.
void Schedule::watch_settings() {
    settings_.compare();
    sample_.setup_refused = !problems().empty();
}

void Schedule::take_position(const modbus::Answer& answer, Instant) {
    const auto& words = answer.response.words;
    const auto raw = static_cast<std::uint32_t>(words[0]) | (static_cast<std::uint32_t>(words[1]) << 16);  // low word first (9.5)
    if (!raw_) {
        raw_ = raw;
        sample_.position = static_cast<std::int32_t>(raw);
        sample_.velocity = 0;
    } else {
        const auto way = static_cast<std::int64_t>(static_cast<std::int32_t>(raw - *raw_));
        const double time = to_seconds(answer.sampled - sample_.sampled);
        const double fastest = 1.5 * static_cast<double>(std::max<std::int64_t>(settings_.known(pr::highest_speed), 100)) / 60 *
                               static_cast<double>(config_.counts_per_turn);
        // Whether both halves are taken at once is not stated: what nobody can have moved is read again first.
        const bool leaps = std::abs(static_cast<double>(way)) > fastest * time + 1000;
        if (leaps && !doubtful_) {
            doubtful_ = true;
            return;
        }
        if (leaps) ++sample_.epoch;
        raw_ = raw;
        sample_.position += way;
        if (time > 0 && !leaps) sample_.velocity = static_cast<double>(way) / time;
    }
    doubtful_ = false;
    sample_.sampled = answer.sampled;
    sample_.torque = static_cast<double>(static_cast<std::int16_t>(words[4])) / 100;
    sample_.torque_mode = drives_torque() || settings_.knows(pr::force_4, force::mode + force::emergency);
    sample_.online = turn_ > 3;  // terminals and alarm have been read once
    ++sample_.number;
}

void Schedule::take_terminals(std::uint16_t inputs, std::uint16_t outputs, Instant now) {
    const auto conducting = [](std::uint16_t bits, ConductingReads reads) {
        return static_cast<std::uint16_t>((reads == ConductingReads::one ? bits : ~bits) & 0x3Fu);
    };
    sample_.inputs = conducting(inputs, config_.inputs);
    sample_.outputs = conducting(outputs, config_.outputs);
    const auto function = [&](std::uint16_t first, int terminal) { return settings_.known(static_cast<std::uint16_t>(first + terminal)); };
    const auto on = [&](std::uint16_t first, int terminal, std::uint16_t bits) {
        return ((bits >> terminal) & 1u) == (function(first, terminal) >= 0 ? 1u : 0u);
    };
    for (int i = 0; i < output_count; ++i)
        if (std::abs(function(pr::output_function, i)) == static_cast<int>(Output::running))
            take_running(on(pr::output_function, i, sample_.outputs));
    watch_release(now);
    // CCWL and CWL are on where motion is allowed (4.6); ignored ones say nothing.
    const auto use = settings_.known(pr::limit_use) % 10;
    const auto limit = [&](Input input, bool used) {
        if (!used) return false;
        for (int i = 0; i < input_count; ++i)
            if (std::abs(function(pr::input_function, i)) == static_cast<int>(input) && on(pr::input_function, i, sample_.inputs))
                return false;
        return true;
    };
    sample_.positive_limit = limit(Input::ccw_allowed, use == 0 || use == 2);
    sample_.negative_limit = limit(Input::cw_allowed, use == 0 || use == 1);
    const auto& profile = *config_.profile;
    sample_.home = ((sample_.inputs >> profile.input_bit_home) & 1u) != 0;
}

/// Disabled over the line it ramps by Pr063 and holds for its brake (Pr136, Pr166); what has power after that is held on by somebody else:
/// which of function 42h, SON and Pr120 wins is not stated (9.6.7).
void Schedule::watch_release(Instant now) {
    if (!sample_.running && !look_for_alarm_) sample_.released = true;
    if (sample_.released) return;
    constexpr Duration margin = 1s;
    const auto ramp = milliseconds{settings_.known(pr::stop_time) * settings_.known(pr::highest_speed) / 1000};
    if (now - disabled_at_ < ramp + milliseconds{settings_.known(pr::brake_hold)} + margin) return;
    settings_.object(
        "it keeps its power although function 42h disabled it: something else enables it, the input SON most likely. Open that [9.6.7, "
        "5.5]");
    sample_.setup_refused = true;
}

/// Current gone although nobody asked: mostly an alarm. That is read first, so that the axis hears the cause and not the effect.
void Schedule::take_running(bool running) {
    look_for_alarm_ = !running && sample_.running && enable_sent_;
    if (!look_for_alarm_) sample_.running = running;
}

void Schedule::lost(Instant now) {
    phase_ = Phase::closed;
    last_try_ = now;
    sample_.online = sample_.running = look_for_alarm_ = false;
    settings_.forget();
    settings_.restart();
}

// --- services -----------------------------------------------------------------------------------------------------------------

bool Schedule::queue(const Service& service) {
    if (services_.size() >= service_room) return false;
    services_.push_back(service);
    return true;
}

std::optional<std::pair<ServiceTicket, modbus::Answer>> Schedule::served() { return std::exchange(served_, std::nullopt); }

bool Schedule::saved_would_be_harmless() const noexcept {
    for (std::uint16_t i = 0; i < 5; ++i)
        if (!settings_.knows(static_cast<std::uint16_t>(pr::force_1 + i), 0)) return false;
    return phase_ == Phase::running && !sample_.running && settings_.known(pr::forced_enable) == 0;
}

}  // namespace taktwerk::axes::xp200
