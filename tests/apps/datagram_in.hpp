#pragma once
// A local datagram socket as the system's service manager or journal has it: what was sent to it, in order.

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <string>
#include <vector>

namespace taktwerk::apps {

class DatagramIn {
public:
    explicit DatagramIn(std::string path) : path_(std::move(path)) {
        sockaddr_un here{};
        here.sun_family = AF_UNIX;
        std::memcpy(here.sun_path, path_.data(), path_.size());
        socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
        bound_ = ::bind(socket_, reinterpret_cast<const sockaddr*>(&here), sizeof here) == 0;
    }
    ~DatagramIn() { ::close(socket_), ::unlink(path_.c_str()); }
    DatagramIn(const DatagramIn&) = delete;
    DatagramIn& operator=(const DatagramIn&) = delete;

    [[nodiscard]] bool bound() const { return bound_; }
    [[nodiscard]] const std::string& path() const { return path_; }
    /// All that came so far.
    const std::vector<std::string>& all() {
        char bytes[65536];
        for (ssize_t size = 0; (size = ::recv(socket_, bytes, sizeof bytes, MSG_DONTWAIT)) >= 0;)
            all_.emplace_back(bytes, static_cast<std::size_t>(size));
        return all_;
    }
    bool gets(const std::string& message, std::chrono::milliseconds patience) {
        const auto end = std::chrono::steady_clock::now() + patience;
        while (count(message) == 0) {
            if (std::chrono::steady_clock::now() > end) return false;
            pollfd news{socket_, POLLIN, 0};
            ::poll(&news, 1, 20);
        }
        return true;
    }
    [[nodiscard]] std::size_t count(const std::string& message) { return static_cast<std::size_t>(std::ranges::count(all(), message)); }

private:
    std::string path_;
    int socket_ = -1;
    bool bound_ = false;
    std::vector<std::string> all_;
};

}  // namespace taktwerk::apps
