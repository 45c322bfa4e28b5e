#pragma once
// How this machine's values are offered to Modbus TCP clients. Plain data.

#include <cstdint>

#include "core/time.hpp"
#include "modbus/server/listen_address.hpp"

namespace taktwerk::modbus::server {

struct ServerConfig {
    ListenAddress listen;                               ///< loopback, as long as nobody writes another
    std::uint8_t unit = 1;                              ///< 0 and 255 (no gateway) are answered, too
    Duration max_age = std::chrono::milliseconds{200};  ///< of the cycle that an answer shows; older: exception 4
    Duration idle = std::chrono::seconds{10};  ///< a client that is not answered for so long is let go, and with it what it has set
    std::uint8_t clients = 8;                  ///< at once
};

}  // namespace taktwerk::modbus::server
