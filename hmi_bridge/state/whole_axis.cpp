#include "axes/axis/alarms.hpp"
#include "axes/axis/parameters.hpp"
#include "hmi_bridge/state/lcm_text.hpp"
#include "hmi_bridge/state/whole_state.hpp"
#include "hmi_bridge/words/words.hpp"
#include "runtime/alarms.hpp"

namespace taktwerk::hmi {
namespace {

/// What stopped the axis: its alarm may be gone long before somebody resets.
void fill_error(whole_axis_v1_t& out, AlarmId error) {
    const auto* info = find_alarm(axes::axis_alarms, error);
    if (!info) info = find_alarm(runtime::machine_alarms, error);
    put_text(out.error_name, info ? info->name : std::string_view{});
    put_text(out.error_cause, info ? info->cause : std::string_view{});
    put_text(out.error_remedy, info ? info->remedy : std::string_view{});
}

void fill_standing(whole_axis_v1_t& out, const axes::AxisView& axis, const runtime::MachineLayout::AxisInfo& info) {
    put_text(out.name, info.name);
    put_text(out.unit, info.unit);
    put_text(out.state, name(axis.state));
    put_text(out.owner, name(axis.owner));
    out.disabled = info.disabled;
    out.simulated = axis.simulated;
    out.online = axis.online;
    put_text(out.group, info.group);
    put_text(out.presence, name(axis.presence));
    out.powered = axis.powered;
    out.enable = axis.enable;
    out.enable_positive = axis.enable_positive;
    out.enable_negative = axis.enable_negative;
    out.homed = axis.homed;
    out.homing_busy = axis.state == axes::AxisState::Homing;
    out.in_position = axis.in_position;
    out.resetting = axis.resetting;
    out.warning = axis.warning;
    out.error = axis.error;
    fill_error(out, axis.error);
    out.drive_error = axis.drive_error;
}

void fill_motion(whole_axis_v1_t& out, const axes::AxisView& axis, const runtime::MachineLayout& layout) {
    out.not_moving = axis.set_velocity == 0;
    out.positive_direction = axis.set_velocity > 0;
    out.negative_direction = axis.set_velocity < 0;
    out.constant_velocity = axis.set_velocity != 0 && axis.set_acceleration == 0;
    out.has_job = axis.active != 0;
    put_text(out.command, word(axis.active_kind));
    put_text(out.block, layout.block_at(axis.holder));  // who blocks, when another is refused
    out.held_by_stop = axis.lock != 0;
    out.queued = axis.queued_count;
    out.actual_position = axis.actual_position;
    out.actual_velocity = axis.actual_velocity;
    out.actual_torque = axis.actual_torque;
    out.set_position = axis.set_position;
    out.set_velocity = axis.set_velocity;
    out.set_acceleration = axis.set_acceleration;
    out.set_jerk = axis.set_jerk;
    out.target_position = axis.target_position;
    out.distance_to_go = axis.active != 0 ? axis.target_position - axis.set_position : 0.0;
    out.following_error = axis.following_error;
    out.following_window = axis.following_window;
    out.turns = axis.turns;
    out.skew = axis.skew;
    out.load_difference = axis.load_difference;
    out.superimposed_covered = axis.superimposed_covered;
    out.phase_shift = axis.phase_shift;
    put_text(out.master,
             axis.master.index < layout.axes.size() ? std::string_view(layout.axes[axis.master.index].name) : std::string_view{});
    out.sync_started = axis.sync_started;
}

/// Limits as they hold now (axes/axis/parameters.hpp).
void fill_limits(whole_axis_v1_t& out, const axes::AxisView& axis) {
    const auto parameter = [&](axes::Parameter which) { return axis.parameters[axes::place_of(which)]; };
    put_text(out.velocity_limiter, word(axis.limiter));
    out.override_velocity = axis.override_factors.velocity;
    out.override_acceleration = axis.override_factors.acceleration;
    out.override_jerk = axis.override_factors.jerk;
    out.operators_override = axis.operators_override;
    out.has_position_min = parameter(axes::enable_limit_negative) != 0;
    out.position_min = parameter(axes::software_limit_negative);
    out.has_position_max = parameter(axes::enable_limit_positive) != 0;
    out.position_max = parameter(axes::software_limit_positive);
    out.velocity_limit = parameter(axes::velocity_of_application);
    out.manual_slow = axis.manual_slow;
    out.manual_fast = axis.manual_fast;
    out.torque_limit_positive = axis.torque_limit_positive;
    out.torque_limit_negative = axis.torque_limit_negative;
}

void fill_drive(whole_axis_v1_t& out, const axes::AxisView& axis) {
    put_text(out.brake, word(axis.brake));
    put_text(out.drive_state, name(axis.drive_state));
    put_text(out.drive_mode, name(axis.drive_mode));
    out.status_word = axis.status_word;
    out.digital_inputs = axis.digital_inputs;
    out.digital_outputs = axis.digital_outputs;
    out.negative_limit_switch = axis.negative_limit_switch;
    out.positive_limit_switch = axis.positive_limit_switch;
    out.home_switch = axis.home_switch;
}

}  // namespace

void fill(whole_axis_v1_t& out, const runtime::Snapshot& snapshot, const runtime::MachineLayout& layout, std::size_t index) {
    const auto& axis = snapshot.axes[index];
    fill_standing(out, axis, layout.axes[index]);
    fill_motion(out, axis, layout);
    fill_limits(out, axis);
    fill_drive(out, axis);
    const auto peak = index < snapshot.following_peaks.size() ? snapshot.following_peaks[index] : runtime::FollowingPeak{};
    out.following_error_min = peak.minimum;
    out.following_error_max = peak.maximum;
}

}  // namespace taktwerk::hmi
