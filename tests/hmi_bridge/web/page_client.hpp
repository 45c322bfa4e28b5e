#pragma once
// What a browser does, without one: HTTP requests and a WebSocket on a plain socket (RFC 6455), written apart from the server's library. Waits are bounded.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

namespace taktwerk::hmi::web {

using PageJson = nlohmann::ordered_json;
using PageClock = std::chrono::steady_clock;

class TcpEnd {
public:
    TcpEnd() = default;
    ~TcpEnd() { close(); }
    TcpEnd(const TcpEnd&) = delete;
    TcpEnd& operator=(const TcpEnd&) = delete;

    /// `receive_buffer`: bytes that the kernel keeps for it, 0: as many as it likes.
    bool open(std::uint16_t port, int receive_buffer = 0) {
        close();
        fd_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (receive_buffer > 0) ::setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
        const int yes = 1;
        ::setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(port);
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        return ::connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
    }
    void close() {
        if (fd_ >= 0) ::close(std::exchange(fd_, -1));
    }
    bool write(const std::string& bytes) const {
        std::size_t done = 0;
        while (done < bytes.size()) {
            const auto put = ::send(fd_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
            if (put <= 0) return false;
            done += static_cast<std::size_t>(put);
        }
        return true;
    }
    /// What has come, at the latest after `patience`; false when the other end has closed.
    bool read(std::string& to, std::chrono::milliseconds patience) const {
        pollfd ready{fd_, POLLIN, 0};
        if (::poll(&ready, 1, static_cast<int>(patience.count())) <= 0) return true;
        char part[65536];
        const auto got = ::recv(fd_, part, sizeof part, 0);
        if (got <= 0) return false;
        to.append(part, static_cast<std::size_t>(got));
        return true;
    }
    [[nodiscard]] bool is_open() const { return fd_ >= 0; }

private:
    int fd_ = -1;
};

struct HttpAnswer {
    int status = 0;  ///< 0: none came
    std::string head, body;

    /// The value of a header, in the letters it came in; empty: not there.
    [[nodiscard]] std::string header(const std::string& name) const {
        const auto at = head.find("\r\n" + name + ": ");
        if (at == std::string::npos) return {};
        const auto from = at + name.size() + 4;
        return head.substr(from, head.find("\r\n", from) - from);
    }
};

/// One request on a connection of its own. `headers`: whole lines behind Host, each with its line end.
inline HttpAnswer http_request(std::uint16_t port, const std::string& line, const std::string& headers = {}, const std::string& body = {},
                               std::string host = {}, std::chrono::milliseconds patience = std::chrono::seconds{5}) {
    TcpEnd end;
    HttpAnswer answer;
    if (!end.open(port)) return answer;
    if (host.empty()) host = "127.0.0.1:" + std::to_string(port);
    auto request = line + " HTTP/1.1\r\nHost: " + host + "\r\n" + headers;
    if (!body.empty()) request += "Content-Length: " + std::to_string(body.size()) + "\r\n";
    end.write(request + "Connection: close\r\n\r\n" + body);
    std::string got;
    for (const auto until = PageClock::now() + patience; PageClock::now() < until && end.read(got, std::chrono::milliseconds{50});) {}
    const auto split = got.find("\r\n\r\n");
    if (split == std::string::npos || got.size() < 12) return answer;
    answer.head = got.substr(0, split + 2);
    answer.body = got.substr(split + 4);
    answer.status = std::stoi(got.substr(9, 3));
    return answer;
}

class PageClient {
public:
    /// `headers`: whole lines more, e.g. a cookie. False: no WebSocket, status() says why.
    bool open(std::uint16_t port, const std::string& headers = {}, int receive_buffer = 0) {
        const auto host = "127.0.0.1:" + std::to_string(port);
        return open_as(port, host, "http://" + host, headers, receive_buffer);
    }
    bool open_as(std::uint16_t port, const std::string& host, const std::string& origin, const std::string& headers = {},
                 int receive_buffer = 0) {
        in_.clear();
        closed_ = false;
        if (!end_.open(port, receive_buffer)) return false;
        end_.write("GET /ws HTTP/1.1\r\nHost: " + host + "\r\nOrigin: " + origin +
                   "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                   "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                   headers + "\r\n");
        for (const auto until = PageClock::now() + std::chrono::seconds{5}; PageClock::now() < until;) {
            if (!end_.read(in_, std::chrono::milliseconds{50})) break;
            const auto split = in_.find("\r\n\r\n");
            if (split == std::string::npos) continue;
            status_ = std::stoi(in_.substr(9, 3));
            // The key's answer as in section 1.3 of the RFC.
            const bool good = status_ == 101 && in_.find("s3pPLMBiTxaQ9kYGzzhZRbK+xOo=") != std::string::npos;
            in_.erase(0, split + 4);
            return good;
        }
        return false;
    }
    void close() { end_.close(); }
    [[nodiscard]] int status() const { return status_; }

    bool say(const PageJson& message) { return say_text(message.dump()); }
    bool say_text(const std::string& text) { return end_.write(frame(0x81, text)); }
    bool say_bytes(const std::string& bytes) const { return end_.write(bytes); }
    /// A command, with the next id and the time of now; its id.
    std::int64_t command(PageJson message) {
        message["type"] = "command";
        message["id"] = ++id_;
        if (!message.contains("sent_ms")) message["sent_ms"] = now_ms();
        say(message);
        return id_;
    }
    /// A command and its answer; null: none came.
    PageJson ask(PageJson message, std::chrono::milliseconds patience = std::chrono::seconds{5}) {
        const auto id = command(std::move(message));
        return next([id](const PageJson& one) { return one.value("type", "") == "answer" && one.value("id", std::int64_t{0}) == id; },
                    patience);
    }
    /// The next message of a type; null: none came in time, or the server has closed.
    PageJson next(const std::string& type, std::chrono::milliseconds patience = std::chrono::seconds{5}) {
        return next([&type](const PageJson& one) { return one.value("type", "") == type; }, patience);
    }
    PageJson next(const std::function<bool(const PageJson&)>& wanted, std::chrono::milliseconds patience) {
        const auto until = PageClock::now() + patience;
        while (true) {
            while (auto text = next_frame()) {
                auto message = PageJson::parse(*text, nullptr, false);
                if (message.is_object() && wanted(message)) return message;
            }
            const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - PageClock::now());
            if (closed_ || left.count() <= 0) return {};
            if (!end_.read(in_, std::min(left, std::chrono::milliseconds{50}))) closed_ = true;
        }
    }
    /// Reads until the server has closed.
    bool is_closed(std::chrono::milliseconds patience) {
        (void)next([](const PageJson&) { return false; }, patience);
        return closed_;
    }
    static double now_ms() { return std::chrono::duration<double, std::milli>(PageClock::now().time_since_epoch()).count(); }
    /// A masked frame of the client, RFC 6455 section 5.2.
    static std::string frame(std::uint8_t first, const std::string& text) {
        std::string out(1, static_cast<char>(first));
        const auto size = text.size();
        if (size < 126) out += static_cast<char>(0x80 | size);
        else if (size < 65536) {
            out += static_cast<char>(0x80 | 126);
            for (int shift = 8; shift >= 0; shift -= 8) out += static_cast<char>((size >> shift) & 255);
        } else {
            out += static_cast<char>(0x80 | 127);
            for (int shift = 56; shift >= 0; shift -= 8) out += static_cast<char>((size >> shift) & 255);
        }
        const char mask[4] = {0x12, 0x34, 0x56, 0x78};
        out.append(mask, 4);
        for (std::size_t i = 0; i < size; ++i) out += static_cast<char>(text[i] ^ mask[i % 4]);
        return out;
    }

private:
    std::optional<std::string> next_frame() {
        while (true) {
            if (in_.size() < 2) return std::nullopt;
            const auto byte = [this](std::size_t i) { return static_cast<std::uint8_t>(in_[i]); };
            const int opcode = byte(0) & 15;
            std::size_t size = byte(1) & 127, at = 2;
            if (size == 126 || size == 127) {
                const std::size_t bytes = size == 126 ? 2 : 8;
                if (in_.size() < 2 + bytes) return std::nullopt;
                size = 0;
                for (std::size_t i = 0; i < bytes; ++i) size = size << 8 | byte(2 + i);
                at += bytes;
            }
            if (in_.size() < at + size) return std::nullopt;
            const bool last = (byte(0) & 128) != 0;
            auto part = in_.substr(at, size);
            in_.erase(0, at + size);
            if (opcode == 8) closed_ = true;
            else if (opcode == 9) end_.write(frame(0x8a, part));
            else if (opcode <= 2) {
                text_ += part;
                if (last) return std::exchange(text_, {});
            }
        }
    }

    TcpEnd end_;
    std::string in_, text_;
    std::int64_t id_ = 0;
    int status_ = 0;
    bool closed_ = false;
};

}  // namespace taktwerk::hmi::web
