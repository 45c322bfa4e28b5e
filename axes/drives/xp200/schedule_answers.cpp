// What an answer means.

#include <algorithm>
#include <cmath>
#include <utility>

#include "axes/drives/xp200/schedule.hpp"

namespace taktwerk::axes::xp200 {

using namespace std::chrono_literals;
using modbus::Outcome;
using std::chrono::milliseconds;

namespace {

constexpr Duration rest_patience = 2s;  // for a motor that is to rest, so that the index pulse can be found

}  // namespace

void Schedule::take(const modbus::Answer& answer, Instant now) {
    const auto asked = std::exchange(asked_, Asked::nothing);
    if (asked == Asked::service) services_.answered(answer);
    if (answer.outcome != Outcome::answered && answer.outcome != Outcome::exception) {
        if (phase_ != Phase::closed && now - sample_.heard >= config_.silence) lost(now);
        return;
    }
    sample_.heard = now;
    sample_.saving = asked == Asked::service && answer.request.function == modbus::Function::save && answer.outcome == Outcome::answered;
    if (answer.outcome == Outcome::exception) {
        if (asked == Asked::servo) orders_.answered(PowerOrders::Heard::refused);
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
                orders_.opened(now);
                phase_ = Phase::reading;
                settings_.restart();
            } else orders_.answered(PowerOrders::Heard::done);
            break;
        case Asked::position: take_position(answer, now); break;
        case Asked::turn: single_turn_ = answer.response.words[0] | (static_cast<std::int64_t>(answer.response.words[1]) << 16); break;
        case Asked::terminals: take_terminals(answer.response.words[0], answer.response.words[1], now); break;
        case Asked::alarm:
            // 255 and 65535: "none" in some tables; the register's coding is not stated (9.5).
            if (std::exchange(look_for_alarm_, false)) {
                if (orders_.on()) orders_.seen(false);  // taken back meanwhile, its RUN is still to be looked at
                show_running(false);
            }
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

void Schedule::take_position(const modbus::Answer& answer, Instant now) {
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
        if (leaps) {
            ++sample_.epoch;
            index_.forget();
        }
        raw_ = raw;
        sample_.position += way;
        if (time > 0 && !leaps) sample_.velocity = static_cast<double>(way) / time;
    }
    doubtful_ = false;
    watch_index(now);
    sample_.sampled = answer.sampled;
    sample_.torque = static_cast<double>(static_cast<std::int16_t>(words[4])) / 100;
    sample_.torque_mode = drives_torque() || settings_.knows(pr::force_4, force::mode + force::emergency);
    sample_.online = turn_ > 3;      // terminals and alarm have been read once
    sample_.acknowledged = obeyed_;  // with what the motor does since: one that stood before may turn now
    ++sample_.number;
}

void Schedule::watch_index(Instant now) {
    rests_ = index_.at(sample_.position);
    if (const auto value = std::exchange(single_turn_, std::nullopt); value && rests_) index_.measured(sample_.position, *value);
    show_index(now);
}

void Schedule::follow_latch(const Wish& wish, Instant now) noexcept {
    if (wish.latch == sample_.latch) return;
    sample_.latch = wish.latch;
    index_.arm((wish.latch & 1u) != 0);
    latch_since_ = now;
    show_index(now);
}

void Schedule::show_index(Instant now) {
    sample_.latch_armed = index_.waits();
    sample_.latched = index_.latched();
    sample_.latch_at = index_.place();
    const bool never_rests = now - latch_since_ > rest_patience;
    sample_.no_index = (sample_.latch & 1u) != 0 && !index_.known() && (never_rests || (rests_ && !index_.turned()));
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
    look_for_alarm_ = !running && orders_.on();
    if (look_for_alarm_) return;
    orders_.seen(running);
    show_running(running);
}

void Schedule::show_running(bool running) {
    sample_.running = running;
    sample_.power_of = running ? orders_.power_of() : std::uint16_t{0};
}

void Schedule::lost(Instant now) {
    phase_ = Phase::closed;
    last_try_ = now;
    sample_.online = sample_.running = look_for_alarm_ = false;
    orders_.forget();
    sample_.power_of = 0;
    settings_.forget();
    settings_.restart();
}

}  // namespace taktwerk::axes::xp200
