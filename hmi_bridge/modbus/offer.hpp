#pragma once
// What is offered over Modbus TCP, and to whom, in words.

#include <cstddef>
#include <string>

#include "hmi_bridge/modbus_server_config.hpp"

namespace taktwerk::hmi {

/// "this computer alone", "whoever reaches 192.168.1.10", "whoever reaches any address of this computer".
[[nodiscard]] std::string reach_text(const modbus::server::ListenAddress& address);
/// "12 values are offered over Modbus TCP at 127.0.0.1:502, unit 1, to this computer alone; 2 of them may be written".
[[nodiscard]] std::string offered_text(const ModbusServerConfig& config);
/// "holding registers 4 and 5", "coil 0", "bit 3 of input register 7".
[[nodiscard]] std::string place_text(const modbus::server::ServedRegister& place);
/// "uint16", "float32, low word first"; of a bit "bool".
[[nodiscard]] std::string type_text(const modbus::server::ServedRegister& place);
[[nodiscard]] std::size_t writable_count(const ModbusServerConfig& config);

}  // namespace taktwerk::hmi
