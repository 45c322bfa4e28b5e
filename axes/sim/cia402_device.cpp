#include "axes/sim/cia402_device.hpp"

#include <algorithm>

#include "axes/port/drive_scale.hpp"
#include "axes/sim/object_table.hpp"
#include "axes/sim/set_if_there.hpp"

namespace taktwerk::axes::sim {

namespace {

using ecat::sim::Entry;

void take(std::span<const InputObject> table, const std::vector<Entry*>& entries, AxisInputs& in) {
    for (std::size_t i = 0; i < entries.size(); ++i)
        if (entries[i]) table[i].take(in, entries[i]->get());
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

/// Of any mode: the drive does not know yet which one will be asked for.
Duration shortest_cycle(const DriveProfile& profile) noexcept {
    Duration shortest{};
    for (const auto cycle : {profile.minimum_cycle_csp, profile.minimum_cycle_csv, profile.minimum_cycle_cst})
        if (cycle > Duration::zero() && (shortest == Duration::zero() || cycle < shortest)) shortest = cycle;
    return shortest;
}

}  // namespace

Cia402Device::Cia402Device(const DriveProfile& profile, const std::vector<AxisSetup>& axes)
    : parameters_(profile),
      scale_(profile.scale),
      homing_timeout_(profile.homing_timeout),
      clear_turns_(profile.encoder.clear_turns),
      encoder_reset_(profile.encoder.reset),
      homing_timeout_unit_(to_seconds(profile.homing_timeout_unit)),
      clear_turns_value_(profile.encoder.clear_turns_value),
      clear_turns_control_(profile.encoder.clear_turns_control),
      object_offset_(profile.object_offset),
      tunnel_(profile.behaviour.parameter_tunnel),
      display_(profile.behaviour.state, axes.empty() ? std::uint16_t{0} : DriveAlarmCodes{profile}[DriveAlarmKind::communication].code),
      bus_state_address_(profile.behaviour.bus_state),
      detail_index_(profile.alarm_detail_index),
      detail_sub_(profile.alarm_detail_sub),
      alarms_(profile.alarms),
      stops_(profile.stops.options),
      emergency_torque_(profile.stops.emergency_torque),
      minimum_cycle_(shortest_cycle(profile)),
      missed_allowed_(profile.missed_frames_allowed) {
    const DriveAlarmCodes codes{profile};
    if (!axes.empty()) missed_alarm_ = codes[DriveAlarmKind::communication], link_alarm_ = codes[DriveAlarmKind::link_changed];
    const auto shared = std::make_shared<const DriveProfile>(profile);
    for (const auto& setup : axes) {
        auto& axis = axes_.emplace_back();
        axis.model = std::make_unique<Cia402Axis>(setup.plant, shared, setup.motor);
        axis.behaviour = std::make_unique<Behaviour>(profile);
        axis.motor = std::make_unique<MotorBehaviour>(profile);
        // The motor has the encoder that the plant was measured with.
        if (scale_.encoder.index != 0) commission(axes_.size() - 1, scale_.encoder, setup.plant.counts_per_revolution);
    }
}

void Cia402Device::commission(std::size_t axis, ParameterAddress object, std::int64_t value) {
    parameters_.commission({static_cast<std::uint16_t>(object.index + axis * object_offset_), object.sub}, value);
}

/// What a turn is counts for at power-on, and whenever a gear that counts at once is written.
void Cia402Device::take_scale() noexcept {
    scale_changed_ = false;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        const auto scale = scale_of(scale_, [&](ParameterAddress object) {
            return parameters_.store().acting({static_cast<std::uint16_t>(object.index + i * object_offset_), object.sub});
        });
        if (!scale) continue;
        if (axes_[i].model->powered()) scale_changed_ = true;
        else axes_[i].model->scale(scale->value());
    }
}

void Cia402Device::power_on(ecat::sim::ObjectDictionary& dictionary, Instant now) {
    dictionary_ = &dictionary;
    for (auto& held : held_) held.entry = dictionary.find(held.index, held.sub);
    parameters_.power_on(dictionary);
    take_scale();
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        const auto at = [&](unsigned index, std::uint8_t sub) {
            return dictionary.find(static_cast<std::uint16_t>(index + i * object_offset_), sub);
        };
        const auto find = [&](auto table) {
            std::vector<Entry*> found;
            for (const auto& object : table) found.push_back(at(object.index, object.sub));
            return found;
        };
        axes_[i].commands = find(command_objects());
        axes_[i].settings = find(setting_objects());
        axes_[i].answers = find(answer_objects());
        const auto own = [&](ParameterAddress a) { return a.index ? at(a.index, a.sub) : nullptr; };
        axes_[i].homing_timeout = own(homing_timeout_);
        axes_[i].clear_turns = own(clear_turns_);
        axes_[i].encoder_reset = own(encoder_reset_);
        axes_[i].stop_values.clear();
        for (const auto& stop : stops_)
            axes_[i].stop_values.push_back(stop.object.index ? at(stop.object.index, stop.object.sub) : nullptr);
        axes_[i].emergency_torque = emergency_torque_.index ? at(emergency_torque_.index, emergency_torque_.sub) : nullptr;
        axes_[i].motor->power_on(dictionary, *axes_[i].model);
        axes_[i].model->power_on(now);
        axes_[i].behaviour->power_on(dictionary, now);
        parameters_.check_settings(static_cast<unsigned>(i), *axes_[i].model);
    }
    for (auto& axis : axes_) axis.faulted = false, axis.common = 0;
    missed_frames_ = dictionary.find(0x1C32, 0x0B);
    missed_before_ = missed_frames_ ? missed_frames_->get() : 0;
    missed_in_a_row_ = 0;
    alarm_detail_ = detail_index_ ? dictionary.find(detail_index_, detail_sub_) : nullptr;
    tunnel_.power_on(dictionary);
    display_.power_on(dictionary);
    bus_state_ = bus_state_address_.index ? dictionary.find(bus_state_address_.index, bus_state_address_.sub) : nullptr;
    operational_ = false;
    exchange(now);  // the inputs show the truth from the first SAFEOP cycle on
}

void Cia402Device::power_off(Instant now) {
    operational_ = false;
    for (auto& axis : axes_) {
        axis.model->advance(now);
        axis.model->power_off();
        axis.behaviour->operational(false, now);
    }
}

std::uint16_t Cia402Device::refuse(ecat::sim::EsmState from, ecat::sim::EsmState to, const ecat::sim::SyncSettings& settings) {
    if (settings.sync0_active) cycle_ = settings.sync0_cycle;
    for (auto& axis : axes_) axis.behaviour->synchronised(settings.sync0_active, settings.sync0_cycle);
    if (refused_code_ != 0 && to == refused_state_) return refused_code_;
    // 0036h: invalid SYNC0 cycle time (ETG.1000.6 table of AL status codes).
    if (to == ecat::sim::EsmState::safeop && from == ecat::sim::EsmState::preop && settings.sync0_active &&
        settings.sync0_cycle < minimum_cycle_)
        return 0x0036;
    return 0;
}

void Cia402Device::entered(ecat::sim::EsmState state, Instant now) {
    set_if_there(bus_state_, 10 + static_cast<std::int64_t>(state));  // SV-DA200 2.1 note 13
    const bool op = state == ecat::sim::EsmState::op;
    for (auto& axis : axes_) {
        if (operational_ && !op) axis.model->left_operational();
        axis.model->operational(op);
        axis.model->reachable(state != ecat::sim::EsmState::init);
        axis.behaviour->operational(op, now);
    }
    operational_ = op;
}

void Cia402Device::outputs_lost(Instant) {
    for (auto& axis : axes_) axis.model->communication_lost();
    operational_ = false;
}

void Cia402Device::advance(Instant now) {
    for (auto& axis : axes_) {
        axis.model->advance(now);
        axis.behaviour->watch(*axis.model, now);
    }
}

std::uint32_t Cia402Device::refuse_write(std::uint16_t index, std::uint8_t sub, std::int64_t value) {
    return parameters_.refuse(index, sub, value, axes_[parameters_.axis_of(index)].model->powered());
}

void Cia402Device::written(std::uint16_t index, std::uint8_t sub, Instant now) {
    parameters_.written(index, sub, now, *axes_[parameters_.axis_of(index)].model);
    take_scale();
    tunnel_.written(index, sub);
}

void Cia402Device::exchange(Instant now) {
    count_missed_frames();
    if (scale_changed_) take_scale();
    share_common_alarm();
    parameters_.step(now, *axes_.front().model);
    for (auto& axis : axes_) {
        axis.behaviour->exchange_due(cause_, now);
        AxisInputs in;
        if (operational_) take(command_objects(), axis.commands, in);
        take(setting_objects(), axis.settings, in);
        if (axis.homing_timeout) in.homing.time_limit = static_cast<double>(axis.homing_timeout->get()) * homing_timeout_unit_;
        serve_encoder(axis, in.control);
        for (std::size_t i = 0; i < axis.stop_values.size() && i < most_stop_options; ++i)
            if (axis.stop_values[i]) in.stop_values[i] = axis.stop_values[i]->get();
        if (axis.emergency_torque) in.emergency_torque = axis.emergency_torque->get();
        axis.behaviour->obey(in, *axis.model);
        in.software_limits = parameters_.software_limits();
        AxisOutputs out;
        axis.model->exchange(in, cycle_, out);
        axis.behaviour->show(out, *axis.model);
        for (std::size_t i = 0; i < axis.answers.size(); ++i) set_if_there(axis.answers[i], answer_objects()[i].value(out));
        std::int64_t detail = out.error_detail;
        if (out.error_code && detail == 0)
            for (const auto& row : alarms_)
                if (row.code == out.error_code) {
                    detail = row.detail;
                    break;
                }
        set_if_there(alarm_detail_, detail);
        if (&axis == &axes_.front()) {
            if ((out.status & status_fault) != 0 && !axis.faulted) display_.remember(out.error_code);
            display_.show(axis.model->powered(), out.error_code, out.error_detail);
        }
        announce(axis, (out.status & status_fault) != 0, out.error_code, static_cast<std::uint32_t>(detail));
    }
    for (const auto& held : held_) set_if_there(held.entry, held.value);
    cause_ = {};
}

void Cia402Device::hold(std::uint16_t index, std::uint8_t sub, std::int64_t value) {
    for (auto& held : held_)
        if (held.index == index && held.sub == sub) {
            held.value = value;
            return;
        }
    held_.push_back({index, sub, value, dictionary_ ? dictionary_->find(index, sub) : nullptr});
}

void Cia402Device::serve_encoder(OneAxis& axis, std::uint16_t control) {
    const bool asked = (control & clear_turns_control_) != 0;
    if (asked && !axis.clear_asked) axis.model->clear_turns();
    axis.clear_asked = asked;
    // PA80 stays as it was written until power goes: it is never stored (TSVM 7.2.1).
    if (axis.encoder_reset && (axis.encoder_reset->get() & 1) != 0) axis.model->order_encoder_reset();
    if (!axis.clear_turns || axis.clear_turns->get() == 0) return;
    if (axis.clear_turns->get() == clear_turns_value_) axis.model->clear_turns();
    else axis.model->reset_encoder();
    axis.clear_turns->set(0);
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
