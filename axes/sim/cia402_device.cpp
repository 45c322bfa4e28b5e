#include "axes/sim/cia402_device.hpp"

#include <algorithm>

#include "axes/port/drive_scale.hpp"
#include "axes/sim/set_if_there.hpp"

namespace taktwerk::axes::sim {

namespace {

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

Cia402Device::Cia402Device(const DriveProfile& profile, const std::vector<AxisSetup>& axes)
    : parameters_(profile),
      scale_(profile.scale),
      object_offset_(profile.object_offset),
      alarms_(profile),
      missed_(profile.missed_frames_allowed),
      refusal_(profile),
      tunnel_(profile.behaviour.parameter_tunnel),
      display_(profile.behaviour.state, axes.empty() ? std::uint16_t{0} : DriveAlarmCodes{profile}[DriveAlarmKind::communication].code),
      bus_state_address_(profile.behaviour.bus_state) {
    const DriveAlarmCodes codes{profile};
    if (!axes.empty()) missed_alarm_ = codes[DriveAlarmKind::communication], link_alarm_ = codes[DriveAlarmKind::link_changed];
    const auto shared = std::make_shared<const DriveProfile>(profile);
    for (const auto& setup : axes) {
        axes_.push_back({std::make_unique<Cia402Axis>(setup.plant, shared, setup.motor), std::make_unique<Behaviour>(profile),
                         std::make_unique<MotorBehaviour>(profile), AxisEntries(profile), EncoderOrders(profile.encoder)});
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
    held_.power_on(dictionary);
    parameters_.power_on(dictionary);
    take_scale();
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        const auto offset = static_cast<unsigned>(i * object_offset_);
        axes_[i].entries.power_on(dictionary, offset);
        axes_[i].encoder.power_on(dictionary, offset);
        axes_[i].motor->power_on(dictionary, *axes_[i].model);
        axes_[i].model->power_on(now);
        axes_[i].behaviour->power_on(dictionary, now);
        parameters_.check_settings(static_cast<unsigned>(i), *axes_[i].model);
    }
    for (auto& axis : axes_) axis.faulted = false, axis.common = 0;
    missed_.power_on(dictionary);
    alarms_.power_on(dictionary);
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
    return refusal_.code(from, to, settings);
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
    if (missed_.count(operational_)) raise_in_all(missed_alarm_);
    if (scale_changed_) take_scale();
    share_common_alarm();
    parameters_.step(now, *axes_.front().model);
    for (auto& axis : axes_) {
        axis.behaviour->exchange_due(cause_, now);
        AxisInputs in;
        axis.entries.take(in, operational_);
        axis.encoder.serve(*axis.model, in.control);
        axis.behaviour->obey(in, *axis.model);
        in.software_limits = parameters_.software_limits();
        AxisOutputs out;
        axis.model->exchange(in, cycle_, out);
        axis.behaviour->show(out, *axis.model);
        axis.entries.show(out);
        const auto detail = alarms_.show(out);
        if (&axis == &axes_.front()) {
            if ((out.status & status_fault) != 0 && !axis.faulted) display_.remember(out.error_code);
            display_.show(axis.model->powered(), out.error_code, out.error_detail);
        }
        announce(axis, (out.status & status_fault) != 0, out.error_code, static_cast<std::uint32_t>(detail));
    }
    held_.show();
    cause_ = {};
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
