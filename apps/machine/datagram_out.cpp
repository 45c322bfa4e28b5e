#include "apps/machine/datagram_out.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>
#include <utility>

namespace taktwerk::apps {

DatagramOut::DatagramOut(std::string_view address) : address_(address) {
    const bool is_one =
        address_.size() > 1 && address_.size() < sizeof(sockaddr_un::sun_path) && (address_[0] == '/' || address_[0] == '@');
    if (is_one) socket_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
}

DatagramOut::~DatagramOut() {
    if (socket_ >= 0) ::close(socket_);
}

DatagramOut::DatagramOut(DatagramOut&& other) noexcept : address_(std::move(other.address_)), socket_(std::exchange(other.socket_, -1)) {}

DatagramOut& DatagramOut::operator=(DatagramOut&& other) noexcept {
    std::swap(address_, other.address_);
    std::swap(socket_, other.socket_);
    return *this;
}

bool DatagramOut::send(std::string_view message) const noexcept {
    if (socket_ < 0) return false;
    sockaddr_un to{};
    to.sun_family = AF_UNIX;
    std::memcpy(to.sun_path, address_.data(), address_.size());
    if (address_[0] == '@') to.sun_path[0] = '\0';
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address_.size());
    return ::sendto(socket_, message.data(), message.size(), MSG_DONTWAIT | MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&to), size) ==
           static_cast<ssize_t>(message.size());
}

}  // namespace taktwerk::apps
