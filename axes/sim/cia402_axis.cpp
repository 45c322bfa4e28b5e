#include "axes/sim/cia402_axis.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes::sim {

namespace {

constexpr Duration inner_period = std::chrono::microseconds{125};
constexpr double inner_seconds = 125e-6;
constexpr std::uint32_t allowed_strikes = 3;  // SV33-E E.424: "several times"
constexpr double increment_factor = 3.0;      // SV33-E P0A.33, default 3

constexpr std::uint16_t bit(unsigned n) { return static_cast<std::uint16_t>(1u << n); }

}  // namespace

Cia402Axis::Cia402Axis(const PlantConfig& plant, const Personality& personality) : personality_(personality), plant_(plant) {}

void Cia402Axis::power_on(Instant now) noexcept {
    if (!personality_.absolute_encoder) {
        zero_ = plant_.position();
        homed_ = false;
    }
    now_ = now;
    mode_ = 0;
    error_code_ = 0;
    error_detail_ = 0;
    error_resettable_ = true;
    last_control_ = 0;
    encoder_failed_ = winding_down_ = false;
    brake_closed_ = has_brake();
    probes_ = {};
    homing_.abort();
    enter(State::disabled);
}

double Cia402Axis::quantised() const noexcept { return std::floor(actual()); }

SwitchStates Cia402Axis::switches() const noexcept { return {plant_.negative_limit(), plant_.positive_limit(), plant_.home_switch()}; }

bool Cia402Axis::stands() const noexcept {
    return std::abs(plant_.velocity()) < 0.01 * static_cast<double>(personality_.counts_per_revolution);
}

/// Power goes by command: the motor first stops, then holds until the brake does, as far as this drive does either.
void Cia402Axis::wind_down() noexcept {
    winding_down_ = personality_.off_stop == FaultStop::ramp || (has_brake() && stands());
    winding_down_until_ = now_ + personality_.brake_hold;
    if (winding_down_) demand_ = {plant_.position(), plant_.velocity(), 0};
}

void Cia402Axis::step_brake() noexcept {
    if (winding_down_) {
        if (!stands()) winding_down_until_ = now_ + personality_.brake_hold;
        else if (now_ >= winding_down_until_) winding_down_ = false;
    }
    brake_closed_ = has_brake() && stands() && (state_ == State::enabled ? now_ < commands_from_ : !energised());
    plant_.hold(brake_closed_);
}

bool Cia402Axis::too_early() noexcept { return now_ < commands_from_; }

void Cia402Axis::enter(State state) noexcept {
    const bool powered = state_ == State::enabled || state_ == State::quick_stop;
    if (state == State::enabled) winding_down_ = false;
    else if (powered && state != State::quick_stop && state != State::fault_reaction && state != State::not_ready) wind_down();
    else if (state == State::not_ready || state == State::fault_reaction) winding_down_ = false;
    if (state == State::enabled && state_ != State::enabled) {
        commands_from_ = now_ + personality_.brake_release;
        demand_ = {plant_.position(), 0, 0};
        target_ = plant_.position();
        steps_left_ = 0;
        velocity_demand_ = torque_demand_ = torque_offset_ = 0;
        strikes_ = 0;
        loop_.reset();
    }
    if (state != State::enabled) homing_.abort();
    if (state == State::quick_stop || state == State::fault_reaction) demand_ = {plant_.position(), plant_.velocity(), 0};
    state_ = state;
}

void Cia402Axis::raise(std::uint16_t code, bool resettable, std::uint32_t detail) noexcept {
    if (state_ == State::fault || state_ == State::fault_reaction) return;  // the first alarm is the one shown
    error_code_ = code;
    error_detail_ = detail;
    error_resettable_ = resettable;
    enter(energised() ? State::fault_reaction : State::fault);
}

void Cia402Axis::fail(Failure failure) noexcept {
    switch (failure) {
        case Failure::overspeed: raise(personality_.overspeed_alarm); break;
        case Failure::following_error: raise(personality_.following_error_alarm); break;
        case Failure::undervoltage: raise(personality_.undervoltage_alarm); break;
        case Failure::overload: raise(personality_.overload_alarm); break;
        case Failure::communication: raise(personality_.communication_alarm); break;
        case Failure::encoder:
            frozen_position_ = static_cast<std::int64_t>(quantised());
            encoder_failed_ = true;
            raise(personality_.encoder_alarm);
            break;
    }
}

void Cia402Axis::main_power(bool on) noexcept {
    main_power_ = on;
    if (!on && (state_ == State::enabled || state_ == State::quick_stop)) raise(personality_.undervoltage_alarm);
}

void Cia402Axis::communication_lost() noexcept {
    operational_ = false;
    if (state_ == State::enabled || state_ == State::quick_stop) raise(personality_.communication_alarm);
    else if (state_ == State::ready || state_ == State::switched_on) enter(State::disabled);
}

void Cia402Axis::command(const AxisInputs& in) noexcept {
    const std::uint16_t word = in.control;
    const bool reset_edge = (word & 0x80u) && !(last_control_ & 0x80u);
    last_control_ = word;
    if (state_ == State::fault) {
        const bool dropped = !personality_.reset_needs_disable || (word & 0x0Fu) != 0x0Fu;
        const bool cause_gone = !encoder_failed_ && (main_power_ || error_code_ != personality_.undervoltage_alarm.code);
        if (reset_edge && dropped && error_resettable_ && cause_gone) {
            error_code_ = 0;
            error_detail_ = 0;
            enter(State::disabled);
        }
        return;
    }
    if (word & 0x80u) return;  // while bit 7 stands nothing else is taken (SV33-E 3.4.1, TSVM 5.3.2)
    const bool voltage = (word & 0x02u) != 0, quick = (word & 0x04u) == 0;
    const bool shutdown = voltage && !quick && !(word & 0x01u);
    const bool switch_on = voltage && !quick && (word & 0x01u);
    const bool enable = switch_on && (word & 0x08u);
    switch (state_) {
        case State::disabled:
            if (shutdown) enter(State::ready);
            break;
        case State::ready:
            if (!voltage || quick) enter(State::disabled);
            else if (switch_on && main_power_) enter(State::switched_on);
            break;
        case State::switched_on:
            if (!voltage || quick) enter(State::disabled);
            else if (shutdown) enter(State::ready);
            else if (enable && main_power_) enter(State::enabled);
            break;
        case State::enabled:
            if (!voltage) enter(State::disabled);
            else if (quick) enter(State::quick_stop);
            else if (shutdown) enter(State::ready);
            else if (!enable) enter(State::switched_on);
            break;
        case State::quick_stop:
            if (!voltage) enter(State::disabled);
            else if (enable && !personality_.quick_stop_leaves) enter(State::enabled);
            break;
        case State::not_ready:
        case State::fault_reaction:
        case State::fault: break;
    }
}

void Cia402Axis::select_mode(const AxisInputs& in) noexcept {
    if (in.mode == mode_) return;
    const bool known = in.mode == 3 || in.mode == 4 || in.mode == 6 || in.mode == 8 || in.mode == 9 || in.mode == 10;
    if (!known) return;
    if (mode_ == 6 && homing_.state() == HomingRun::State::moving) return;  // no other mode while homing runs (SV33-E 3.4.3)
    if (mode_ == 4 || mode_ == 10) loop_.take_over(torque_);
    mode_ = in.mode;
    homing_.abort();
    homing_attained_ = homing_error_ = false;
    // A switch never moves: the new mode starts where the axis is.
    demand_ = {plant_.position(), 0, 0};
    target_ = plant_.position();
    steps_left_ = 0;
    velocity_demand_ = torque_demand_ = torque_offset_ = 0;
}

void Cia402Axis::take_position_target(const AxisInputs& in, double seconds) noexcept {
    const double wanted = static_cast<double>(in.target_position) + zero_;
    const double increment = std::abs(wanted - target_);
    if (too_early()) {  // the drive does not listen yet; what was lost shows as a leap afterwards
        if (increment >= 1) ++early_commands_;
        return;
    }
    largest_increment_ = std::max(largest_increment_, increment);
    if (personality_.maximum_velocity > 0 && increment > increment_factor * personality_.maximum_velocity * seconds) {
        if (++strikes_ >= allowed_strikes) {
            raise(personality_.increment_alarm);
            return;
        }
    } else {
        strikes_ = 0;
    }
    warning_ = false;
    if (personality_.limit_stop_is_warning) {
        const bool into_negative = plant_.negative_limit() && wanted < plant_.position();
        const bool into_positive = plant_.positive_limit() && wanted > plant_.position();
        if (into_negative || into_positive) {
            warning_ = true;
            error_code_ = into_negative ? personality_.negative_limit_code : personality_.positive_limit_code;
            target_ = demand_.position = plant_.position();
            demand_.velocity = 0;
            steps_left_ = 0;
            return;
        }
        error_code_ = 0;
    }
    target_ = wanted;
    steps_left_ = std::max<std::int64_t>(1, std::llround(seconds / inner_seconds));
    demand_step_ = (target_ - demand_.position) / (static_cast<double>(steps_left_) * inner_seconds);
}

void Cia402Axis::take_targets(const AxisInputs& in, Duration cycle) noexcept {
    const double torque_offset = static_cast<double>(in.torque_offset) / personality_.torque_rated_raw * plant_.config().rated_torque;
    torque_offset_ = mode_ == 8 || mode_ == 9 ? torque_offset : 0;
    switch (mode_) {
        case 8: take_position_target(in, to_seconds(cycle)); break;
        case 3:
        case 9:
            if (too_early()) {
                if (in.target_velocity != 0) ++early_commands_;
                break;
            }
            velocity_demand_ = static_cast<double>(in.target_velocity + in.velocity_offset) / personality_.velocity_counts_per_unit;
            break;
        case 4:
        case 10:
            if (too_early()) {
                if (in.target_torque != 0) ++early_commands_;
                break;
            }
            torque_demand_ =
                static_cast<double>(in.target_torque) / personality_.torque_rated_raw * plant_.config().rated_torque + torque_offset;
            fastest_ = static_cast<double>(in.maximum_velocity) / personality_.velocity_counts_per_unit;
            break;
        case 6: {
            const bool start = (in.control & 0x10u) != 0;
            if (start && homing_.state() == HomingRun::State::idle && too_early()) {
                ++early_commands_;
                break;
            }
            const auto state = homing_.state();
            if (start && state == HomingRun::State::idle) {
                homing_attained_ = homing_error_ = false;
                home_offset_ = in.home_offset;
                homing_.start(in.homing, switches());
            } else if (!start && state != HomingRun::State::idle) {
                homing_.abort();
                demand_ = {plant_.position(), 0, 0};
            }
            break;
        }
        default: break;
    }
}

void Cia402Axis::homing_finished() noexcept {
    if (homing_.state() == HomingRun::State::failed) {
        homing_error_ = true;
    } else if (!homing_attained_) {
        // 60E6h = 0: the edge gets the coordinate 607Ch; the actual position jumps, the motor does not.
        zero_ = homing_.reference() - static_cast<double>(home_offset_);
        homing_attained_ = homed_ = true;
    }
}

void Cia402Axis::stop_step(double dt, double deceleration) noexcept {
    const double most = deceleration > 0 ? deceleration * dt : std::abs(demand_.velocity);
    demand_.velocity -= std::clamp(demand_.velocity, -most, most);
    demand_.position += demand_.velocity * dt;
}

void Cia402Axis::inner_step() noexcept {
    const double dt = inner_seconds;
    torque_ = 0;
    if (energised()) {
        if (state_ != State::enabled) {
            stop_step(dt, personality_.quick_stop_deceleration);
            torque_ = loop_.velocity_control(plant_, demand_.velocity, 0, torque_limit(), dt);
        } else if (mode_ == 4 || mode_ == 10) {
            torque_ = ServoLoop::torque_control(plant_, torque_demand_, fastest_, torque_limit());
        } else if (mode_ == 3 || mode_ == 9) {
            torque_ = loop_.velocity_control(plant_, velocity_demand_, 0, torque_limit(), dt);
            torque_ = std::clamp(torque_ + torque_offset_, -torque_limit(), torque_limit());
        } else {
            if (mode_ == 6 && homing_.state() != HomingRun::State::idle) {
                homing_.step(dt, switches(), plant_.position());
                demand_.velocity = homing_.velocity();
                demand_.position += demand_.velocity * dt;
                if (homing_.state() == HomingRun::State::attained || homing_.state() == HomingRun::State::failed) homing_finished();
            } else if (steps_left_ > 0) {
                --steps_left_;
                demand_.velocity = demand_step_;
                demand_.position = steps_left_ == 0 ? target_ : demand_.position + demand_step_ * dt;
            } else {
                demand_.velocity = 0;
            }
            torque_ = loop_.position_control(plant_, demand_, quantised() + zero_, torque_limit(), dt);
            torque_ = std::clamp(torque_ + torque_offset_, -torque_limit(), torque_limit());
        }
    }
    step_brake();
    const double before = plant_.position();
    plant_.step(dt, torque_);
    step_probes(before);

    if (state_ == State::fault_reaction && (personality_.fault_stop == FaultStop::coast || stands())) enter(State::fault);
    if (state_ == State::quick_stop && personality_.quick_stop_leaves && demand_.velocity == 0 && stands()) enter(State::disabled);
    if (state_ == State::enabled && personality_.overspeed > 0 && std::abs(plant_.velocity()) > personality_.overspeed)
        raise(personality_.overspeed_alarm);
    if (state_ == State::enabled && personality_.following_error_limit > 0 && (mode_ == 8 || mode_ == 6) &&
        std::abs(demand_.position - plant_.position()) > personality_.following_error_limit)
        raise(personality_.following_error_alarm);
}

/// In the drive's counts, as the latched position is; the index pulse is the encoder's own.
void Cia402Axis::step_probes(double before) noexcept {
    for (std::size_t i = 0; i < probes_.size(); ++i) {
        const auto& seen = plant_.config().probe[i];
        const auto signal = blank_ ? ProbeSignal{} : nearest({seen.from, seen.to}, seen.every, plant_.position());
        probes_[i].motion(before - zero_, plant_.position() - zero_, {signal.from - zero_, signal.to - zero_},
                          static_cast<double>(personality_.counts_per_revolution));
    }
}

void Cia402Axis::advance(Instant now) noexcept {
    while (now_ + inner_period <= now) {
        now_ += inner_period;
        inner_step();
    }
}

void Cia402Axis::exchange(const AxisInputs& in, Duration cycle, AxisOutputs& out) noexcept {
    select_mode(in);
    command(in);
    for (std::size_t i = 0; i < probes_.size(); ++i) probes_[i].command(static_cast<std::uint8_t>(in.probe_function >> (8 * i)));
    if (state_ == State::enabled) take_targets(in, cycle);
    fill(out);
}

std::uint16_t Cia402Axis::status_word() const noexcept {
    std::uint16_t word = 0;
    switch (state_) {
        case State::not_ready: word = 0x00; break;
        case State::disabled: word = 0x40; break;
        case State::ready: word = 0x21; break;
        case State::switched_on: word = 0x23; break;
        case State::enabled: word = 0x27; break;
        case State::quick_stop: word = 0x07; break;
        case State::fault_reaction: word = 0x0F; break;
        case State::fault: word = personality_.fault_pattern_f ? 0x0F : 0x08; break;
    }
    if (main_power_) word |= bit(4);
    if (warning_) word |= bit(7);
    if (personality_.remote_bit && operational_) word |= bit(9);
    if (mode_ == 6) {
        if (stands() && homing_.state() != HomingRun::State::moving && homing_.state() != HomingRun::State::stopping) word |= bit(10);
        if (homing_attained_) word |= bit(12);
        if (homing_error_) word |= bit(13);
    } else {
        if (state_ == State::enabled && stands() && std::abs(demand_.position - plant_.position()) < 10) word |= bit(10);
        const bool cyclic = mode_ == 8 || mode_ == 9 || mode_ == 10;
        if (cyclic && personality_.csp_following_bits && state_ == State::enabled) word |= bit(12);
    }
    if (personality_.home_found_bit_15 && homed_) word |= bit(15);
    return word;
}

void Cia402Axis::fill(AxisOutputs& out) const noexcept {
    out.status = status_word();
    out.mode = mode_;
    out.position = encoder_failed_ ? frozen_position_ : static_cast<std::int64_t>(quantised());
    out.velocity = std::llround(plant_.velocity() * personality_.velocity_counts_per_unit);
    out.torque = std::llround(torque_ / plant_.config().rated_torque * personality_.torque_rated_raw);
    out.demand = static_cast<std::int64_t>(std::floor(demand_.position - zero_));
    out.following_error = out.demand - out.position;
    out.error_code = error_code_;
    out.error_detail = error_detail_;
    for (std::size_t i = 0; i < probes_.size(); ++i) {
        out.probe_status = static_cast<std::uint16_t>(out.probe_status | probes_[i].status() << (8 * i));
        out.probe_rising[i] = probes_[i].rising();
        out.probe_falling[i] = probes_[i].falling();
    }
    out.digital_inputs = (plant_.negative_limit() ? 1u : 0u) | (plant_.positive_limit() ? 2u : 0u) | (plant_.home_switch() ? 4u : 0u);
}

}  // namespace taktwerk::axes::sim
