#pragma once
// What `taktwerk check` says of the Modbus TCP devices that the machine asks: where they are, what goes over the wire and how often.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "modbus/tcp/device_config.hpp"

namespace taktwerk::apps {

/// Lines, each with its end; nothing without devices.
[[nodiscard]] std::string modbus_asked_text(const std::vector<modbus::tcp::DeviceConfig>& devices);
/// [{name, host, port, unit, poll_ms, timeout_ms, max_age_ms, refresh_ms, requests: [{function, write, address, count, registers}], unused}]
[[nodiscard]] nlohmann::ordered_json modbus_asked_json(const std::vector<modbus::tcp::DeviceConfig>& devices);

}  // namespace taktwerk::apps
