#pragma once
// A Unix stream socket that carries lines. Nothing blocks: step() does what can be done now. Bounded in every direction:
// clients, line length, unread answers. Only the user of the process, the socket's group and root get in (0660). One thread, not real-time.
//
// Nobody is locked out by those who are there: when all places are taken, a connection that has been idle for long gives its place to
// the new one; where all are busy, the new one gets a place in reserve for a few seconds, and of those the oldest gives way.

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "core/time.hpp"
#include "hmi_bridge/line_handler.hpp"

namespace taktwerk::hmi {

class SocketServer {
public:
    static constexpr std::size_t max_connections = 8;
    static constexpr std::size_t max_line = 64 * 1024;
    static constexpr std::size_t max_unread =
        4 * 1024 * 1024;  ///< a client that does not read its answers is dropped; the longest one (scope_read) fits
    static constexpr std::size_t bytes_per_step = 256 * 1024;          ///< of one connection
    static constexpr std::size_t reserve = 4;                          ///< further connections, while all places are taken
    static constexpr Duration idle = std::chrono::seconds{5};          ///< so long without a line: may go for another
    static constexpr Duration reserve_stay = std::chrono::seconds{3};  ///< then a place in reserve is free again

    /// Binds `path`, replacing what a runtime that died has left behind. `log` gets one line per connection and problem.
    /// `group`: of the socket; empty: that of the process.
    /// Errors: socket.in_use (with the process that has it), socket.not_a_socket, socket.too_long, socket.bind, socket.group.
    static Result<std::unique_ptr<SocketServer>> open(const std::string& path, std::function<void(std::string_view)> log,
                                                      const std::string& group = {});
    ~SocketServer();  ///< closes everything and removes the file
    SocketServer(const SocketServer&) = delete;
    SocketServer& operator=(const SocketServer&) = delete;

    void step(Instant now, LineHandler& handler);
    /// Until there is something for step(), wake() was called, or `most` has passed.
    void wait(Duration most);
    /// Any thread.
    void wake() noexcept;
    /// Queues a line and sends what the kernel takes. Unknown connections are ignored.
    void send(ConnectionId connection, std::string_view line);
    [[nodiscard]] std::size_t connection_count() const noexcept { return connections_.size(); }
    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    /// "user 1000, group 'taktwerk' (997) and root"
    [[nodiscard]] std::string who_may_connect() const;

private:
    struct Connection {
        ConnectionId id = 0;
        int socket = -1;
        std::string in, out;
        std::size_t sent = 0;  // of out
        Instant heard{};       ///< of its last line, or of its coming
        bool in_reserve = false;
        bool skips = false;  ///< the rest of a line that is too long
        bool dead = false;
    };
    SocketServer(std::string path, int listener, int lock, int wake, std::function<void(std::string_view)> log);
    void accept_all(Instant now, LineHandler& handler);
    /// A place for one more: true when it is an ordinary one.
    bool make_room(Instant now, LineHandler& handler);
    void dismiss(Connection& connection, const Error& why);
    void remove_dead(LineHandler& handler);
    void refuse_long_line(ConnectionId connection);
    void read(Connection& connection, Instant now, LineHandler& handler);
    void flush(Connection& connection);

    std::string path_;
    int listener_, lock_, wake_;
    std::function<void(std::string_view)> log_;
    ConnectionId next_id_ = 1;
    std::vector<Connection> connections_;
};

}  // namespace taktwerk::hmi
