#include "hmi_bridge/socket/socket_server.hpp"

#include <fcntl.h>
#include <grp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "hmi_bridge/socket/answer_line.hpp"
#include "hmi_bridge/socket/peer_name.hpp"

namespace taktwerk::hmi {
namespace {

constexpr mode_t socket_mode = 0660, owner_only = 0600;
constexpr int backlog = 64;  // beyond the places: who wants to stop must not wait in front of the door

std::string reason() { return std::strerror(errno); }

/// At the start alone: it may ask the network.
Result<gid_t> group_id(const std::string& name) {
    if (const auto* found = ::getgrnam(name.c_str())) return found->gr_gid;
    return Error{"socket.group", name, "there is no group of this name", "Make it (groupadd), or correct `hmi.socket_group`."};
}

/// The lock file lives as long as the runtime and holds its pid; the kernel lets go of the lock when the runtime dies. It is the owner's alone:
/// whoever can open it, if only to read, could hold it and keep the runtime from starting.
Result<int> lock_for(const std::string& path) {
    const auto lock_path = path + ".lock";
    const int lock = ::open(lock_path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (lock < 0)
        return Error{"socket.bind", path, fmt::format("cannot make {}: {}", lock_path, reason()),
                     "Give a path in a folder that exists and that this user may write, as `socket:` in the configuration."};
    if (::flock(lock, LOCK_EX | LOCK_NB) != 0) {
        char pid[32] = {};
        const auto length = ::pread(lock, pid, sizeof pid - 1, 0);
        ::close(lock);
        return Error{"socket.in_use", path,
                     fmt::format("another runtime already serves this machine: process {}", length > 0 ? pid : "unknown"),
                     "Stop it first, or give this machine another name or `socket:`."};
    }
    // A runtime that ends removes the file: then this lock is on a file that nobody else will ever see.
    struct stat held {
    }, named{};
    if (::fstat(lock, &held) != 0 || ::stat(lock_path.c_str(), &named) != 0 || held.st_ino != named.st_ino) {
        ::close(lock);
        return Error{"socket.in_use", path, "another runtime of this machine is just ending", "Start again."};
    }
    const auto pid = std::to_string(::getpid());
    if (::ftruncate(lock, 0) != 0 || ::pwrite(lock, pid.data(), pid.size(), 0) < 0) {
        // Only the message for a second runtime would be poorer.
    }
    return lock;
}

}  // namespace

Result<std::unique_ptr<SocketServer>> SocketServer::open(const std::string& path, std::function<void(std::string_view)> log,
                                                         const std::string& group) {
    sockaddr_un address{};
    if (path.empty() || path.size() >= sizeof address.sun_path)
        return Error{"socket.too_long", path, fmt::format("a socket's path has 1 to {} characters", sizeof address.sun_path - 1),
                     "Give a shorter path as `socket:`."};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.c_str(), path.size());

    const auto owner = group.empty() ? Result<gid_t>(static_cast<gid_t>(-1)) : group_id(group);
    if (!owner) return owner.error();
    const auto lock = lock_for(path);
    if (!lock) return lock.error();
    const auto fail = [&](std::string code, std::string what, std::string remedy) {
        ::close(*lock);
        return Error{std::move(code), path, std::move(what), std::move(remedy)};
    };
    struct stat info {};
    if (::lstat(path.c_str(), &info) == 0) {
        if (!S_ISSOCK(info.st_mode))
            return fail("socket.not_a_socket", "something else already has this name", "Remove it, or give another path as `socket:`.");
        ::unlink(path.c_str());  // nobody holds the lock: left behind by a runtime that died
    }
    const int listener = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    // The mode is set on the socket before it gets a name, so that there is no moment in which others may connect; its group comes when it has
    // a name that nobody but the owner can use yet.
    const bool bound = listener >= 0 && ::fchmod(listener, owner_only) == 0 &&
                       ::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
                       (group.empty() || ::chown(path.c_str(), static_cast<uid_t>(-1), *owner) == 0) &&
                       ::chmod(path.c_str(), socket_mode) == 0 && ::listen(listener, backlog) == 0;
    const int wake = bound ? ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC) : -1;
    if (wake < 0) {
        const auto why = reason();
        if (listener >= 0) ::close(listener);
        if (bound) ::unlink(path.c_str());
        return fail("socket.bind", "cannot make the command socket: " + why,
                    "Give a path in a folder that this user may write, as `socket:` in the configuration.");
    }
    return std::unique_ptr<SocketServer>(new SocketServer(path, listener, *lock, wake, std::move(log)));
}

SocketServer::SocketServer(std::string path, int listener, int lock, int wake, std::function<void(std::string_view)> log)
    : path_(std::move(path)), listener_(listener), lock_(lock), wake_(wake), log_(std::move(log)) {
    connections_.reserve(max_connections + reserve + 1);
}

std::string SocketServer::who_may_connect() const {
    struct stat info {};
    if (::stat(path_.c_str(), &info) != 0) return "nobody";
    const auto* group = ::getgrgid(info.st_gid);
    return fmt::format("user {}, group {} and root", info.st_uid,
                       group ? fmt::format("'{}' ({})", group->gr_name, info.st_gid) : std::to_string(info.st_gid));
}

SocketServer::~SocketServer() {
    for (auto& connection : connections_) ::close(connection.socket);
    ::close(listener_);
    ::close(wake_);
    ::unlink(path_.c_str());
    ::unlink((path_ + ".lock").c_str());
    ::close(lock_);
}

void SocketServer::dismiss(Connection& connection, const Error& why) {
    const auto line = refusal_line("null", why) + "\n";
    [[maybe_unused]] const auto sent = ::send(connection.socket, line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    connection.dead = true;
}

bool SocketServer::make_room(Instant now, LineHandler& handler) {
    std::size_t ordinary = 0, reserved = 0;
    Connection *idlest = nullptr, *oldest = nullptr;
    for (auto& c : connections_) {
        if (c.dead) continue;
        if (c.in_reserve) {
            ++reserved;
            if (!oldest || c.id < oldest->id) oldest = &c;
            continue;
        }
        ++ordinary;
        const bool may = now - c.heard >= idle && handler.may_go(c.id);
        if (may && (!idlest || c.heard < idlest->heard)) idlest = &c;
    }
    if (ordinary < max_connections) return true;
    // What it has said already is still heard: a stop must not be sent away unread.
    if (auto* leaves = idlest != nullptr ? idlest : reserved >= reserve ? oldest : nullptr) read(*leaves, now, handler);
    if (idlest) {
        log_(fmt::format("command socket: a client that was idle for {:.0f} s gave its place to another", to_seconds(now - idlest->heard)));
        dismiss(*idlest, {"socket.idle", "", "all places were taken, and this client had been idle the longest: its place went to another",
                          "Connect again."});
        return true;
    }
    if (reserved >= reserve)
        dismiss(*oldest, {"socket.too_many_clients", "", "the place in reserve went to another client", "Connect again."});
    return false;
}

void SocketServer::accept_all(Instant now, LineHandler& handler) {
    for (std::size_t round = 0; round < max_connections; ++round) {
        const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
        if (socket < 0) return;
        ucred who{};
        socklen_t size = sizeof who;
        ::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &who, &size);
        const bool ordinary = make_room(now, handler);
        remove_dead(handler);
        const Peer peer{who.pid, who.uid, who.gid, !ordinary};
        Connection connection;
        connection.id = next_id_++;
        connection.socket = socket;
        connection.heard = now;
        connection.in_reserve = !ordinary;
        connections_.push_back(std::move(connection));
        log_(fmt::format(
            "command socket: {} {}", peer_name(peer),
            ordinary ? std::string("connected") : fmt::format("may only stop and shut down: {} clients are connected", max_connections)));
        handler.on_open(connections_.back().id, peer);
    }
}

// What stands behind it may be a stop: the rest of the line is passed over, and the connection stays.
void SocketServer::refuse_long_line(ConnectionId connection) {
    send(connection,
         refusal_line("null", {"request.too_long", "", fmt::format("a line is longer than {} bytes; it was not taken", max_line),
                               "Send one request a line."}));
}

void SocketServer::read(Connection& connection, Instant now, LineHandler& handler) {
    char buffer[16 * 1024];
    bool ended = false;
    while (connection.in.size() <= bytes_per_step) {
        const auto got = ::recv(connection.socket, buffer, sizeof buffer, 0);
        if (got > 0) {
            connection.in.append(buffer, static_cast<std::size_t>(got));
            continue;
        }
        ended = got == 0 || (got < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
        break;
    }
    std::size_t start = 0;
    for (auto end = connection.in.find('\n'); end != std::string::npos; end = connection.in.find('\n', start)) {
        auto line = std::string_view(connection.in).substr(start, end - start);
        start = end + 1;
        if (std::exchange(connection.skips, false)) continue;
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (line.size() > max_line) {
            refuse_long_line(connection.id);
            continue;
        }
        if (!line.empty()) {
            connection.heard = now;
            handler.on_line(connection.id, line, now);
        }
    }
    connection.in.erase(0, start);
    if (connection.in.size() > max_line || connection.skips) {
        if (!connection.skips) refuse_long_line(connection.id);
        connection.skips = true;
        connection.in.clear();
    }
    // Who closes behind a whole request has ended its line; half a line at the end is nobody's request. A NUL is what C has behind its texts.
    constexpr std::string_view behind_a_line{" \t\r\0", 4};
    if (ended) connection.in.erase(connection.in.find_last_not_of(behind_a_line) + 1);
    if (ended && connection.in.ends_with('}')) handler.on_line(connection.id, connection.in, now);
    if (ended) connection.dead = true;
}

void SocketServer::flush(Connection& connection) {
    while (!connection.out.empty()) {
        const auto rest = std::string_view(connection.out).substr(connection.sent);
        const auto sent = ::send(connection.socket, rest.data(), rest.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent > 0) {
            connection.sent += static_cast<std::size_t>(sent);
            if (connection.sent < connection.out.size()) continue;
            connection.out.clear();
            connection.sent = 0;
            continue;
        }
        if (sent < 0 && errno == EINTR) continue;
        if (sent < 0 && errno != EAGAIN && errno != EWOULDBLOCK) connection.dead = true;
        break;
    }
}

void SocketServer::send(ConnectionId id, std::string_view line) {
    const auto found = std::find_if(connections_.begin(), connections_.end(), [&](const auto& c) { return c.id == id; });
    if (found == connections_.end() || found->dead) return;
    if (found->sent > 0) {
        found->out.erase(0, found->sent);
        found->sent = 0;
    }
    if (found->out.size() + line.size() + 1 > max_unread) {
        log_("command socket: a client does not read its answers; dropped");
        found->dead = true;
        return;
    }
    found->out.append(line).push_back('\n');
    flush(*found);
}

void SocketServer::remove_dead(LineHandler& handler) {
    for (auto connection = connections_.begin(); connection != connections_.end();) {
        if (!connection->dead) {
            ++connection;
            continue;
        }
        ::close(connection->socket);
        const auto id = connection->id;
        connection = connections_.erase(connection);
        handler.on_close(id);
    }
}

void SocketServer::step(Instant now, LineHandler& handler) {
    accept_all(now, handler);
    for (auto& connection : connections_) {
        if (!connection.dead) read(connection, now, handler);
        if (!connection.dead) flush(connection);
        if (connection.in_reserve && now - connection.heard > reserve_stay) connection.dead = true;
    }
    remove_dead(handler);
}

void SocketServer::wait(Duration most) {
    std::array<pollfd, max_connections + reserve + 3> ready{};
    nfds_t count = 0;
    ready[count++] = {listener_, POLLIN, 0};
    ready[count++] = {wake_, POLLIN, 0};
    for (const auto& connection : connections_) {
        if (count == ready.size()) break;
        const auto wanted = POLLIN | (connection.out.empty() ? 0 : POLLOUT);
        ready[count++] = {connection.socket, static_cast<short>(wanted), 0};
    }
    const auto left = std::chrono::duration_cast<std::chrono::microseconds>(most).count();
    const timespec time{static_cast<time_t>(left / 1'000'000), static_cast<long>(left % 1'000'000) * 1000};
    if (::ppoll(ready.data(), count, &time, nullptr) <= 0) return;
    std::uint64_t woken = 0;
    [[maybe_unused]] const auto got = ::read(wake_, &woken, sizeof woken);
}

void SocketServer::wake() noexcept {
    constexpr std::uint64_t one = 1;
    [[maybe_unused]] const auto put = ::write(wake_, &one, sizeof one);
}

}  // namespace taktwerk::hmi
