#include "ecat/transport/xdp_transport.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <utility>

#include "ecat/transport/network_interface.hpp"

namespace taktwerk::ecat {

Result<std::unique_ptr<XdpTransport>> XdpTransport::open(RawSocketTransport& beside, XdpProgram::Places places, const Clock* clock) {
    const auto found = find_interface(beside.interface());
    if (!found) return found.error();
    auto program = XdpProgram::load(found->name);
    if (!program) return std::move(program).error();
    auto socket = XdpSocket::open(found->name, found->index);
    if (!socket) return std::move(socket).error();
    if (!program->hand_to((*socket)->descriptor())) return no_xdp(found->name, "putting its socket into the map", errno);
    // Last: until here frames went to the packet socket.
    const auto place = program->attach(found->index, places);
    if (!place) return place.error();
    std::unique_ptr<XdpTransport> transport{new XdpTransport{beside, std::move(*socket), std::move(*program), *place}};
    transport->clock_ = clock;
    transport->refresh();
    transport->beside_before_ = beside.statistics().received;
    return transport;
}

bool XdpTransport::send(std::span<const std::byte> frame, Instant /*now*/) noexcept {
    // The kernel looks after the MTU of a packet socket's frames only.
    if (frame.size() > longest_.load(std::memory_order_relaxed)) return false;
    if (clock_ != nullptr) departed_ = clock_->now();
    return socket_->send(frame);
}

std::optional<ReceivedFrame> XdpTransport::receive(std::span<std::byte> buffer, Instant now) noexcept {
    const auto arrived = socket_->receive(buffer);
    if (!arrived) return beside_.receive(buffer, now);
    constexpr Duration most_ahead = std::chrono::milliseconds{5}, most_behind = std::chrono::seconds{1};
    const Instant at{Duration{arrived->stamp_ns}};  // in virtual time it is far away
    return ReceivedFrame{arrived->size, at <= now + most_ahead && at >= now - most_behind ? at : now};
}

void XdpTransport::refresh() noexcept {
    beside_.refresh();
    dropped_ = socket_->dropped();
    if (const auto mtu = mtu_of(beside_.descriptor(), beside_.interface()))
        longest_.store(*mtu + ethernet_header_size, std::memory_order_relaxed);
}

std::string XdpTransport::news() {
    if (said_passed_by_ || passed_by() == 0) return {};
    said_passed_by_ = true;
    return fmt::format(
        "{0}: frames come past queue 0, the only one that AF_XDP hears here, or with a VLAN tag; they are taken from a packet socket. Let "
        "the card "
        "use one queue: ethtool -L {0} combined 1",
        beside_.interface());
}

std::string XdpTransport::text() const {
    return place_ == XdpProgram::Place::driver
               ? "AF_XDP in the driver, copying, queue 0; others on this computer do not hear the bus"
               : "AF_XDP before the stack, copying, queue 0: this driver has none of its own; others on this computer do not hear the bus";
}

}  // namespace taktwerk::ecat
