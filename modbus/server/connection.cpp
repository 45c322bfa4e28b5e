#include "modbus/server/connection.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace taktwerk::modbus::server {

namespace {

bool try_again(int error) noexcept { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

}  // namespace

Connection::~Connection() { ::close(socket_); }

bool Connection::receive() {
    if (size_ == bytes_.size()) return true;
    const auto count = ::recv(socket_, bytes_.data() + size_, bytes_.size() - size_, 0);
    if (count > 0) size_ += static_cast<std::size_t>(count);
    return count > 0 || (count < 0 && try_again(errno));
}

void Connection::drop(const Frame& frame) noexcept {
    std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(frame.bytes), bytes_.begin() + static_cast<std::ptrdiff_t>(size_),
              bytes_.begin());
    size_ -= frame.bytes;
}

bool Connection::send(Instant now) {
    while (sending()) {
        const auto count = ::send(socket_, out_.bytes.data() + sent_, out_.size - sent_, MSG_NOSIGNAL);
        if (count < 0) return try_again(errno);
        sent_ += static_cast<std::size_t>(count);
    }
    answered_ = now;
    return true;
}

}  // namespace taktwerk::modbus::server
