#include "modbus/server/server.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>

namespace taktwerk::modbus::server {

namespace {

constexpr int backlog = 16;
constexpr int accepted_per_step = 16;
constexpr int send_buffer = 16 * 1024;  // some dozens of answers: a client that never reads holds no more of the kernel's memory
constexpr std::uint8_t any_unit = 255;  // of a server that is no gateway (implementation guide, chapter 4.4.2)

struct SocketAddress {
    sockaddr_storage bytes{};
    socklen_t length = sizeof(sockaddr_storage);
    sockaddr* any() noexcept { return reinterpret_cast<sockaddr*>(&bytes); }
};

bool numeric(const ListenAddress& address, SocketAddress& out) {
    addrinfo wanted{};
    wanted.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
    wanted.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &wanted, &found) != 0 || found == nullptr) return false;
    std::memcpy(&out.bytes, found->ai_addr, found->ai_addrlen);
    out.length = found->ai_addrlen;
    ::freeaddrinfo(found);
    return true;
}

ListenAddress peer_of(SocketAddress& address) {
    std::array<char, NI_MAXHOST> host{};
    std::array<char, NI_MAXSERV> port{};
    ::getnameinfo(address.any(), address.length, host.data(), host.size(), port.data(), port.size(), NI_NUMERICHOST | NI_NUMERICSERV);
    return {host.data(), static_cast<std::uint16_t>(std::strtoul(port.data(), nullptr, 10))};
}

Error cannot_listen(const ListenAddress& address, int error) {
    std::string remedy = "correct `modbus_server.listen`";
    switch (error) {
        case EACCES:
            remedy = "ports below 1024 need CAP_NET_BIND_SERVICE: give it to the service, or listen at a port above, such as 1502";
            break;
        case EADDRINUSE: remedy = "another process listens there (`ss -ltnp` names it): end it, or choose another port"; break;
        case EADDRNOTAVAIL: remedy = "no network port of this computer has this address (`ip addr` shows them): correct it"; break;
        default: break;
    }
    return {"served.listen", "modbus_server.listen", fmt::format("cannot listen at {}: {}", text_of(address), std::strerror(error)),
            remedy};
}

int milliseconds(Duration duration) noexcept { return static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(duration).count()); }

}  // namespace

Result<std::unique_ptr<Server>> Server::open(const ServerConfig& config, std::vector<ServedRegister> registers,
                                             std::function<void(std::string_view)> log) {
    SocketAddress address;
    if (!numeric(config.listen, address)) return cannot_listen(config.listen, EADDRNOTAVAIL);
    const int listener = ::socket(address.bytes.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (listener < 0) return cannot_listen(config.listen, errno);
    const int yes = 1;
    ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    // `::` is every address of this computer that is written there, and no IPv4 address beside it
    if (address.bytes.ss_family == AF_INET6) ::setsockopt(listener, IPPROTO_IPV6, IPV6_V6ONLY, &yes, sizeof yes);
    ::setsockopt(listener, SOL_SOCKET, SO_SNDBUF, &send_buffer, sizeof send_buffer);
    if (::bind(listener, address.any(), address.length) != 0 || ::listen(listener, backlog) != 0) {
        const int error = errno;
        ::close(listener);
        return cannot_listen(config.listen, error);
    }
    auto bound = config;
    SocketAddress named;
    if (::getsockname(listener, named.any(), &named.length) == 0) bound.listen.port = peer_of(named).port;
    return std::unique_ptr<Server>(new Server(bound, std::move(registers), listener, std::move(log)));
}

Server::Server(const ServerConfig& config, std::vector<ServedRegister> registers, int listener, std::function<void(std::string_view)> log)
    : config_(config),
      map_(std::move(registers)),
      listener_(listener),
      log_(std::move(log)),
      images_(ServedImage{false, {}, std::vector<RegisterWords>(map_.registers().size())}) {}

Server::~Server() { ::close(listener_); }

void Server::wait(Duration most) {
    std::vector<pollfd> ready;
    ready.reserve(connections_.size() + 1);
    if (accepting_) ready.push_back({listener_, POLLIN, 0});
    for (const auto& connection : connections_) {
        if (connection->waiting) most = std::min<Duration>(most, std::chrono::milliseconds{1});  // the verdict comes from another thread
        else ready.push_back({connection->socket(), static_cast<short>(connection->sending() ? POLLOUT : POLLIN), 0});
    }
    (void)::poll(ready.data(), ready.size(), milliseconds(most));
}

void Server::step(Instant now) {
    image_ = images_.read().value;
    accept(now);
    take_verdicts();
    const auto count = connections_.size();
    std::vector<bool> ended(count);
    for (std::size_t turn = 0; turn < count; ++turn) {
        const auto i = (first_ + turn) % count;
        ended[i] = !serve(*connections_[i], now) || too_slow(*connections_[i], now);
    }
    ++first_;
    for (auto i = count; i-- > 0;) {
        if (!ended[i]) continue;
        if (connections_[i]->has_ordered) orders_.leave(connections_[i]->number());
        connections_.erase(connections_.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

void Server::accept(Instant now) {
    accepting_ = now >= accept_again_;
    for (int i = 0; accepting_ && i < accepted_per_step; ++i) {
        SocketAddress address;
        const int socket = ::accept4(listener_, address.any(), &address.length, SOCK_NONBLOCK | SOCK_CLOEXEC);
        if (socket < 0) {
            if (errno != EMFILE && errno != ENFILE && errno != ENOBUFS && errno != ENOMEM) return;  // nobody, or one who is gone again
            accept_again_ = now + accept_pause;
            accepting_ = false;
            say(now, fmt::format("the system gives no more connections: {}", std::strerror(errno)));
            return;
        }
        const auto who = text_of(peer_of(address));
        if (connections_.size() >= config_.clients) {
            ::close(socket);
            say(now, fmt::format("{} was sent away: all {} places are taken", who, config_.clients));
            continue;
        }
        const int yes = 1;
        ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        connections_.push_back(std::make_unique<Connection>(socket, ++last_connection_, who, now));
    }
}

void Server::take_verdicts() {
    while (const auto verdict = orders_.next_verdict())
        for (auto& connection : connections_) {
            auto& waiting = connection->waiting;
            if (!waiting || waiting->order != verdict->order) continue;
            connection->answer(verdict->exception == Exception::none ? waiting->done : refusal(waiting->to, verdict->exception));
            waiting.reset();
        }
}

bool Server::serve(Connection& connection, Instant now) {
    if (connection.waiting && now - connection.waiting->since > order_patience) {
        connection.answer(refusal(connection.waiting->to, Exception::server_failure));
        connection.waiting.reset();
    }
    for (int i = 0; i < requests_per_step; ++i) {
        if (connection.sending() && !connection.send(now)) return false;
        if (connection.waiting || connection.sending()) return true;
        auto frame = connection.frame();
        if (frame.state == Frame::State::incomplete) {
            if (!connection.receive()) return false;
            frame = connection.frame();
        }
        if (frame.state == Frame::State::broken) {
            say(now, fmt::format("{} was sent away: what it sends is no Modbus TCP", connection.who()));
            return false;
        }
        if (frame.state == Frame::State::incomplete) return true;
        answer(connection, frame, now);
        connection.drop(frame);
    }
    return true;  // its last answer is still to be sent, so wait() does not
}

void Server::answer(Connection& connection, const Frame& frame, Instant now) {
    const AnswerTo to{frame.transaction, frame.unit, frame.pdu[0]};
    const auto refuse = [&](Exception exception) { connection.answer(refusal(to, exception)); };
    if (frame.unit != config_.unit && frame.unit != 0 && frame.unit != any_unit) return refuse(Exception::no_such_unit);
    const auto heard = hear(frame.pdu);
    if (heard.exception != Exception::none) return refuse(heard.exception);
    if (heard.request.writes) return order(connection, to, heard.request, now);
    const auto answered = answer_read(map_, *image_, to, heard.request);
    const bool old = answered.exception == Exception::none && !image_->fresh(now, config_.max_age);
    connection.answer(old ? refusal(to, Exception::server_failure) : answered.frame);
}

void Server::order(Connection& connection, const AnswerTo& to, const Request& request, Instant now) {
    auto asked = changes_of(map_, request);
    if (asked.exception == Exception::none && !image_->fresh(now, config_.max_age)) asked.exception = Exception::server_failure;
    if (asked.exception != Exception::none) return connection.answer(refusal(to, asked.exception));
    connection.waiting = Connection::Waiting{++last_order_, to, written(to, request), now};
    connection.has_ordered = true;
    orders_.place({last_order_, connection.number(), connection.who(), now, std::move(asked.changes)});
}

bool Server::too_slow(const Connection& connection, Instant now) const {
    return !connection.waiting && now - connection.answered() > config_.idle;
}

void Server::say(Instant now, const std::string& text) {
    if (!log_) return;
    if (said_ != Instant{} && now - said_ < between_lines) {
        ++unsaid_;
        return;
    }
    log_(unsaid_ == 0 ? text : fmt::format("{} ({} more such lines since the last one)", text, unsaid_));
    unsaid_ = 0;
    said_ = now;
}

}  // namespace taktwerk::modbus::server
