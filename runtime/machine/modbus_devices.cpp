#include "runtime/machine/modbus_devices.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "modbus/tcp/alarms.hpp"
#include "runtime/recording/inbox_record.hpp"

namespace taktwerk::runtime {

namespace {

using modbus::tcp::DeviceAlarm;
using modbus::tcp::Fault;

/// A device that was never heard since the machine is up has no fault yet when it is being asked for the first time.
DeviceAlarm alarm_of(const Fault& fault) noexcept {
    switch (fault.kind) {
        case Fault::Kind::refused: return DeviceAlarm::refused;
        case Fault::Kind::unreachable: return DeviceAlarm::unreachable;
        case Fault::Kind::closed: return DeviceAlarm::closed;
        case Fault::Kind::exception: return DeviceAlarm::exception;
        case Fault::Kind::bad_answer: return DeviceAlarm::wrong_answer;
        case Fault::Kind::timeout:
        case Fault::Kind::none: break;
    }
    return DeviceAlarm::silent;
}

}  // namespace

ModbusDevices::ModbusDevices(MachineBody& body, const std::vector<modbus::tcp::Exchange*>& exchanges, std::vector<Error>& errors)
    : body_(body) {
    const auto& configs = body.config.modbus;
    for (std::size_t d = 0; d < configs.size(); ++d) {
        auto* exchange = d < exchanges.size() ? exchanges[d] : nullptr;
        if (exchange == nullptr) {
            errors.push_back({"modbus.no_exchange", "modbus_tcp." + configs[d].name, "nothing was opened for this device",
                              "name its address in `host`; a program that builds the machine itself hands Machine::build an exchange for "
                              "each entry of `modbus`"});
            continue;
        }
        std::vector<OutputPlace> outputs;
        std::vector<std::int64_t> first(configs[d].channels.size());
        for (std::size_t i = 0; i < body.io.outputs().size(); ++i)
            if (const auto& point = body.io.point(IoDirection::output, i); point.beside && point.slave == configs[d].name) {
                outputs.push_back({i, point.index});
                first[point.index] = body.io.beside(i);
            }
        auto device = std::make_unique<Device>(configs[d], *exchange, std::move(first));
        device->outputs = std::move(outputs);
        const auto& requests = device->poller.requests();
        for (std::size_t i = 0; i < body.io.inputs().size(); ++i) {
            const auto& point = body.io.point(IoDirection::input, i);
            if (!point.beside || point.slave != configs[d].name) continue;
            for (std::size_t r = 0; r < requests.size(); ++r)
                if (std::ranges::find(requests[r].channels, std::size_t{point.index}) != requests[r].channels.end())
                    device->inputs.push_back({i, point.index, r});
        }
        devices_.push_back(std::move(device));
    }
}

bool ModbusDevices::replay(std::uint16_t device, std::uint16_t request, const Poller::RequestState& state) {
    if (device >= devices_.size() || request >= devices_[device]->replayed.requests.size()) return false;
    devices_[device]->replayed.requests[request] = state;
    return devices_[device]->replay_is_new = true;
}

bool ModbusDevices::replay_word(std::uint16_t device, std::uint16_t channel, std::int64_t word) {
    if (device >= devices_.size() || channel >= devices_[device]->replayed.words.size()) return false;
    devices_[device]->replayed.words[channel] = word;
    return devices_[device]->replay_is_new = true;
}

void ModbusDevices::publish_replayed() {
    for (auto& device : devices_)
        if (std::exchange(device->replay_is_new, false)) device->poller.replay(device->replayed);
}

void ModbusDevices::read() noexcept {
    for (std::size_t d = 0; d < devices_.size(); ++d) {
        auto& device = *devices_[d];
        const auto newest = device.poller.report();
        device.report = newest.value;
        if (newest.is_new && body_.recorder != nullptr) record(static_cast<std::uint16_t>(d), device);
        for (const auto& place : device.inputs) {
            const auto& state = newest.value->requests[place.request];
            const bool fresh = state.ever && body_.now - state.done <= device.poller.device().max_age;
            body_.io.take_beside(place.point, newest.value->words[place.channel], fresh);
        }
    }
}

void ModbusDevices::write() noexcept {
    for (auto& device : devices_) {
        if (device->outputs.empty()) continue;
        for (const auto& place : device->outputs) device->words[place.channel] = body_.io.beside(place.point);
        device->poller.put(device->words);
    }
}

bool ModbusDevices::too_old(const Device& device, std::size_t request) const noexcept {
    const auto& config = device.poller.device();
    const auto& state = device.report->requests[request];
    const auto from = state.ever ? std::max(state.done, *device.since) : *device.since;
    const bool written = device.poller.requests()[request].write;
    return body_.now - from > config.max_age + (written ? config.refresh : Duration{});
}

void ModbusDevices::watch() noexcept {
    for (std::size_t d = 0; d < devices_.size(); ++d) {
        auto& device = *devices_[d];
        if (device.report == nullptr) continue;
        if (!device.since) device.since = body_.now;
        const auto& requests = device.poller.requests();
        for (std::size_t r = 0; r < requests.size(); ++r) {
            if (!too_old(device, r)) continue;
            const auto& fault = device.report->requests[r].fault;
            // Who does not answer at all is asked in no particular order: only an exception is of one request.
            const bool of_request = fault.kind == Fault::Kind::exception;
            body_.raise({modbus::tcp::id(alarm_of(fault)), AlarmSource::machine, static_cast<std::uint16_t>(d),
                         static_cast<double>(fault.exception), of_request ? static_cast<double>(r) : -1},
                        modbus::tcp::device_alarms);
            break;  // one cause is one alarm
        }
    }
}

void ModbusDevices::record(std::uint16_t index, Device& device) noexcept {
    const auto& requests = device.poller.requests();
    for (std::size_t r = 0; r < requests.size(); ++r) {
        const auto& state = device.report->requests[r];
        if (std::exchange(device.recorded[r], state) == state) continue;
        record_request(*body_.recorder, body_.now, index, static_cast<std::uint16_t>(r), state);
        if (requests[r].write || state.fault) continue;
        for (const auto channel : requests[r].channels)
            record_channel(*body_.recorder, body_.now, index, static_cast<std::uint16_t>(channel), device.report->words[channel]);
    }
}

bool ModbusDevices::is_alarm(AlarmId id) noexcept { return find_alarm(modbus::tcp::device_alarms, id) != nullptr; }

std::string ModbusDevices::source(const AlarmFact& fact) const {
    return fact.index < devices_.size() ? fmt::format("Modbus device '{}'", devices_[fact.index]->poller.device().name) : "Modbus device ?";
}

std::string ModbusDevices::detail(const AlarmFact& fact) const {
    if (fact.index >= devices_.size()) return {};
    const auto& poller = devices_[fact.index]->poller;
    const auto& device = poller.device();
    auto out = device.host.empty() ? std::string(" (simulated") : fmt::format(" ({} port {}", device.host, device.port);
    out += fmt::format(", unit {}", device.unit);
    const auto r = static_cast<std::size_t>(fact.b);
    if (fact.b >= 0 && r < poller.requests().size()) out += "; " + modbus::tcp::text_of(poller.requests()[r]);
    return out + ")";
}

std::string_view ModbusDevices::words_of_exception(double code) {
    switch (static_cast<int>(code)) {
        case 1: return "Exception 1, illegal function: the device does not know this function";
        case 2: return "Exception 2, illegal data address: the device does not have one of these addresses";
        case 3: return "Exception 3, illegal data value: so many at once, or this value, it does not take";
        case 4: return "Exception 4, server device failure: it failed while it did what was asked";
        case 5: return "Exception 5, acknowledge: it wants more time than the protocol gives it";
        case 6: return "Exception 6, server device busy: it is at work on something longer";
        case 8: return "Exception 8, memory parity error";
        case 10: return "Exception 10, gateway path unavailable: the gateway is not set up for this unit";
        case 11: return "Exception 11, gateway target device failed to respond: nobody behind the gateway has this unit";
        default: return "An exception that the specification does not have";
    }
}

}  // namespace taktwerk::runtime
