#pragma once
// What a socket server hands on: connections that come and go, and their lines.

#include <cstdint>
#include <string>
#include <string_view>

#include "core/time.hpp"

namespace taktwerk::hmi {

using ConnectionId = std::uint64_t;

/// Of the JSON in a line: who reads a request and who looks for a stop in it refuse what is deeper.
inline constexpr int deepest_nesting = 4;

/// The other end of a local socket, as the kernel vouches for it.
struct Peer {
    int pid = 0;
    unsigned uid = 0, gid = 0;
    bool in_reserve = false;  ///< all places were taken: it may stop and shut down, and nothing else
};

/// How a line came to be where it is judged.
struct Arrival {
    Instant at{};                             ///< when it had reached the process, at the latest guess that is safe
    std::uint64_t after = ~std::uint64_t{0};  ///< stop levels raised before it (runtime/stop_levels.hpp)
    bool level_raised = false;                ///< what it asks for as a level has been done already
};

class LineHandler {
public:
    virtual ~LineHandler() = default;
    virtual void on_open(ConnectionId connection, const Peer& peer) = 0;
    /// Without its newline; of bounded length, any bytes.
    virtual void on_line(ConnectionId connection, std::string_view line, Instant now) = 0;
    virtual void on_close(ConnectionId connection) = 0;
    /// All places are taken: this connection may be closed for another.
    [[nodiscard]] virtual bool may_go(ConnectionId) const { return true; }
};

/// Of the service side: lines that have waited for it.
class RequestHandler : public LineHandler {
public:
    virtual void on_request(ConnectionId connection, std::string_view line, Instant now, const Arrival& arrival) = 0;
};

}  // namespace taktwerk::hmi
