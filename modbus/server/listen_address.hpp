#pragma once
// Where the server listens, and who reaches it there.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace taktwerk::modbus::server {

struct ListenAddress {
    std::string host = "127.0.0.1";  ///< IPv4 or IPv6, no name
    std::uint16_t port = 502;        ///< assigned by IANA; 0: the system chooses one (tests)
    friend bool operator==(const ListenAddress&, const ListenAddress&) = default;
};

/// "127.0.0.1:502", "[::1]:502". Nothing: no numeric address, or no port from 1 to 65535.
[[nodiscard]] std::optional<ListenAddress> parse_listen_address(std::string_view text);
/// The same text again.
[[nodiscard]] std::string text_of(const ListenAddress& address);

enum class Reach : std::uint8_t {
    this_computer,  ///< loopback
    one_port,       ///< whoever reaches that address
    every_port,     ///< 0.0.0.0 or ::
};
[[nodiscard]] Reach reach_of(const ListenAddress& address);

}  // namespace taktwerk::modbus::server
