#include "axes/axis/axis_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/axis/command_check.hpp"
#include "axes/axis/direction_limits.hpp"

namespace taktwerk::axes {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr std::int32_t drive_outputs = 32;  // bits of 60FEh

[[nodiscard]] Duration seconds(double s) noexcept {
    constexpr double most = 1e9;  // thirty years: from_seconds counts nanoseconds in 64 bit
    return from_seconds(std::min(s, most));
}

}  // namespace

void AxisParameters::store() noexcept {
    auto& p = view_.parameters;
    const auto& limits = body_.config.limits;
    p[software_limit_positive] = limits.position_max;
    p[software_limit_negative] = limits.position_min;
    p[enable_limit_positive] = std::isfinite(limits.position_max) ? 1 : 0;
    p[enable_limit_negative] = std::isfinite(limits.position_min) ? 1 : 0;
    p[enable_lag_monitoring] = std::isfinite(body_.config.following.window) ? 1 : 0;
    p[maximum_lag] = body_.config.following.window;
    p[velocity_of_system] = p[velocity_of_application] = limits.velocity;
    p[acceleration_of_system] = p[acceleration_of_application] = limits.acceleration;
    p[deceleration_of_system] = p[deceleration_of_application] = limits.deceleration;
    p[jerk_of_system] = p[jerk_of_application] = limits.jerk;
    p[place_of(in_position_window)] = body_.config.windows.in_position;
    p[place_of(in_position_time)] = to_seconds(body_.config.windows.in_position_time);
    p[place_of(standstill_velocity)] = body_.config.windows.standstill_velocity;
    p[place_of(lag_time)] = to_seconds(body_.config.following.time);
    p[place_of(lag_per_velocity)] = to_seconds(body_.config.following.per_velocity);
    p[place_of(default_acceleration)] = body_.config.defaults.acceleration;
    p[place_of(default_deceleration)] = body_.config.defaults.deceleration;
    p[place_of(default_jerk)] = body_.config.defaults.jerk;
    const auto& manual = body_.config.manual;
    const double slow = manual.slow > 0 ? manual.slow : 0.05 * limits.velocity;
    p[place_of(jog_velocity_slow)] = slow;
    p[place_of(jog_velocity_fast)] = manual.fast > 0 ? manual.fast : 0.25 * limits.velocity;
    p[place_of(setup_velocity)] = manual.setup_velocity > 0 ? manual.setup_velocity : slow;
}

void AxisParameters::use() noexcept {
    const auto& p = view_.parameters;
    auto& limits = body_.config.limits;
    // Lowered limits are for commands: stops for errors stay as hard as configured.
    if (limits.stop_deceleration <= 0) limits.stop_deceleration = p[deceleration_of_system];
    if (limits.stop_jerk <= 0) limits.stop_jerk = p[jerk_of_system];
    limits.velocity = p[velocity_of_application];
    limits.acceleration = p[acceleration_of_application];
    limits.deceleration = p[deceleration_of_application];
    limits.jerk = p[jerk_of_application];
    limits.position_max = p[enable_limit_positive] != 0 ? p[software_limit_positive] : unlimited;
    limits.position_min = p[enable_limit_negative] != 0 ? p[software_limit_negative] : -unlimited;
    body_.config.following.window = p[enable_lag_monitoring] != 0 ? p[maximum_lag] : unlimited;
    body_.config.following.time = seconds(p[place_of(lag_time)]);
    body_.config.following.per_velocity = seconds(p[place_of(lag_per_velocity)]);
    view_.following_window = body_.config.following.window;
    body_.config.windows.in_position = p[place_of(in_position_window)];
    body_.config.windows.in_position_time = seconds(p[place_of(in_position_time)]);
    body_.config.windows.standstill_velocity = p[place_of(standstill_velocity)];
    body_.config.defaults = {p[place_of(default_acceleration)], p[place_of(default_deceleration)], p[place_of(default_jerk)]};
    body_.config.manual = {p[place_of(jog_velocity_slow)], p[place_of(jog_velocity_fast)], p[place_of(setup_velocity)]};
    auto& shown = view_.parameters;
    shown[place_of(velocity_positive)] = limits.velocity_towards(1);
    shown[place_of(velocity_negative)] = limits.velocity_towards(-1);
    shown[place_of(acceleration_positive)] = limits.acceleration_towards(1);
    shown[place_of(acceleration_negative)] = limits.acceleration_towards(-1);
    shown[place_of(deceleration_positive)] = limits.deceleration_towards(1);
    shown[place_of(deceleration_negative)] = limits.deceleration_towards(-1);
    motion_.watch_limits = true;
    view_.manual_slow = body_.config.manual.slow;
    view_.manual_fast = body_.config.manual.fast;
}

/// The axis could not stop before `edge`, or is on its way to a place behind it.
bool AxisParameters::beyond_reach(double edge, bool positive) const noexcept {
    if (!body_.software_limits_hold() || motion_.setpoint.at_rest()) return false;
    const auto& state = motion_.setpoint.state();
    const double here = body_.units.to_program(state.position);
    const double stop = here + stopping_distance(state, in_each_direction(full_limits(body_.config.limits), body_.config.limits));
    double target = motion_.goal.kind == Goal::Kind::position ? body_.units.to_program(motion_.goal.value) : here, next = target;
    if (modes_.phase == ModePhase::profile && modes_.run.mode() == DriveMode::profile_position && modes_.run.under_way()) {
        // The drive goes to its targets, whatever the axis thinks of them later.
        target = body_.units.to_program(modes_.run.front().target);
        next = body_.units.to_program(modes_.run.last().target);
    }
    return positive ? std::max({here, stop, target, next}) > edge : std::min({here, stop, target, next}) < edge;
}

/// A group's path is planned and checked with the limits that held when it began: narrower ones would find the axis beyond them, or stop it beside
/// the others. Wider ones count from the next path on.
bool AxisParameters::narrows(const WriteParameter& wanted) const noexcept {
    const auto& p = view_.parameters;
    switch (wanted.number) {
        case software_limit_positive: return p[enable_limit_positive] != 0 && wanted.value < p[software_limit_positive];
        case software_limit_negative: return p[enable_limit_negative] != 0 && wanted.value > p[software_limit_negative];
        case enable_limit_positive:
        case enable_limit_negative:
        case velocity_of_application:
        case acceleration_of_application:
        case deceleration_of_application:
        case jerk_of_application: {
            const double now = p[place_of(static_cast<Parameter>(wanted.number))];
            const bool enables = wanted.number == enable_limit_positive || wanted.number == enable_limit_negative;
            return enables ? wanted.value != 0 && now == 0 : wanted.value < now;
        }
        default: return false;
    }
}

/// What only the axis knows: whether the change would leave a moving axis without its way to stop.
ErrorId AxisParameters::refuse_now(const WriteParameter& wanted) const noexcept {
    const auto& p = view_.parameters;
    if (body_.led() && narrows(wanted)) return ErrorId::axis_grouped;
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
        case jerk_of_application: return motion_.setpoint.at_rest() ? ErrorId::none : ErrorId::state_forbids;
        default: return ErrorId::none;
    }
}

ErrorId AxisParameters::write(const WriteParameter& wanted) noexcept {
    if (const auto error = check_write(body_.shown, wanted); error != ErrorId::none) return error;
    if (const auto error = refuse_now(wanted); error != ErrorId::none) return error;
    view_.parameters[place_of(static_cast<Parameter>(wanted.number))] = wanted.value;
    use();
    return ErrorId::none;
}

ErrorId AxisParameters::write_output(const WriteOutput& wanted) noexcept {
    if (!body_.port.capabilities().digital_outputs) return ErrorId::not_supported;
    if (wanted.number < 0 || wanted.number >= drive_outputs) return ErrorId::invalid_output;
    if (wanted.number == 0 && body_.config.brake.by == BrakeBy::object) return ErrorId::invalid_output;  // the brake's: MC_SetBrake
    const auto bit = 1u << static_cast<unsigned>(wanted.number);
    output_mask_ |= bit;
    view_.digital_outputs = wanted.value ? view_.digital_outputs | bit : view_.digital_outputs & ~bit;
    return ErrorId::none;
}

}  // namespace taktwerk::axes
