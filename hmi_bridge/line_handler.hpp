#pragma once
// What a socket server hands on: connections that come and go, and their lines.

#include <cstdint>
#include <string>
#include <string_view>

#include "core/time.hpp"

namespace taktwerk::hmi {

using ConnectionId = std::uint64_t;

/// The other end of a local socket, as the kernel vouches for it.
struct Peer {
    int pid = 0;
    unsigned uid = 0, gid = 0;
};

class LineHandler {
public:
    virtual ~LineHandler() = default;
    virtual void on_open(ConnectionId connection, const Peer& peer) = 0;
    /// Without its newline; of bounded length, any bytes.
    virtual void on_line(ConnectionId connection, std::string_view line, Instant now) = 0;
    virtual void on_close(ConnectionId connection) = 0;
};

}  // namespace taktwerk::hmi
