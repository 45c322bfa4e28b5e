#include "runtime/world/modbus_world.hpp"

namespace taktwerk::runtime {

ModbusWorld::ModbusWorld(const MachineConfig& config) {
    for (const auto& device : config.modbus) {
        devices_.push_back({device.name, std::make_unique<modbus::tcp::SimulatedDevice>(device)});
        for (const auto& point : config.io)
            if (point.beside && point.slave == device.name) points_.push_back({point, devices_.back().device.get()});
    }
}

std::vector<modbus::tcp::Exchange*> ModbusWorld::exchanges() const {
    std::vector<modbus::tcp::Exchange*> out;
    for (const auto& place : devices_) out.push_back(place.device.get());
    return out;
}

const ModbusWorld::Point* ModbusWorld::find(std::string_view name, IoDirection direction) const noexcept {
    for (const auto& point : points_)
        if (point.config.name == name && point.config.direction == direction) return &point;
    return nullptr;
}

bool ModbusWorld::set_input(std::string_view name, std::int64_t value) noexcept {
    const auto* point = find(name, IoDirection::input);
    if (point == nullptr) return false;
    point->device->set(point->config.index, value);
    return true;
}

bool ModbusWorld::is_single_bit(std::string_view input) const noexcept {
    const auto* point = find(input, IoDirection::input);
    return point != nullptr && point->config.beside->bits == 1;
}

std::optional<std::int64_t> ModbusWorld::output(std::string_view name) const noexcept {
    const auto* point = find(name, IoDirection::output);
    if (point == nullptr) return std::nullopt;
    return point->device->get(point->config.index);
}

modbus::tcp::SimulatedDevice* ModbusWorld::device(std::string_view name) const noexcept {
    for (const auto& place : devices_)
        if (place.name == name) return place.device.get();
    return nullptr;
}

}  // namespace taktwerk::runtime
