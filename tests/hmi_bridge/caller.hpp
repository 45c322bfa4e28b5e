#pragma once
// One end of a connection to the control socket, which never waits: what the kernel does not take or has not got is said.

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <string>
#include <string_view>
#include <utility>

#include "tests/patience.hpp"

namespace taktwerk::hmi::test {

class Caller {
public:
    explicit Caller(const std::string& path) : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        path.copy(address.sun_path, sizeof address.sun_path - 1);
        EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    }
    ~Caller() { hang_up(); }
    Caller(Caller&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
    Caller(const Caller&) = delete;
    Caller& operator=(const Caller&) = delete;
    Caller& operator=(Caller&&) = delete;

    void hang_up() {
        if (socket_ >= 0) ::close(socket_);
        socket_ = -1;
    }
    /// As much as the kernel takes; how much that was.
    std::size_t say(std::string_view text) const {
        const auto sent = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        return sent > 0 ? static_cast<std::size_t>(sent) : 0;
    }
    /// Until the kernel takes no more of it whole.
    void flood(std::string_view text) const {
        for (Patience patience{1'000'000}; patience.lasts(say(text) == text.size());) {}
    }
    [[nodiscard]] std::string hear() const {
        std::string all(1 << 20, '\0');
        const auto got = ::recv(socket_, all.data(), all.size(), MSG_DONTWAIT);
        all.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
        return all;
    }
    [[nodiscard]] bool cut_off() const {
        char byte = 0;
        return ::recv(socket_, &byte, 1, MSG_DONTWAIT | MSG_PEEK) == 0;
    }

private:
    int socket_;
};

}  // namespace taktwerk::hmi::test
