#include "apps/machine/modbus_offer.hpp"

#include <algorithm>
#include <string_view>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "hmi_bridge/modbus/offer.hpp"

namespace taktwerk::apps {

namespace {

using Json = nlohmann::ordered_json;
using hmi::ModbusPoint;
using modbus::server::Table;

/// Tables in the order of their functions, addresses counting up.
std::vector<const ModbusPoint*> by_address(const hmi::ModbusServerConfig& config) {
    std::vector<const ModbusPoint*> out;
    for (const auto& point : config.points) out.push_back(&point);
    std::ranges::stable_sort(out, [](const ModbusPoint* a, const ModbusPoint* b) {
        const auto key = [](const ModbusPoint& p) { return std::tuple(p.place.table, p.place.address, p.place.bit); };
        return key(*a) < key(*b);
    });
    return out;
}

std::string unit_of(const ModbusPoint& point, const hmi::ShownNames& names) {
    const auto bound = hmi::bind(point.shows, names);
    return bound ? bound->unit : std::string{};
}

std::string scale_text(const ModbusPoint& point, const std::string& unit) {
    if (!point.scaled) return unit.empty() ? std::string{} : ", in " + unit;
    std::string out = fmt::format(", 1 in the register is {:g}{}{}", 1 / point.factor, unit.empty() ? "" : " ", unit);
    if (point.offset != 0) out += fmt::format(", 0 is {:g}{}{}", -point.offset / point.factor, unit.empty() ? "" : " ", unit);
    return out;
}

std::string_view table_word(Table table) noexcept {
    switch (table) {
        case Table::coil: return "coil";
        case Table::discrete_input: return "discrete_input";
        case Table::holding: return "holding";
        case Table::input: break;
    }
    return "input";
}

}  // namespace

std::string modbus_offer_text(const hmi::ModbusServerConfig& config, const hmi::ShownNames& names) {
    auto out = hmi::offered_text(config) + ".\n";
    for (const auto* point : by_address(config)) {
        const auto unit = unit_of(*point, names);
        out += fmt::format("  {:<26} {:<24} {}: {}{}{}\n", hmi::place_text(point->place), hmi::type_text(point->place), point->place.name,
                           hmi::text_of(point->shows), scale_text(*point, unit), point->place.writable ? "; MAY BE WRITTEN" : "");
    }
    if (hmi::writable_count(config) > 0)
        out +=
            "  Whoever reaches that address may write them: Modbus knows no users. An output becomes safe when the client goes that has "
            "set it.\n";
    return out;
}

Json modbus_offer_json(const hmi::ModbusServerConfig& config, const hmi::ShownNames& names) {
    const auto& server = config.server;
    Json out{{"listen", text_of(server.listen)},
             {"reach", hmi::reach_text(server.listen)},
             {"unit", server.unit},
             {"max_age_ms", to_seconds(server.max_age) * 1e3},
             {"idle_s", to_seconds(server.idle)},
             {"clients", server.clients}};
    auto& points = out["points"] = Json::array();
    for (const auto* point : by_address(config)) {
        const auto& place = point->place;
        Json one{{"name", place.name},
                 {"table", table_word(place.table)},
                 {"address", place.address},
                 {"addresses", addresses_of(place.type)},
                 {"type", hmi::type_text(place)},
                 {"shows", hmi::text_of(point->shows)},
                 {"unit", unit_of(*point, names)},
                 {"factor", point->factor},
                 {"offset", point->offset},
                 {"writable", place.writable}};
        if (place.type == modbus::server::NumberType::boolean && !is_bits(place.table)) one["bit"] = place.bit;
        points.push_back(std::move(one));
    }
    return out;
}

}  // namespace taktwerk::apps
