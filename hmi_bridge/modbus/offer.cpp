#include "hmi_bridge/modbus/offer.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace taktwerk::hmi {

using modbus::server::NumberType;
using modbus::server::ServedRegister;
using modbus::server::WordOrder;

namespace {

std::string_view table_name(modbus::server::Table table) noexcept {
    using modbus::server::Table;
    switch (table) {
        case Table::coil: return "coil";
        case Table::discrete_input: return "discrete input";
        case Table::holding: return "holding register";
        case Table::input: break;
    }
    return "input register";
}

std::string_view type_name(NumberType type) noexcept {
    switch (type) {
        case NumberType::boolean: return "bool";
        case NumberType::uint16: return "uint16";
        case NumberType::int16: return "int16";
        case NumberType::uint32: return "uint32";
        case NumberType::int32: return "int32";
        case NumberType::float32: break;
    }
    return "float32";
}

}  // namespace

std::string reach_text(const modbus::server::ListenAddress& address) {
    switch (reach_of(address)) {
        case modbus::server::Reach::this_computer: return "this computer alone";
        case modbus::server::Reach::every_port: return "whoever reaches any address of this computer";
        case modbus::server::Reach::one_port: break;
    }
    return "whoever reaches " + address.host;
}

std::string offered_text(const ModbusServerConfig& config) {
    const auto count = config.points.size(), writable = writable_count(config);
    return fmt::format("{} {} offered over Modbus TCP at {}, unit {}, to {}; {}", count, count == 1 ? "value is" : "values are",
                       text_of(config.server.listen), config.server.unit, reach_text(config.server.listen),
                       writable == 0 ? "none may be written" : fmt::format("{} of them may be written", writable));
}

std::string place_text(const ServedRegister& place) {
    const bool bit = place.type == NumberType::boolean && !is_bits(place.table);
    if (addresses_of(place.type) == 2) return fmt::format("{}s {} and {}", table_name(place.table), place.address, place.address + 1);
    return fmt::format("{}{} {}", bit ? fmt::format("bit {} of ", place.bit) : "", table_name(place.table), place.address);
}

std::string type_text(const ServedRegister& place) {
    if (addresses_of(place.type) == 1) return std::string(type_name(place.type));
    return fmt::format("{}, {} word first", type_name(place.type), place.order == WordOrder::high_first ? "high" : "low");
}

std::size_t writable_count(const ModbusServerConfig& config) {
    return static_cast<std::size_t>(std::ranges::count_if(config.points, [](const ModbusPoint& point) { return point.place.writable; }));
}

}  // namespace taktwerk::hmi
