#pragma once
// Every door of the kernel by which the master's frames reach the port ecat0, for tests that ask the same of each.

#include <gtest/gtest.h>

#include <memory>
#include <ostream>
#include <string>
#include <utility>

#include "ecat/transport/raw_socket.hpp"
#include "ecat/transport/xdp_transport.hpp"
#include "tests/ecat/transport/veth_pair.hpp"

namespace taktwerk::ecat::test {

enum class Door { packet, xdp_stack, xdp_driver };

inline std::string door_name(const ::testing::TestParamInfo<Door>& info) {
    constexpr const char* names[] = {"AfPacket", "AfXdpBeforeTheStack", "AfXdpInTheDriver"};
    return names[static_cast<int>(info.param)];
}
inline auto every_door() { return ::testing::Values(Door::packet, Door::xdp_stack, Door::xdp_driver); }

struct OpenDoor {
    std::unique_ptr<RawSocketTransport> packet;
    std::unique_ptr<XdpTransport> xdp;
    std::string why;  ///< it did not open

    [[nodiscard]] Transport& transport() noexcept { return xdp ? static_cast<Transport&>(*xdp) : *packet; }
    void refresh() noexcept {
        if (xdp) xdp->refresh();
        else packet->refresh();
    }
    [[nodiscard]] std::uint64_t dropped() const noexcept { return packet->statistics().dropped + (xdp ? xdp->dropped() : 0); }
};

/// `why` begins with a code, as transport.no_xdp.
inline OpenDoor open_door(Door door, const Clock* clock = nullptr) {
    OpenDoor open;
    auto packet = RawSocketTransport::open("ecat0", {.clock = clock});
    if (!packet) {
        open.why = packet.error().code + ": " + packet.error().text();
        return open;
    }
    open.packet = std::move(*packet);
    if (door == Door::packet) return open;
    auto xdp = XdpTransport::open(*open.packet, door == Door::xdp_stack ? XdpProgram::Places::stack : XdpProgram::Places::driver, clock);
    if (xdp) open.xdp = std::move(*xdp);
    else open.why = xdp.error().code + ": " + xdp.error().text();
    return open;
}

/// Not permitted to this process (bpf(2) is for root of the machine alone, not for root of a namespace), or unknown to this kernel.
inline bool not_to_be_had(const OpenDoor& door) {
    return door.why.starts_with("transport.no_xdp") &&
           (door.why.find("lacks a privilege") != std::string::npos || door.why.find("built without it") != std::string::npos);
}

}  // namespace taktwerk::ecat::test
