#pragma once
// What `taktwerk check` says of the machine's Modbus TCP server: what is offered, to whom, and who may write.

#include <string>

#include <nlohmann/json.hpp>

#include "hmi_bridge/modbus/shown_value.hpp"
#include "hmi_bridge/modbus_server_config.hpp"

namespace taktwerk::apps {

/// Lines, each with its end.
[[nodiscard]] std::string modbus_offer_text(const hmi::ModbusServerConfig& config, const hmi::ShownNames& names);
/// {listen, reach, unit, max_age_ms, idle_s, clients, points: [{name, table, address, count, type, word_order, bit, shows, unit, writable, ...}]}
[[nodiscard]] nlohmann::ordered_json modbus_offer_json(const hmi::ModbusServerConfig& config, const hmi::ShownNames& names);

}  // namespace taktwerk::apps
