#pragma once
// A drive small enough to check by eye: it follows its set-point exactly, `dead_cycles` late, and knows power, faults, switches and a homing.
// In torque it is a mass with friction and a load; in cyclic velocity it turns as fast as it is told; its own profiles: fake_profile.hpp.
// It notes what would be felt at a real motor: the largest step of the set-point while it was enabled.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>

#include "axes/port/drive_port.hpp"
#include "tests/axes/axis/fake_profile.hpp"

namespace taktwerk::axes::test {

class FakeDrive final : public DrivePort {
public:
    explicit FakeDrive(Duration period) : cycle(period) {
        caps.modes = 0xFFFF;
        caps.drive_homing = true;
        caps.digital_inputs = true;
    }

    // what a test turns
    Duration cycle;
    int dead_cycles = 1;  ///< from sending a set-point to its effect
    int latch_age = 1;    ///< how many cycles old the actual values are when they arrive
    int power_delay = 3;  ///< cycles per step of the power state machine
    bool silent = false;  ///< no fresh feedback
    bool offline = false;
    bool refuses_power = false;
    std::uint16_t fault_code = 0;
    std::uint32_t alarm_detail = 0;
    bool resettable = true;
    std::uint16_t epoch = 0;
    bool warning = false;
    bool blocked = false;                  ///< the motor does not move
    std::int64_t lag = 0;                  ///< counts the motor stays behind
    double drift = 0;                      ///< counts/s that it turns more than it is told, in cyclic velocity
    double coasting = 0;                   ///< counts per cycle while without power
    double quick_stop_deceleration = 5e6;  ///< counts/s2 (6085h); then it is without power (605Ah = 2), ...
    bool quick_stop_stays = false;         ///< ... or holds (605Ah = 6)
    bool switches = false;
    std::int64_t home_low = 0, home_high = 0;  ///< home switch on between
    std::int64_t negative_end = std::numeric_limits<std::int64_t>::min(), positive_end = std::numeric_limits<std::int64_t>::max();
    std::int64_t negative_stop = std::numeric_limits<std::int64_t>::min() / 2,
                 positive_stop = std::numeric_limits<std::int64_t>::max() / 2;  ///< the motor cannot pass
    double stiffness = 0.001;                                                   ///< rated torques per count that a stop holds it back
    std::int64_t index_at = 0;                                                  ///< the index pulses are moved by so many counts
    std::int64_t homing_speed = 5, homing_place = -2000;
    std::int64_t wraps_at_home = 0;  ///< whole ranges of the raw position that the port's unwrapping has counted
    bool homing_fails = false, homing_hangs = false;
    DriveMode forced_mode = DriveMode::none;
    int mode_delay = 2;         ///< cycles until it has taken a mode
    bool modes_travel = false;  ///< each mode that it is told comes to it, `dead_cycles` later, and is seen `latch_age` after that
    bool refuses_torque_mode = false;
    double rated_acceleration = 2e6;  ///< counts/s2 that rated torque gives the free motor
    double load = 0, friction = 0;    ///< rated torques: pulls to negative; against motion
    std::uint32_t inputs = 0;         ///< 60FDh
    /// A signal on each probe input, on while the motor is between the two counts; and an index pulse at each multiple of `index_distance`.
    struct ProbeSignal {
        std::int64_t low = 0, high = -1;
    };
    std::array<ProbeSignal, 2> probe_signal{};
    std::int64_t index_distance = 0;
    int arming_time = 2;  ///< cycles from the command to the latch waiting
    DriveCapabilities caps;
    std::uint16_t reference_epoch = 0;
    bool refuses_homing_setup = false;
    DriveAlarmKind alarm_kind = DriveAlarmKind::other;
    FakeProfile profile;
    bool refuses_profile_modes = false;
    bool obeys_torque_limits = false;  ///< while a stop holds it back
    int limit_delay = 0;               ///< cycles until torque limits are written, where caps.torque_limits_written says that they are
    bool refuses_torque_limits = false;

    // what a test reads
    double position = 0;  ///< of the motor, counts; what homing sets to zero is `zero`
    std::int64_t zero = 0;
    std::int64_t largest_step = 0;  ///< of the set-point while enabled in cyclic position, counts
    PowerState power = PowerState::disabled;
    DriveCommand last;

    [[nodiscard]] const DriveCapabilities& capabilities() const noexcept override { return caps; }
    [[nodiscard]] Instant setpoint_effective(Instant send) const noexcept override { return send + dead_cycles * cycle; }
    [[nodiscard]] DriveAlarm alarm() const noexcept override {
        DriveAlarm known;
        known.code = fault_code;
        known.detail = alarm_detail;
        known.resettable = resettable;
        known.kind = alarm_kind;
        return known;
    }

    void encode(const DriveCommand& command, Instant now) noexcept override {
        const bool obeys =
            power == PowerState::enabled && command.mode == DriveMode::cyclic_position && mode_ == DriveMode::cyclic_position;
        const auto target = command.position + zero;
        // The first target counts against where the motor is: a drive that switches on would jump there.
        const std::int64_t from = obeyed_ ? last_target_ : std::llround(position);
        if (obeys) largest_step = std::max<std::int64_t>(largest_step, std::abs(target - from));
        obeyed_ = obeys;
        last_target_ = target;
        const bool other_limits =
            command.torque_limit_positive != last.torque_limit_positive || command.torque_limit_negative != last.torque_limit_negative;
        limits_age_ = other_limits ? 0 : limits_age_ + 1;
        sent_.push_back({setpoint_effective(now), target, command.velocity, command.torque, command.mode});
        if (sent_.size() > 64) sent_.pop_front();
        last = command;
    }

    const DriveFeedback& decode(Instant now) noexcept override {
        step_power();
        step_mode(now);
        step_motor(now);
        if (silent || offline) {
            feedback_.fresh = false;
            feedback_.online = !offline;
            ++feedback_.age;
            return feedback_;
        }
        feedback_.fresh = feedback_.online = true;
        feedback_.age = 0;
        feedback_.latched = now - latch_age * cycle;
        feedback_.power = power;
        feedback_.mode = forced_mode == DriveMode::none ? mode_ : forced_mode;
        feedback_.fault = power == PowerState::fault;
        feedback_.warning = warning;
        feedback_.error_code = fault_code;
        feedback_.position_epoch = epoch;
        feedback_.reference_epoch = reference_epoch;
        feedback_.homing_setup_refused = refuses_homing_setup && last.homing.method != 0;
        feedback_.torque_limits = !caps.torque_limits_written ? TorqueLimitAnswer::taken
                                  : limits_age_ < limit_delay ? TorqueLimitAnswer::pending
                                  : refuses_torque_limits     ? TorqueLimitAnswer::refused
                                                              : TorqueLimitAnswer::taken;
        feedback_.position = std::llround(position) - zero;
        feedback_.velocity = velocity_;
        feedback_.torque = by_torque() ? torque_ : load + held_back_;
        feedback_.profile_accepted = profile.accepted;
        feedback_.target_reached = profiled() && (mode_ == DriveMode::profile_torque ? torque_ == last.torque : profile.reached);
        feedback_.homing_attained = attained_;
        feedback_.homing_error = homing_error_;
        feedback_.has_inputs = switches;
        feedback_.home_switch = position >= static_cast<double>(home_low) && position <= static_cast<double>(home_high) && switches;
        feedback_.digital_inputs = inputs;
        feedback_.negative_limit = position <= static_cast<double>(negative_end);
        feedback_.positive_limit = position >= static_cast<double>(positive_end);
        return feedback_;
    }

private:
    void step_power() {
        if (fault_code != 0) power = PowerState::fault;
        else if (power == PowerState::fault) {
            if (last.reset_fault) power = PowerState::disabled;
        } else if (last.power == PowerRequest::quick_stop && (power == PowerState::enabled || power == PowerState::quick_stop)) {
            power = power == PowerState::quick_stop && velocity_ == 0 && !quick_stop_stays ? PowerState::disabled : PowerState::quick_stop;
        } else if (last.power == PowerRequest::off || refuses_power) {
            power = PowerState::disabled;
            ticks_ = 0;
        } else if (power != PowerState::enabled && ++ticks_ >= power_delay) {
            ticks_ = 0;
            power = power == PowerState::disabled ? PowerState::ready
                    : power == PowerState::ready  ? PowerState::switched_on
                                                  : PowerState::enabled;
        }
    }
    void step_mode(Instant now) {
        if (modes_travel) {
            mode_ = at(now - latch_age * cycle).mode;
            return;
        }
        if (last.mode == mode_) mode_ticks_ = 0;
        else if (++mode_ticks_ >= std::max(mode_delay, dead_cycles + latch_age + 1) &&
                 takes(last.mode)) {  // with the set-point of the same frame
            mode_ = last.mode;
            profile.enter();
        }
    }
    [[nodiscard]] bool takes(DriveMode mode) {
        if (refuses_torque_mode && mode == DriveMode::cyclic_torque) return false;
        if (refuses_profile_modes && is_profile(mode)) return false;
        return !profile.holds(mode_);
    }
    [[nodiscard]] static bool is_profile(DriveMode mode) {
        return mode == DriveMode::profile_position || mode == DriveMode::profile_velocity || mode == DriveMode::profile_torque;
    }
    [[nodiscard]] bool profiled() const { return is_profile(mode_); }
    [[nodiscard]] bool by_torque() const { return mode_ == DriveMode::cyclic_torque || mode_ == DriveMode::profile_torque; }
    void step_motor(Instant now) {
        const double before = position;
        if (power == PowerState::quick_stop) {
            velocity_ -= std::copysign(std::min(std::abs(velocity_), quick_stop_deceleration * to_seconds(cycle)), velocity_);
            position += velocity_ * to_seconds(cycle);
        } else if (power != PowerState::enabled) position += coasting;
        else if (mode_ == DriveMode::homing) step_homing();
        else if (by_torque()) {
            if (profiled()) (void)profile.step(mode_, last, position, to_seconds(cycle));
            step_torque(now);
        } else if (profiled()) position = profile.step(mode_, last, position, to_seconds(cycle));
        else if (mode_ == DriveMode::cyclic_velocity) position += (at(now - latch_age * cycle).velocity + drift) * to_seconds(cycle);
        else if (!blocked) {
            const auto target = target_at(now - latch_age * cycle) - lag;
            const auto held = std::clamp(target, negative_stop, positive_stop);
            // Let go, it makes up what it missed no faster than a motor could.
            const double missing = static_cast<double>(held) - position;
            freed_ = freed_ && std::abs(missing) > catching_up;
            position += freed_ ? std::copysign(catching_up, missing) : missing;
            held_back_ = std::clamp(stiffness * static_cast<double>(target - held), -3.0, 3.0);  // no more than a drive has
            if (obeys_torque_limits) held_back_ = std::clamp(held_back_, -last.torque_limit_negative, last.torque_limit_positive);
        }
        freed_ = freed_ || blocked;
        for (std::size_t i = 0; i < 2; ++i) step_probe(i, std::llround(before), std::llround(position));
        if (mode_ != DriveMode::homing) attained_ = homing_error_ = false;
        if (power != PowerState::enabled || !by_torque()) velocity_ = (position - before) / to_seconds(cycle);
    }
    /// Like CiA 402: the first edge after arming is kept, in continuous mode the newest; disarming forgets it.
    void step_probe(std::size_t i, std::int64_t from, std::int64_t to) {
        const auto& wanted = last.probes[i];
        auto& latch = feedback_.probes[i];
        armed_for_[i] = wanted.armed ? armed_for_[i] + 1 : 0;
        latch.armed = armed_for_[i] > arming_time;
        if (!latch.armed) {
            latch = {};
            return;
        }
        const auto edge =
            wanted.index_pulse ? index_between(from - index_at, to - index_at) : edge_of(probe_signal[i], wanted.edge, from, to);
        if (!edge || (latch.latched && !wanted.continuous)) return;
        latch.latched = true;
        latch.position = *edge - zero;
        ++latch.count;
    }
    [[nodiscard]] static std::optional<std::int64_t> edge_of(const ProbeSignal& signal, ProbeEdge edge, std::int64_t from,
                                                             std::int64_t to) {
        const auto on = [&](std::int64_t at) { return signal.low <= at && at <= signal.high; };
        const bool rising = edge == ProbeEdge::rising;
        if (on(from) == on(to) || on(to) != rising) return std::nullopt;
        return (to > from) == rising ? signal.low : signal.high;  // going up it begins at its low end and ends at its high one
    }
    [[nodiscard]] std::optional<std::int64_t> index_between(std::int64_t from, std::int64_t to) const {
        if (index_distance <= 0 || from == to) return std::nullopt;
        const auto turn = [&](std::int64_t at) {
            return (at - (((at % index_distance) + index_distance) % index_distance)) / index_distance;
        };
        if (turn(from) == turn(to)) return std::nullopt;
        return std::max(turn(from), turn(to)) * index_distance + index_at;
    }
    void step_torque(Instant now) {
        if (profiled() && last.halt && !profile.stuck) {  // 605Dh = 1: along the ramp, whatever torque is asked for
            torque_ = 0;
            velocity_ -= std::copysign(std::min(std::abs(velocity_), last.deceleration * to_seconds(cycle)), velocity_);
            position += velocity_ * to_seconds(cycle);
            return;
        }
        torque_ = at(now - (latch_age + 1) * cycle).torque;  // what held during the cycle that ended at the latch
        constexpr int parts = 8;
        const double dt = to_seconds(cycle) / parts;
        for (int i = 0; i < parts; ++i) {
            const double driving = torque_ - load;
            const double against = velocity_ != 0 ? std::copysign(friction, velocity_) : std::clamp(driving, -friction, friction);
            const double next = velocity_ + (driving - against) * rated_acceleration * dt;
            // Friction stops a motion, it does not reverse it.
            velocity_ = velocity_ != 0 && next * velocity_ < 0 && std::abs(driving) <= friction ? 0 : next;
            position += velocity_ * dt;
        }
    }
    void step_homing() {
        if (!last.start_homing || attained_ || homing_error_ || homing_hangs) return;
        const std::int64_t way = homing_place - std::llround(position);
        position += static_cast<double>(std::clamp<std::int64_t>(way, -homing_speed, homing_speed));
        if (std::llround(position) != homing_place) return;
        if (homing_fails) homing_error_ = true;
        else {
            attained_ = true;
            zero = homing_place - wraps_at_home * (1LL << 32);
        }
    }
    /// Linear between the set-points, as a drive interpolates.
    [[nodiscard]] std::int64_t target_at(Instant t) const {
        if (sent_.empty() || t <= sent_.front().effective) return sent_.empty() ? 0 : sent_.front().target;
        for (std::size_t i = 1; i < sent_.size(); ++i) {
            const auto& a = sent_[i - 1];
            const auto& b = sent_[i];
            if (t > b.effective) continue;
            const double part = to_seconds(t - a.effective) / to_seconds(b.effective - a.effective);
            return a.target + std::llround(part * static_cast<double>(b.target - a.target));
        }
        return sent_.back().target;
    }

    struct Sent {
        Instant effective{};
        std::int64_t target = 0;
        double velocity = 0, torque = 0;
        DriveMode mode = DriveMode::cyclic_position;
    };
    /// The newest command in effect at `t`.
    [[nodiscard]] Sent at(Instant t) const {
        Sent found;
        for (const auto& sent : sent_)
            if (sent.effective <= t) found = sent;
        return found;
    }
    static constexpr double catching_up = 150;  // counts per cycle
    std::deque<Sent> sent_;
    DriveFeedback feedback_;
    DriveMode mode_ = DriveMode::cyclic_position;
    int ticks_ = 0, mode_ticks_ = 0;
    int limits_age_ = 0;  // cycles since the torque limits changed
    std::array<int, 2> armed_for_{};
    bool attained_ = false, homing_error_ = false, obeyed_ = false;
    bool freed_ = false;  // was blocked, and still makes up what it missed
    std::int64_t last_target_ = 0;
    double velocity_ = 0, torque_ = 0;
    double held_back_ = 0;  // torque against a hard stop
};

}  // namespace taktwerk::axes::test
