#include "axes/sim/personality.hpp"

#include "axes/sim/communication_error.hpp"

namespace taktwerk::axes::sim {

Personality personality_of(const DriveProfile& profile, std::int64_t counts_per_revolution) {
    Personality p;
    p.counts_per_revolution = counts_per_revolution;
    p.velocity_counts_per_unit = profile.velocity_counts_per_unit;
    p.torque_rated_raw = profile.torque_rated_raw;
    p.remote_bit = !profile.has(Quirk::no_remote_bit);
    p.internal_limit_bit = !profile.has(Quirk::no_internal_limit_bit);
    p.csp_following_bits = !profile.has(Quirk::csp_bits_12_13_reserved);
    p.fault_pattern_f = profile.has(Quirk::fault_low_nibble_f);
    p.reset_needs_disable = profile.has(Quirk::fault_reset_needs_disable);
    p.limit_stop_is_warning = profile.has(Quirk::limit_stop_is_warning);
    if (!profile.homing_methods.empty()) p.homing_methods = 0;
    for (const int method : profile.homing_methods)
        if (method >= -2 && method < 62) p.homing_methods |= std::uint64_t{1} << (method + 2);
    p.homing_limit_is_fault = profile.has(Quirk::homing_limit_is_fault);
    p.homing_19_starts_negative = profile.has(Quirk::homing_19_starts_negative);
    p.probe_toggle = profile.has(Quirk::probe_toggle_bits) ? ProbeToggle::bits_6_and_7 : ProbeToggle::none;
    p.encoder_turn_bits = profile.encoder_turn_bits;
    p.fault_stop = profile.fault_stop;
    p.off_stop = profile.off_stop;
    p.quick_stop_leaves = profile.quick_stop_leaves;
    p.stops = profile.stops;
    if (!profile.modes.empty()) p.modes = 0;
    for (const auto mode : profile.modes) p.modes = static_cast<std::uint16_t>(p.modes | (1u << static_cast<unsigned>(mode)));
    p.mode_violation = profile.mode_violation;
    p.mode_change_at_standstill = profile.mode_change_at_standstill;
    p.mode_change_interval = profile.mode_change_interval;
    p.mode_indeterminate = profile.mode_indeterminate;
    p.profile_buffer = profile.profile_buffer;
    p.pp_bit_5_blends = profile.has(Quirk::pp_bit_5_blends);
    p.pp_shared_ramp = profile.has(Quirk::pp_shared_ramp);
    p.pp_stop_forgets = profile.has(Quirk::pp_stop_forgets);
    p.csv_ramps = profile.has(Quirk::csv_ramps);
    p.ramp_before_mode_change = profile.has(Quirk::ramp_before_mode_change);
    p.pv_speed_zero_bit = !profile.has(Quirk::pv_bits_12_13_reserved);
    p.velocity_window_in_rpm = profile.has(Quirk::velocity_window_in_rpm);
    p.brake_release = profile.brake_release;
    p.brake_hold = profile.brake_hold;
    p.brake_moving_wait = profile.brake_moving_wait;
    p.brake_moving_speed = profile.brake_moving_speed / 60.0 * static_cast<double>(counts_per_revolution);
    p.battery_low = profile.battery_low;
    p.battery_empty = profile.battery_empty;
    p.encoder_keeps_fault = profile.encoder_reset.index != 0;
    // The first row of a kind is this drive's own alarm for it; kinds that the profile does not mark keep the usual codes.
    const auto own = [&](DriveAlarmKind kind, AlarmCode& alarm) {
        for (const auto& row : profile.alarms)
            if (row.kind == kind) {
                alarm = {row.code, row.resettable, row.detail, row.warning, row.whole_drive};
                return;
            }
    };
    own(DriveAlarmKind::following_error, p.following_error_alarm);
    own(DriveAlarmKind::setpoint_leap, p.increment_alarm);
    own(DriveAlarmKind::undervoltage, p.undervoltage_alarm);
    own(DriveAlarmKind::communication, p.communication_alarm);
    own(DriveAlarmKind::overspeed, p.overspeed_alarm);
    own(DriveAlarmKind::overload, p.overload_alarm);
    own(DriveAlarmKind::encoder, p.encoder_alarm);
    own(DriveAlarmKind::homing_timeout, p.homing_timeout_alarm);
    own(DriveAlarmKind::homing_limit, p.homing_limit_alarm);
    own(DriveAlarmKind::homing_method, p.homing_method_alarm);
    own(DriveAlarmKind::battery_low, p.battery_low_alarm);
    own(DriveAlarmKind::reference_lost, p.reference_lost_alarm);
    own(DriveAlarmKind::turn_overflow, p.turn_overflow_alarm);
    own(DriveAlarmKind::left_operational, p.left_operational_alarm);
    own(DriveAlarmKind::link_changed, p.link_alarm);
    own(DriveAlarmKind::torque_overload, p.torque_overload_alarm);
    if (profile.behaviour.state.error_sub_code.index != 0) {
        p.communication_alarm.detail = communication_error::watchdog;
        p.left_operational_alarm = {p.communication_alarm.code, p.communication_alarm.resettable, communication_error::general};
    }
    p.fault_reaction_02b6 = profile.has(Quirk::fault_reaction_02b6);
    p.alarm_sets_warning_bit = profile.has(Quirk::alarm_sets_warning_bit);
    p.remote_bit_from_preop = profile.has(Quirk::remote_bit_from_preop);
    p.quick_stop_bit_rests_high = profile.has(Quirk::quick_stop_bit_rests_high);
    p.target_reached_in_cyclic = !profile.has(Quirk::cyclic_bit_10_reserved);
    p.self_test = profile.self_test;
    p.deaf_after_enable = profile.deaf_after_enable;
    p.torque_overload = profile.torque_overload;
    p.torque_overload_time = profile.torque_overload_time;
    own(DriveAlarmKind::mode_not_set, p.mode_not_set_alarm);
    own(DriveAlarmKind::mode_change, p.mode_change_alarm);
    AlarmCode limit;
    own(DriveAlarmKind::negative_limit, limit);
    if (limit.code) p.negative_limit_code = limit.code;
    limit = {};
    own(DriveAlarmKind::positive_limit, limit);
    if (limit.code) p.positive_limit_code = limit.code;
    own(DriveAlarmKind::start_too_fast, p.start_speed_alarm);
    AlarmCode stall;
    own(DriveAlarmKind::stall, stall);
    if (stall.code) {
        p.stall_alarm = stall;
        p.stall_time = std::chrono::milliseconds{200};  // SV33-E P08.18
    }
    for (const auto& row : profile.alarms)
        p.alarms.push_back(
            {row.panel, {row.code, row.resettable, row.detail, row.warning, row.whole_drive}, row.kind, row.warning, row.clears_itself});
    return p;
}

}  // namespace taktwerk::axes::sim
