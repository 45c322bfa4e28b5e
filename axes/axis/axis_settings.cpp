// What is written to an axis beside motion, at once or in its turn behind motion: parameters and the outputs of its drive.

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr std::int32_t drive_outputs = 32;  // bits of 60FEh

[[nodiscard]] Duration seconds(double s) noexcept {
    constexpr double most = 1e9;  // thirty years: from_seconds counts nanoseconds in 64 bit
    return from_seconds(std::min(s, most));
}

}  // namespace

// --- in their turn ----------------------------------------------------------------------------------------------------------

/// With nothing before it its turn is now. It waits behind motion in any state, moves nothing and changes no state.
Submitted AxisCore::submit_setting(const AxisCommand& command, Owner owner) noexcept {
    if (!may(owner)) return {0, ErrorId::owned_by_other};
    const auto* setting = std::get_if<AxisSetting>(&command.details);
    if (!setting || command.buffer_mode > mcBuffered) return {0, ErrorId::invalid_parameter};
    // What can be said now is said now; the rest when its turn comes.
    if (const auto* parameter = std::get_if<WriteParameter>(setting))
        if (const auto error = check_write(view_, *parameter); error != ErrorId::none) return {0, error};
    const bool waits =
        command.buffer_mode == mcBuffered && (queue_.has_active() || queue_.waiting() > 0 || view_.state == AxisState::Stopping);
    if (waits && queue_.waiting() >= config_.queue_depth) return {0, ErrorId::queue_full};
    const AcceptedCommand accepted{queue_.next_id(), owner, command};
    if (waits) queue_.push(accepted);
    else carry_out(accepted);
    publish();
    return {accepted.id, ErrorId::none};
}

void AxisCore::carry_out(const AcceptedCommand& setting) noexcept {
    const auto error = set(std::get<AxisSetting>(setting.command.details), setting.owner);
    queue_.record(setting.id, error == ErrorId::none ? Outcome::done : Outcome::error, error);
}

/// A motion without end lets pass what waits behind it once it is at its velocity, and goes on.
void AxisCore::carry_out_due_settings() noexcept {
    while (queue_.waiting() > 0 && queue_.front().command.kind == CommandKind::setting && view_.active_in_target) carry_out(queue_.pop());
}

// --- parameters -------------------------------------------------------------------------------------------------------------

/// From the configuration, once.
void AxisCore::store_parameters() noexcept {
    auto& p = view_.parameters;
    const auto& limits = config_.limits;
    p[software_limit_positive] = limits.position_max;
    p[software_limit_negative] = limits.position_min;
    p[enable_limit_positive] = std::isfinite(limits.position_max) ? 1 : 0;
    p[enable_limit_negative] = std::isfinite(limits.position_min) ? 1 : 0;
    p[enable_lag_monitoring] = std::isfinite(config_.following.window) ? 1 : 0;
    p[maximum_lag] = config_.following.window;
    p[velocity_of_system] = p[velocity_of_application] = limits.velocity;
    p[acceleration_of_system] = p[acceleration_of_application] = limits.acceleration;
    p[deceleration_of_system] = p[deceleration_of_application] = limits.deceleration;
    p[jerk_of_system] = p[jerk_of_application] = limits.jerk;
    p[place_of(in_position_window)] = config_.windows.in_position;
    p[place_of(in_position_time)] = to_seconds(config_.windows.in_position_time);
    p[place_of(standstill_velocity)] = config_.windows.standstill_velocity;
    p[place_of(lag_time)] = to_seconds(config_.following.time);
    p[place_of(default_acceleration)] = config_.defaults.acceleration;
    p[place_of(default_deceleration)] = config_.defaults.deceleration;
    p[place_of(default_jerk)] = config_.defaults.jerk;
    const auto& manual = config_.manual;
    const double slow = manual.slow > 0 ? manual.slow : 0.05 * limits.velocity;
    p[place_of(jog_velocity_slow)] = slow;
    p[place_of(jog_velocity_fast)] = manual.fast > 0 ? manual.fast : 0.25 * limits.velocity;
    p[place_of(setup_velocity)] = manual.setup_velocity > 0 ? manual.setup_velocity : slow;
}

/// The stored values become those that hold.
void AxisCore::use_parameters() noexcept {
    const auto& p = view_.parameters;
    auto& limits = config_.limits;
    // Lowered limits are for commands: stops for errors stay as hard as configured.
    if (limits.stop_deceleration <= 0) limits.stop_deceleration = p[deceleration_of_system];
    if (limits.stop_jerk <= 0) limits.stop_jerk = p[jerk_of_system];
    limits.velocity = p[velocity_of_application];
    limits.acceleration = p[acceleration_of_application];
    limits.deceleration = p[deceleration_of_application];
    limits.jerk = p[jerk_of_application];
    limits.position_max = p[enable_limit_positive] != 0 ? p[software_limit_positive] : unlimited;
    limits.position_min = p[enable_limit_negative] != 0 ? p[software_limit_negative] : -unlimited;
    config_.following.window = p[enable_lag_monitoring] != 0 ? p[maximum_lag] : unlimited;
    config_.following.time = seconds(p[place_of(lag_time)]);
    config_.windows.in_position = p[place_of(in_position_window)];
    config_.windows.in_position_time = seconds(p[place_of(in_position_time)]);
    config_.windows.standstill_velocity = p[place_of(standstill_velocity)];
    config_.defaults = {p[place_of(default_acceleration)], p[place_of(default_deceleration)], p[place_of(default_jerk)]};
    config_.manual = {p[place_of(jog_velocity_slow)], p[place_of(jog_velocity_fast)], p[place_of(setup_velocity)]};
    watch_limits_ = true;
    view_.manual_slow = config_.manual.slow;
    view_.manual_fast = config_.manual.fast;
}

/// The axis could not stop before `edge`, or is on its way to a place behind it.
bool AxisCore::beyond_reach(double edge, bool positive) const noexcept {
    if (!software_limits_hold() || setpoint_.at_rest()) return false;
    const auto& state = setpoint_.state();
    const double here = units_.to_program(state.position);
    const double stop = here + stopping_distance(state, full_limits(config_.limits));
    double target = goal_.kind == Goal::Kind::position ? units_.to_program(goal_.value) : here, next = target;
    if (mode_phase_ == ModePhase::profile && drive_run_.mode() == DriveMode::profile_position && drive_run_.under_way()) {
        // The drive goes to its targets, whatever the axis thinks of them later.
        target = units_.to_program(drive_run_.front().target);
        next = units_.to_program(drive_run_.last().target);
    }
    return positive ? std::max({here, stop, target, next}) > edge : std::min({here, stop, target, next}) < edge;
}

/// What only the axis knows: whether the change would leave a moving axis without its way to stop.
ErrorId AxisCore::refuse_now(const WriteParameter& wanted) const noexcept {
    const auto& p = view_.parameters;
    switch (wanted.number) {
        case software_limit_positive:
            return p[enable_limit_positive] != 0 && beyond_reach(wanted.value, true) ? ErrorId::beyond_software_limit : ErrorId::none;
        case software_limit_negative:
            return p[enable_limit_negative] != 0 && beyond_reach(wanted.value, false) ? ErrorId::beyond_software_limit : ErrorId::none;
        case enable_limit_positive:
            return wanted.value != 0 && beyond_reach(p[software_limit_positive], true) ? ErrorId::beyond_software_limit : ErrorId::none;
        case enable_limit_negative:
            return wanted.value != 0 && beyond_reach(p[software_limit_negative], false) ? ErrorId::beyond_software_limit : ErrorId::none;
        case deceleration_of_application:
        case jerk_of_application: return setpoint_.at_rest() ? ErrorId::none : ErrorId::state_forbids;
        default: return ErrorId::none;
    }
}

ErrorId AxisCore::write_parameter(const WriteParameter& wanted) noexcept {
    if (const auto error = check_write(view_, wanted); error != ErrorId::none) return error;
    if (const auto error = refuse_now(wanted); error != ErrorId::none) return error;
    view_.parameters[place_of(static_cast<Parameter>(wanted.number))] = wanted.value;
    use_parameters();
    return ErrorId::none;
}

// --- outputs of the drive -----------------------------------------------------------------------------------------------------

ErrorId AxisCore::write_output(const WriteOutput& wanted) noexcept {
    if (!port_.capabilities().digital_outputs) return ErrorId::not_supported;
    if (wanted.number < 0 || wanted.number >= drive_outputs) return ErrorId::invalid_output;
    const auto bit = 1u << static_cast<unsigned>(wanted.number);
    digital_output_mask_ |= bit;
    view_.digital_outputs = wanted.value ? view_.digital_outputs | bit : view_.digital_outputs & ~bit;
    publish();
    return ErrorId::none;
}

}  // namespace taktwerk::axes
