#include "ecat/eoe/host_port.hpp"

#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

namespace taktwerk::ecat {

namespace {

Error tap_error(const std::string& name, const char* doing) {
    const int reason = errno;
    return {"eoe.tap", name, fmt::format("the interface cannot be {}: {}", doing, std::strerror(reason)),
            reason == EPERM || reason == EACCES
                ? "it needs CAP_NET_ADMIN: sudo taktwerk bus eoe ..."
                : "check its name (at most 15 characters, no space, / or %), and that no other program has it"};
}

/// Switches the interface on: what comes in while it is off is lost.
bool switch_on(const ifreq& request) {
    const Descriptor any{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
    if (any.get() < 0) return false;
    ifreq flags = request;
    if (::ioctl(any.get(), SIOCGIFFLAGS, &flags) != 0) return false;
    flags.ifr_flags = static_cast<short>(flags.ifr_flags | IFF_UP);
    return ::ioctl(any.get(), SIOCSIFFLAGS, &flags) == 0;
}

}  // namespace

Result<HostPort> HostPort::open_tap(const std::string& name) {
    // The kernel would put a number in the place of %d, and the interface would have another name than was said.
    if (name.empty() || name.size() >= IFNAMSIZ || name.find('%') != std::string::npos) return errno = EINVAL, tap_error(name, "made");
    Descriptor device{::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC)};
    if (device.get() < 0) {
        if (errno == EACCES || errno == EPERM) return tap_error(name, "made");
        return Error{"eoe.no_tap", name, fmt::format("this system has no /dev/net/tun ({})", std::strerror(errno)),
                     "load the module `tun`, or pass the device into the container"};
    }
    ifreq request{};
    name.copy(request.ifr_name, IFNAMSIZ - 1);
    request.ifr_flags = IFF_TAP | IFF_NO_PI;
    if (::ioctl(device.get(), TUNSETIFF, &request) != 0) return tap_error(name, "made");
    if (!switch_on(request)) return tap_error(name, "switched on");
    return HostPort{std::move(device)};
}

/// EBADFD of a TAP: its interface was deleted. One that is only switched off gives EIO, and may come back.
void HostPort::note_end(int reason) noexcept { gone_ = gone_ || reason == EBADFD || reason == ENODEV || reason == EPIPE; }

std::optional<std::size_t> HostPort::receive(std::span<std::byte> buffer) noexcept {
    for (;;) {
        const auto size = ::read(descriptor_.get(), buffer.data(), buffer.size());
        if (size < 0 && errno == EINTR) continue;
        if (size < 0) note_end(errno);
        if (size <= 0) return std::nullopt;
        return static_cast<std::size_t>(size);
    }
}

bool HostPort::send(std::span<const std::byte> frame) noexcept {
    for (;;) {
        const auto size = ::write(descriptor_.get(), frame.data(), frame.size());
        if (size < 0 && errno == EINTR) continue;
        if (size < 0) note_end(errno);
        return size == static_cast<ssize_t>(frame.size());
    }
}

}  // namespace taktwerk::ecat
