#pragma once
// The other end of a Modbus TCP connection as bytes on a socket: no library, so that what is compared is the specification. On loopback,
// at a port that the system chooses.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace taktwerk::modbus::tcp::testing {

using RawBytes = std::vector<std::uint8_t>;

/// One client at a time. `answer` gets each frame (MBAP header and PDU) and sends what it likes.
class RawDevice {
public:
    using Answer = std::function<void(int socket, const RawBytes& frame)>;
    explicit RawDevice(Answer answer) : answer_(std::move(answer)) {
        listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t length = sizeof address;
        if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), length) == 0 && ::listen(listener_, 4) == 0 &&
            ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &length) == 0)
            port_ = ntohs(address.sin_port);
        thread_ = std::thread{[this] { serve(); }};
    }
    ~RawDevice() {
        ended_.store(true);
        thread_.join();
        ::close(listener_);
    }
    RawDevice(const RawDevice&) = delete;
    RawDevice& operator=(const RawDevice&) = delete;

    std::uint16_t port() const { return port_; }
    std::vector<RawBytes> frames() const {
        const std::lock_guard lock(mutex_);
        return frames_;
    }
    static void send(int socket, const RawBytes& bytes) { (void)!::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL); }
    /// The answer with the header that belongs to the request, and this PDU.
    static RawBytes framed(const RawBytes& request, const RawBytes& pdu) {
        RawBytes out{request[0], request[1], 0, 0, 0, static_cast<std::uint8_t>(pdu.size() + 1), request[6]};
        out.insert(out.end(), pdu.begin(), pdu.end());
        return out;
    }

private:
    bool readable(int socket) const {
        while (!ended_.load()) {
            pollfd ready{socket, POLLIN, 0};
            if (::poll(&ready, 1, 5) > 0) return true;
        }
        return false;
    }
    bool receive(int socket, RawBytes& bytes, std::size_t count) const {
        while (bytes.size() < count) {
            std::uint8_t byte = 0;
            if (!readable(socket) || ::recv(socket, &byte, 1, 0) != 1) return false;
            bytes.push_back(byte);
        }
        return true;
    }
    void serve() {
        while (readable(listener_)) {
            const int client = ::accept(listener_, nullptr, nullptr);
            for (RawBytes frame; client >= 0; frame.clear()) {
                if (!receive(client, frame, 6)) break;
                if (!receive(client, frame, 6u + frame[5])) break;
                {
                    const std::lock_guard lock(mutex_);
                    frames_.push_back(frame);
                }
                answer_(client, frame);
            }
            if (client >= 0) ::close(client);
        }
    }

    Answer answer_;
    int listener_ = -1;
    std::uint16_t port_ = 0;
    std::atomic<bool> ended_{false};
    mutable std::mutex mutex_;
    std::vector<RawBytes> frames_;
    std::thread thread_;
};

}  // namespace taktwerk::modbus::tcp::testing
