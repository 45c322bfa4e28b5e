#pragma once
// Which requests carry a device's channels: as few as the protocol's limits and the gap allow.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "modbus/tcp/device_config.hpp"

namespace taktwerk::modbus::tcp {

/// Of one request (Application Protocol V1.1b3, 6.1 to 6.4, 6.11, 6.12).
inline constexpr std::uint16_t most_registers_read = 125, most_bits_read = 2000, most_registers_written = 123, most_bits_written = 1968;

struct Request {
    bool write = false;
    Table table = Table::holding;
    std::uint16_t address = 0, count = 0;
    std::vector<std::size_t> channels;  ///< of the device; by address
};

/// The function code of a request (chapter 6).
[[nodiscard]] int function_of(const Request& request) noexcept;
/// "function 3, holding registers 10 to 11".
[[nodiscard]] std::string text_of(const Request& request);

/// The used channels of the device. Reads span up to `gap` addresses that nobody named; writes span none, and carry nothing twice. No
/// channel is cut in two. Writes come first, then by table and address. Channels end at address 65535.
[[nodiscard]] std::vector<Request> plan_requests(const DeviceConfig& device);

}  // namespace taktwerk::modbus::tcp
