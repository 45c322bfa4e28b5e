#include "axes/sim/cia402_device.hpp"

#include <algorithm>

namespace taktwerk::axes::sim {

namespace {

using ecat::sim::Entry;

std::int64_t value(const Entry* entry) noexcept { return entry ? entry->get() : 0; }
void put(Entry* entry, std::int64_t v) noexcept {
    if (entry) entry->set(v);
}

constexpr std::uint16_t status_fault = 1u << 3;

/// 1001h: bit 0 any error, the others by the class of the error code (CiA 301 7.5.2.2 and table of emergency codes).
std::uint8_t error_register(std::uint16_t code) noexcept {
    const unsigned generic = 1u << 0;
    switch (code >> 12) {
        case 0x2: return generic | 1u << 1;  // current
        case 0x3: return generic | 1u << 2;  // voltage
        case 0x4: return generic | 1u << 3;  // temperature
        case 0x8: return generic | 1u << 4;  // communication, monitoring
        case 0xF: return generic | 1u << 7;  // vendor's
        default: return generic;
    }
}

}  // namespace

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
    p.fault_stop = profile.fault_stop;
    p.off_stop = profile.off_stop;
    p.quick_stop_leaves = profile.quick_stop_leaves;
    p.brake_release = profile.brake_release;
    p.brake_hold = profile.brake_hold;
    // The first row of a kind is this drive's own alarm for it; kinds that the profile does not mark keep the usual codes.
    const auto own = [&](DriveAlarmKind kind, AlarmCode& alarm) {
        for (const auto& row : profile.alarms)
            if (row.kind == kind) {
                alarm = {row.code, row.resettable, row.detail};
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
    AlarmCode limit;
    own(DriveAlarmKind::negative_limit, limit);
    if (limit.code) p.negative_limit_code = limit.code;
    limit = {};
    own(DriveAlarmKind::positive_limit, limit);
    if (limit.code) p.positive_limit_code = limit.code;
    return p;
}

Cia402Device::Cia402Device(const DriveProfile& profile, const std::vector<AxisSetup>& axes)
    : object_offset_(profile.object_offset),
      detail_index_(profile.alarm_detail_index),
      detail_sub_(profile.alarm_detail_sub),
      alarms_(profile.alarms),
      minimum_cycle_(profile.minimum_cycle_csp) {
    for (const auto& setup : axes) axes_.push_back({std::make_unique<Cia402Axis>(setup.plant, setup.personality), {}});
}

void Cia402Device::power_on(ecat::sim::ObjectDictionary& dictionary, Instant now) {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        const auto at = [&](unsigned index, std::uint8_t sub = 0) {
            return dictionary.find(static_cast<std::uint16_t>(index + i * object_offset_), sub);
        };
        axes_[i].objects = {at(0x6040),
                            at(0x6060),
                            at(0x607A),
                            at(0x60FF),
                            at(0x6071),
                            at(0x60B1),
                            at(0x60B2),
                            at(0x607F),
                            at(0x6098),
                            at(0x6099, 1),
                            at(0x6099, 2),
                            at(0x609A),
                            at(0x607C),
                            at(0x6041),
                            at(0x6061),
                            at(0x6064),
                            at(0x606C),
                            at(0x6077),
                            at(0x60F4),
                            at(0x6062),
                            at(0x603F),
                            at(0x60FD),
                            at(0x60B8),
                            at(0x60B9),
                            {at(0x60BA), at(0x60BC)},
                            {at(0x60BB), at(0x60BD)}};
        axes_[i].model->power_on(now);
    }
    for (auto& axis : axes_) axis.faulted = false;
    alarm_detail_ = detail_index_ ? dictionary.find(detail_index_, detail_sub_) : nullptr;
    operational_ = false;
    exchange(now);  // the inputs show the truth from the first SAFEOP cycle on
}

void Cia402Device::power_off(Instant now) {
    operational_ = false;
    for (auto& axis : axes_) {
        axis.model->advance(now);
        axis.model->power_off();
    }
}

std::uint16_t Cia402Device::refuse(ecat::sim::EsmState from, ecat::sim::EsmState to, const ecat::sim::SyncSettings& settings) {
    if (settings.sync0_active) cycle_ = settings.sync0_cycle;
    if (refused_code_ != 0 && to == refused_state_) return refused_code_;
    // 0036h: invalid SYNC0 cycle time (ETG.1000.6 table of AL status codes).
    if (to == ecat::sim::EsmState::safeop && from == ecat::sim::EsmState::preop && settings.sync0_active &&
        settings.sync0_cycle < minimum_cycle_)
        return 0x0036;
    return 0;
}

void Cia402Device::entered(ecat::sim::EsmState state, Instant) {
    const bool op = state == ecat::sim::EsmState::op;
    for (auto& axis : axes_) {
        if (operational_ && !op) axis.model->communication_lost();
        axis.model->operational(op);
    }
    operational_ = op;
}

void Cia402Device::outputs_lost(Instant) {
    for (auto& axis : axes_) axis.model->communication_lost();
    operational_ = false;
}

void Cia402Device::advance(Instant now) {
    for (auto& axis : axes_) axis.model->advance(now);
}

void Cia402Device::exchange(Instant) {
    for (auto& axis : axes_) {
        const auto& o = axis.objects;
        AxisInputs in;
        if (operational_) {  // outputs are valid in OP only
            in.control = static_cast<std::uint16_t>(value(o.control));
            in.mode = value(o.mode);
            in.target_position = value(o.target_position);
            in.target_velocity = value(o.target_velocity);
            in.target_torque = value(o.target_torque);
            in.velocity_offset = value(o.velocity_offset);
            in.torque_offset = value(o.torque_offset);
            in.probe_function = static_cast<std::uint16_t>(value(o.probe_function));
            in.maximum_velocity = value(o.maximum_velocity);
            in.probe_function = static_cast<std::uint16_t>(value(o.probe_function));
        }
        in.homing = {value(o.homing_method), static_cast<double>(value(o.homing_fast)), static_cast<double>(value(o.homing_slow)),
                     static_cast<double>(value(o.homing_acceleration))};
        in.home_offset = value(o.home_offset);
        AxisOutputs out;
        axis.model->exchange(in, cycle_, out);
        put(o.status, out.status);
        put(o.mode_display, out.mode);
        put(o.position, out.position);
        put(o.velocity, out.velocity);
        put(o.torque, out.torque);
        put(o.following_error, out.following_error);
        put(o.demand, out.demand);
        put(o.error_code, out.error_code);
        put(o.digital_inputs, out.digital_inputs);
        put(o.probe_status, out.probe_status);
        for (std::size_t i = 0; i < 2; ++i) {
            put(o.probe_rising[i], out.probe_rising[i]);
            put(o.probe_falling[i], out.probe_falling[i]);
        }
        std::int64_t detail = out.error_detail;
        if (out.error_code && detail == 0)
            for (const auto& row : alarms_)
                if (row.code == out.error_code) {
                    detail = row.detail;
                    break;
                }
        put(alarm_detail_, detail);
        announce(axis, (out.status & status_fault) != 0, out.error_code, static_cast<std::uint32_t>(detail));
    }
}

void Cia402Device::announce(OneAxis& axis, bool faulted, std::uint16_t code, std::uint32_t detail) {
    if (faulted == axis.faulted) return;
    axis.faulted = faulted;
    ecat::Emergency emergency;
    if (faulted) {
        emergency.code = code;
        emergency.error_register = error_register(code);
        // SV33-E manual table 6-19: the error's low byte, then what the panel shows.
        emergency.data[0] = static_cast<std::byte>(code & 0xFFu);
        emergency.data[1] = static_cast<std::byte>(detail & 0xFFu);
        emergency.data[2] = static_cast<std::byte>(detail >> 8 & 0xFFu);
    } else if (std::any_of(axes_.begin(), axes_.end(), [](const OneAxis& other) { return other.faulted; })) {
        return;  // 0000h says that no error is left in the device
    }
    send_emergency(emergency);
}

}  // namespace taktwerk::axes::sim
