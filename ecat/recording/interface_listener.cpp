#include "ecat/recording/interface_listener.hpp"

#include <linux/filter.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <time.h>

#include <array>
#include <cstring>
#include <utility>

#include "ecat/transport/network_interface.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::size_t largest = 65536;
constexpr int room_in_kernel = 16 << 20;  // a second of full frames at 10 kHz

/// Only EtherCAT's EtherType passes; a socket that is to hear what leaves must be bound to all of them.
bool only_ethercat(int socket) noexcept {
    std::array<sock_filter, 4> code{{
        {BPF_LD | BPF_H | BPF_ABS, 0, 0, 12},
        {BPF_JMP | BPF_JEQ | BPF_K, 0, 1, ethertype},
        {BPF_RET | BPF_K, 0, 0, largest},
        {BPF_RET | BPF_K, 0, 0, 0},
    }};
    const sock_fprog program{code.size(), code.data()};
    return ::setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program) == 0;
}

Duration stamp_of(msghdr& message) noexcept {
    timespec stamp{};
    for (auto* part = CMSG_FIRSTHDR(&message); part != nullptr; part = CMSG_NXTHDR(&message, part))
        if (part->cmsg_level == SOL_SOCKET && part->cmsg_type == SCM_TIMESTAMPNS) std::memcpy(&stamp, CMSG_DATA(part), sizeof stamp);
    return std::chrono::seconds{stamp.tv_sec} + std::chrono::nanoseconds{stamp.tv_nsec};
}

}  // namespace

InterfaceListener::InterfaceListener(std::string interface, Descriptor socket)
    : interface_(std::move(interface)), socket_(std::move(socket)), buffer_(std::make_unique<std::byte[]>(largest)) {}

Result<std::unique_ptr<InterfaceListener>> InterfaceListener::open(std::string_view interface) {
    const auto found = find_interface(interface);
    if (!found) return found.error();
    auto opened = open_packet_socket(interface);
    if (!opened) return std::move(opened).error();
    Descriptor socket{std::move(opened).value()};
    const int on = 1;
    if (!only_ethercat(socket.get())) return socket_error(interface, "setting the filter");
    if (::setsockopt(socket.get(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) != 0)
        return socket_error(interface, "asking for time stamps");
    // Without the privilege to pass the system's limit it is the limit.
    if (::setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUFFORCE, &room_in_kernel, sizeof room_in_kernel) != 0)
        (void)::setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &room_in_kernel, sizeof room_in_kernel);
    if (!bind_packet_socket(socket.get(), *found, ETH_P_ALL)) return socket_error(interface, "binding the packet socket");
    // At a tap the frames are addressed to others.
    packet_mreq all{};
    all.mr_ifindex = static_cast<int>(found->index);
    all.mr_type = PACKET_MR_PROMISC;
    if (::setsockopt(socket.get(), SOL_PACKET, PACKET_ADD_MEMBERSHIP, &all, sizeof all) != 0)
        return socket_error(interface, "asking for the frames of others");
    return std::unique_ptr<InterfaceListener>{new InterfaceListener{std::string{interface}, std::move(socket)}};
}

std::optional<InterfaceListener::Heard> InterfaceListener::next(Duration patience) {
    pollfd ready{socket_.get(), POLLIN, 0};
    if (::poll(&ready, 1, static_cast<int>(patience / std::chrono::milliseconds{1})) <= 0) return std::nullopt;
    sockaddr_ll from{};
    iovec data{buffer_.get(), largest};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(timespec))> control{};
    msghdr message{};
    message.msg_name = &from;
    message.msg_namelen = sizeof from;
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const auto size = ::recvmsg(socket_.get(), &message, MSG_DONTWAIT);
    if (size < 0) return std::nullopt;
    return Heard{{buffer_.get(), static_cast<std::size_t>(size)}, stamp_of(message), from.sll_pkttype == PACKET_OUTGOING};
}

std::uint64_t InterfaceListener::missed() {
    tpacket_stats counted{};
    socklen_t size = sizeof counted;
    return ::getsockopt(socket_.get(), SOL_PACKET, PACKET_STATISTICS, &counted, &size) == 0 ? counted.tp_drops : 0;
}

}  // namespace taktwerk::ecat
