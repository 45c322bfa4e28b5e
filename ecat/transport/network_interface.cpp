#include "ecat/transport/network_interface.hpp"

#include <fmt/format.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace taktwerk::ecat {

namespace {

std::string other_interfaces() {
    std::string names;
    auto* list = ::if_nameindex();
    if (list == nullptr) return names;
    for (auto* entry = list; entry->if_index != 0; ++entry) {
        if (std::string_view{entry->if_name} == "lo") continue;
        if (!names.empty()) names += ", ";
        names += entry->if_name;
    }
    ::if_freenameindex(list);
    return names;
}

ifreq request(std::string_view interface) noexcept {
    ifreq ifr{};
    std::copy_n(interface.begin(), std::min<std::size_t>(interface.size(), IFNAMSIZ - 1), ifr.ifr_name);
    return ifr;
}

}  // namespace

Error interface_error(std::string_view code, std::string_view interface, std::string what, std::string remedy) {
    return Error{std::string{code}, fmt::format("network interface {}", interface), std::move(what), std::move(remedy)};
}

Error socket_error(std::string_view interface, std::string_view call) {
    return interface_error("transport.socket", interface, fmt::format("{} failed: {}", call, std::strerror(errno)), "");
}

Result<NetworkInterface> find_interface(std::string_view name) {
    NetworkInterface found{std::string{name}, 0, {}};
    found.index = name.empty() || name.size() >= IFNAMSIZ ? 0u : ::if_nametoindex(found.name.c_str());
    if (found.index == 0) {
        const auto others = other_interfaces();
        return interface_error(
            "transport.no_such_interface", name, "there is no network interface of this name",
            others.empty() ? std::string{"no other interface exists in this network namespace"} : fmt::format("use one of: {}", others));
    }
    const Descriptor control{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
    auto ifr = request(name);
    if (::ioctl(control.get(), SIOCGIFHWADDR, &ifr) != 0) return socket_error(name, "reading the hardware address");
    if (ifr.ifr_hwaddr.sa_family != ARPHRD_ETHER)
        return interface_error("transport.not_ethernet", name, "it is not an Ethernet interface", "use a wired Ethernet port");
    std::memcpy(found.mac.data(), ifr.ifr_hwaddr.sa_data, found.mac.size());
    ifr = request(name);
    if (::ioctl(control.get(), SIOCGIFFLAGS, &ifr) != 0) return socket_error(name, "reading the flags");
    if ((ifr.ifr_flags & IFF_UP) == 0)
        return interface_error("transport.interface_down", name, "it is switched off",
                               fmt::format("switch it on: ip link set {} up", name));
    return found;
}

Result<Descriptor> open_packet_socket(std::string_view interface) {
    // Protocol 0: nothing is received until it is bound to an interface.
    Descriptor socket{::socket(AF_PACKET, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
    if (socket.get() >= 0) return socket;
    if (errno == EPERM || errno == EACCES)
        return interface_error("transport.no_privilege", interface, "raw Ethernet frames need the privilege CAP_NET_RAW",
                               "run it as a service with AmbientCapabilities=CAP_NET_RAW (docs/bus.md), or as root");
    return socket_error(interface, "opening a packet socket");
}

bool bind_packet_socket(int socket, const NetworkInterface& to, std::uint16_t protocol) noexcept {
    sockaddr_ll address{};
    address.sll_family = AF_PACKET;
    address.sll_protocol = htons(protocol);
    address.sll_ifindex = static_cast<int>(to.index);
    return ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

bool has_carrier(int socket, std::string_view interface) noexcept {
    auto ifr = request(interface);
    constexpr short both = IFF_UP | IFF_RUNNING;
    return ::ioctl(socket, SIOCGIFFLAGS, &ifr) == 0 && (ifr.ifr_flags & both) == both;
}

std::optional<std::size_t> mtu_of(int socket, std::string_view interface) noexcept {
    auto ifr = request(interface);
    if (::ioctl(socket, SIOCGIFMTU, &ifr) != 0 || ifr.ifr_mtu <= 0) return std::nullopt;
    return static_cast<std::size_t>(ifr.ifr_mtu);
}

}  // namespace taktwerk::ecat
