#pragma once
// A network interface by its name, and a packet socket for it, each with errors that say what to do. Linux only; not real-time.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "ecat/transport/descriptor.hpp"
#include "ecat/wire/frame.hpp"

namespace taktwerk::ecat {

struct NetworkInterface {
    std::string name;
    unsigned index = 0;
    MacAddress mac{};
};

/// An Ethernet interface that is switched on. Needs no privilege. Errors: transport.no_such_interface, transport.not_ethernet,
/// transport.interface_down, transport.socket.
[[nodiscard]] Result<NetworkInterface> find_interface(std::string_view name);

/// Whole frames; receives nothing until bind_packet_socket(). Errors: transport.no_privilege, transport.socket.
[[nodiscard]] Result<Descriptor> open_packet_socket(std::string_view interface);

/// From now on it sends by `to` and receives the frames of one protocol, an ethertype, or all (ETH_P_ALL). False: errno says why.
[[nodiscard]] bool bind_packet_socket(int socket, const NetworkInterface& to, std::uint16_t protocol) noexcept;

/// Switched on, with a partner at the other end. `socket`: any. One system call.
[[nodiscard]] bool has_carrier(int socket, std::string_view interface) noexcept;
/// What it sends at most, in bytes behind the Ethernet header; nothing: it is gone. `socket`: any. One system call.
[[nodiscard]] std::optional<std::size_t> mtu_of(int socket, std::string_view interface) noexcept;

/// "network interface eth1: ..."
[[nodiscard]] Error interface_error(std::string_view code, std::string_view interface, std::string what, std::string remedy);
/// transport.socket: what the kernel says to `call`, from errno.
[[nodiscard]] Error socket_error(std::string_view interface, std::string_view call);

}  // namespace taktwerk::ecat
