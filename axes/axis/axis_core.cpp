// What comes from the drive and what goes to it. See axis.hpp for the order of the calls.

#include "axes/axis/axis_core.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace taktwerk::axes {

namespace {

std::uint32_t stale_cycles(const AxisConfig& config, const DriveCapabilities& drive, Duration cycle) {
    const auto polls = cycle > Duration::zero() ? std::max<std::int64_t>(1, drive.feedback_period / cycle) : 1;
    return static_cast<std::uint32_t>(config.stale_limit * polls);
}

/// The mode it runs in for every motion. A drive that takes no set-point each cycle makes its own ramps.
DriveMode own_mode(const AxisConfig& config, const DriveCapabilities& drive) {
    if (config.control.mode == ControlMode::position) return DriveMode::cyclic_position;
    return drive.setpoints == SetpointClass::low_dynamics ? DriveMode::profile_velocity : DriveMode::cyclic_velocity;
}

/// Bounds of velocity that act through a slow line would come too late: there the drive keeps them.
double torque_inertia(const AxisConfig& config, const DriveCapabilities& drive) {
    return drive.setpoints == SetpointClass::low_dynamics ? 0 : config.control.inertia();
}

/// A tenth of the cycle rate: see TorqueControl.
double torque_bandwidth(Duration cycle) { return cycle > Duration::zero() ? 0.1 / to_seconds(cycle) : 0; }

/// The history is as long as the dead time of a bus. For a slow line it keeps one set-point in several cycles.
bool remembers(const DriveCapabilities& drive, Instant now, Duration cycle) {
    if (drive.setpoints == SetpointClass::cyclic) return true;
    constexpr int kept = 12;  // set-points for a worst latency, of SetpointHistory::depth
    const Duration spacing = std::max<Duration>((drive.command_latency + drive.feedback_period) / kept, cycle);
    const auto at = now.time_since_epoch();
    return at / spacing != (at - cycle) / spacing;
}

}  // namespace

AxisCore::AxisCore(AxisConfig config, DrivePort& port, Duration cycle, std::uint16_t index, AxisView* view)
    : config_(std::move(config)),
      port_(port),
      cycle_(cycle),
      stale_limit_(stale_cycles(config_, port.capabilities(), cycle)),
      driven_(!config_.disabled && !config_.encoder),
      endless_(std::isinf(config_.limits.position_min) && std::isinf(config_.limits.position_max)),
      units_(config_.gearing, config_.modulo),
      index_(index),
      own_mode_(own_mode(config_, port.capabilities())),
      former_mode_(own_mode_),
      torque_per_acceleration_((config_.gearing.inverted ? -1.0 : 1.0) * config_.control.torque_feed_forward * config_.control.inertia()),
      torque_(torque_inertia(config_, port.capabilities()), torque_bandwidth(cycle)),
      compensation_(config_.compensation),
      power_(port.capabilities().enable_delay, config_.enable_timeout),
      alarms_(index),
      own_view_(view ? nullptr : std::make_unique<AxisView>()),
      view_(view ? *view : *own_view_) {
    view_ = {};
    view_.owner = Owner::program;
    view_.simulated = config_.simulated;
    view_.modulo = config_.modulo;
    store_parameters();
    use_parameters();
    publish();
}

bool AxisCore::drive_stands() const noexcept {
    return std::abs(feedback_.velocity) <= config_.windows.standstill_velocity * std::abs(units_.counts_per_unit());
}

/// What the motor's position means for the load, where compensation tells them apart.
double AxisCore::compensated(double motor) const noexcept {
    const double machine = units_.machine(motor);
    return motor + (compensation_.load(machine) - machine);
}

void AxisCore::update(Instant now) noexcept {
    now_ = now;
    power_calls_ = 0;
    read_feedback();
    if (!drive_as_wanted()) {
        if (driven_) watch_drive();
        run_power();
    }
    const double actual = actual_local();
    watch_following_error(actual);
    watch_probes();
    if (view_.resetting) run_reset();
    publish_commands();
    publish_feedback(actual);
}

void AxisCore::read_feedback() noexcept {
    feedback_ = port_.decode(now_);
    if (!feedback_.online && !absolute_encoder()) view_.homed = false;  // it may come back with another zero
    if (feedback_.reference_epoch != reference_epoch_) lose_reference();
    reference_epoch_ = feedback_.reference_epoch;
    if (!feedback_.fresh) {
        if (stale_ < 0xFFFFFFFF) ++stale_;
        return;
    }
    stale_ = 0;
    actual_counts_ = feedback_.position;
    // A drive that was away may count from another zero: the set-point of a drive without power goes there at once.
    // (One that was enabled when it went has to be seen without power first; its own homing is followed elsewhere.)
    const bool other_zero = feedback_.position_epoch != position_epoch_;
    if (!seeded_ || (other_zero && power_.follows_actual()) || drive_homing_.busy()) position_epoch_ = feedback_.position_epoch;
    if (!seeded_ || (other_zero && power_.follows_actual() && !drive_homing_.busy())) {
        if (!seeded_) apply_retained();
        seeded_ = true;
        anchor_near_actual();
        setpoint_.place(actual_local());
        publish_setpoint();
    }
    // Switches are wired to the drive's sense of direction.
    const bool inverted = config_.gearing.inverted;
    negative_switch_ = feedback_.has_inputs && (inverted ? feedback_.positive_limit : feedback_.negative_limit);
    positive_switch_ = feedback_.has_inputs && (inverted ? feedback_.negative_limit : feedback_.positive_limit);
    if (negative_switch_ && positive_switch_) fail(AxisAlarm::both_limit_switches);
    else alarms_.clear(AxisAlarm::both_limit_switches);
}

void AxisCore::watch_drive() noexcept {
    const bool asked = power_.phase() != PowerSequence::Phase::off;
    if (seeded_ && asked && !online()) fail(AxisAlarm::axis_feedback_lost, static_cast<double>(stale_), static_cast<double>(stale_limit_));
    if (!feedback_.fresh || !online()) return;

    // The detail that tells shared codes apart is read beside the cycle and comes later (P21.08 of the SV33-E).
    const auto announce = [&](AxisAlarm alarm) {
        const auto detail = port_.alarm().detail;
        fail(alarm, feedback_.error_code, detail);
        if (feedback_.error_code != 0) alarms_.renumber(alarm, feedback_.error_code, detail);
    };
    if (feedback_.warning) announce(AxisAlarm::drive_warning);
    else alarms_.clear(AxisAlarm::drive_warning);
    if (feedback_.fault || feedback_.warning) {
        const auto kind = port_.alarm().kind;
        if (kind == DriveAlarmKind::reference_lost || kind == DriveAlarmKind::turn_overflow) lose_reference();
    }

    if (drive_faulted()) {
        announce(AxisAlarm::drive_fault);
    } else if (asked && feedback_.setup_refused) fail(AxisAlarm::drive_setup_refused);
    else if (asked && feedback_.power == PowerState::unknown) fail(AxisAlarm::drive_unknown_state, feedback_.status_word);
    else if (power_.on() && !drive_homing_.busy() && !mode_changes() && feedback_.mode != wanted_mode())
        fail(AxisAlarm::drive_mode_mismatch, static_cast<double>(feedback_.mode), static_cast<double>(wanted_mode()));
}

/// Nothing for watch_drive() and run_power(): power is on and stays on, and the drive says nothing to the contrary.
bool AxisCore::drive_as_wanted() const noexcept {
    const bool well = feedback_.fresh && feedback_.online && feedback_.power == PowerState::enabled && !feedback_.fault &&
                      !feedback_.setup_refused && !feedback_.warning && feedback_.mode == own_mode_;
    const bool stays_on = power_.on() && view_.state != AxisState::Disabled && view_.state != AxisState::ErrorStop;
    return well && stays_on && driven_ && mode_phase_ == ModePhase::steady && !drive_homing_.busy() && alarms_.active().empty();
}

bool AxisCore::power_wanted() const noexcept {
    using Phase = PowerSequence::Phase;
    if (!driven_) return false;
    if (view_.state == AxisState::Disabled) return power_wish_ && !power_dropping_ && emergency_ == EmergencyStop::none;
    if (view_.state != AxisState::ErrorStop) return true;  // these states end in Disabled before power goes
    const bool drive_on = power_.phase() == Phase::on || power_.phase() == Phase::settling;
    // A slow line stops the motor later than the set-point.
    const bool still_slows_down = port_.capabilities().setpoints == SetpointClass::low_dynamics && online() && !drive_stands();
    return drive_on && emergency_ != EmergencyStop::power_off_now && (moves() || still_slows_down || (power_wish_ && !off_after_error_));
}

void AxisCore::run_power() noexcept {
    const auto event = power_.step({.wanted = power_wanted(),
                                    .aligned = aligned_,
                                    .online = online(),
                                    .mode_confirmed = feedback_.mode == wanted_mode() || drive_homing_.busy(),
                                    .drive = feedback_.power,
                                    .now = now_});
    show_power();
    if (power_.phase() == PowerSequence::Phase::off) power_dropping_ = false;
    switch (event) {
        case PowerSequence::Event::ready:
            fire(AxisEvent::powered);
            if (queue_.waiting() > 0) start_waiting(0);  // table 4: Status lets begin what is buffered behind MC_Power
            break;
        case PowerSequence::Event::timeout:
            if (turns_by_itself()) fail(AxisAlarm::motor_turns, view_.actual_velocity, turning_by_itself * config_.limits.velocity);
            else fail(AxisAlarm::enable_timeout, to_seconds(config_.enable_timeout), static_cast<double>(feedback_.power));
            break;
        case PowerSequence::Event::lost:
            abort_homing();
            // A fault has its own alarm, also between two samples of a drive that is polled; in ErrorStop the power may go for reasons already
            // announced.
            if (view_.state == AxisState::ErrorStop) break;
            if (drive_faulted()) fail(AxisAlarm::drive_fault, feedback_.error_code, port_.alarm().detail);
            else fail(AxisAlarm::drive_power_lost, static_cast<double>(feedback_.power));
            break;
        case PowerSequence::Event::none:
        case PowerSequence::Event::off: break;
    }
}

void AxisCore::watch_following_error(double actual) noexcept {
    if (follows_motor() || mode_phase_ != ModePhase::steady) {  // in torque the set-point follows the motor
        view_.following_error = 0;
        following_timer_.clear();
        in_window_ = false;
        return;
    }
    if (!feedback_.fresh) return;
    const double error = history_.error_at(feedback_.latched, feedback_.position) / units_.counts_per_unit();
    view_.following_error = error;
    // Pressed against a block the set-point runs ahead; that is no error until the axis has caught up.
    const bool beyond = std::abs(error) > config_.following.window;
    lag_forgiven_ = step_run_.presses() || (lag_forgiven_ && beyond);
    if (!beyond || lag_forgiven_) following_timer_.clear();
    else if (following_timer_.lasts(feedback_.latched, config_.following.time) && view_.state != AxisState::ErrorStop)
        fail(AxisAlarm::following_error, error, config_.following.window);

    const bool inside = setpoint_.at_rest() && std::abs(setpoint_.state().position - actual) <= config_.windows.in_position;
    if (inside && !in_window_) in_window_since_ = now_;
    in_window_ = inside;
}

void AxisCore::encode(Instant now) noexcept {
    command_ = {};
    command_.power = power_.request();
    command_.reset_fault = view_.resetting && (drive_faulted() || feedback_.setup_refused);
    command_.start_homing = drive_homing_.start_level();
    command_.homing = drive_homing_setup();
    const auto& set = setpoint_.state();
    if (!compensation_.none()) compensation_.step(units_.machine(set.position), set.velocity, view_.homed, cycle_);
    fill_targets();
    probes_.command(command_.probes);
    if (latch_.armed()) command_.probes[latch_.probe()] = latch_.command();
    command_.digital_outputs = view_.digital_outputs;
    command_.digital_output_mask = digital_output_mask_;
    if (step_run_.presses() && port_.capabilities().torque_limits)
        command_.torque_limit_positive = command_.torque_limit_negative = block_torque_;
    port_.encode(command_, now);

    if (follows_motor() || mode_phase_ != ModePhase::steady) history_.clear();
    else if (remembers(port_.capabilities(), now, cycle_)) history_.record(port_.setpoint_effective(now), command_.position);
}

// --- the view -----------------------------------------------------------------------------------------------------------------

void AxisCore::publish() noexcept {
    publish_commands();
    publish_probes();
    show_side(SideSlot::passive_homing, passive_.id);
    publish_feedback(actual_local());
    publish_setpoint();
    view_.override_factors = override_;
}

void AxisCore::publish_feedback(double actual) noexcept {
    view_.online = online();
    view_.in_position = in_window_ && now_ - in_window_since_ >= config_.windows.in_position_time;
    view_.warning = feedback_.warning;
    view_.drive_error = feedback_.error_code;

    view_.actual_position = units_.to_program(actual);
    view_.actual_velocity = feedback_.velocity / units_.counts_per_unit();
    view_.actual_torque = config_.gearing.inverted ? -feedback_.torque : feedback_.torque;

    view_.drive_state = feedback_.power;
    view_.drive_mode = feedback_.mode;
    view_.status_word = feedback_.status_word;
    view_.negative_limit_switch = negative_switch_;
    view_.positive_limit_switch = positive_switch_;
    view_.home_switch = feedback_.home_switch;
    view_.digital_inputs = feedback_.digital_inputs;
}

void AxisCore::publish_setpoint() noexcept {
    const auto& set = setpoint_.state();
    const double rest = setpoint_.layered() ? setpoint_.superimposed().position + setpoint_.superimposed_rest() : 0;
    const double target = (goal_.kind == Goal::Kind::position ? goal_.value : setpoint_.end().position) + rest;
    view_.set_position = units_.to_program(set.position);
    view_.target_position = units_.to_program(target);
    if (units_.modulo() > 0) view_.turns = units_.turns(set.position);
    view_.set_velocity = set.velocity;
    view_.set_acceleration = set.acceleration;
    view_.set_jerk = setpoint_.jerk();
    view_.limiter = setpoint_.at_rest() && !held_                 ? VelocityLimiter::none
                    : override_.velocity < 1 && override_counts() ? VelocityLimiter::override_factor
                                                                  : goal_.limiter;
}

}  // namespace taktwerk::axes
