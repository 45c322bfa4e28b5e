#include "axes/sim/personality.hpp"

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
    p.brake_release = profile.brake_release;
    p.brake_hold = profile.brake_hold;
    // The first row of a kind is this drive's own alarm for it; kinds that the profile does not mark keep the usual codes.
    const auto own = [&](DriveAlarmKind kind, AlarmCode& alarm) {
        for (const auto& row : profile.alarms)
            if (row.kind == kind) {
                alarm = {row.code, row.resettable, row.detail, row.warning};
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
        p.alarms.push_back({row.panel, {row.code, row.resettable, row.detail}, row.kind, row.warning, row.clears_itself});
    return p;
}

}  // namespace taktwerk::axes::sim
