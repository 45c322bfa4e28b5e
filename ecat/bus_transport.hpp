#pragma once
// By which door of the kernel the frames of a bus go to the network port.

#include <cstdint>

namespace taktwerk::ecat {

enum class BusTransport : std::uint8_t {
    packet,     ///< AF_PACKET: works on every port, and other programs hear what is on the bus
    xdp,        ///< AF_XDP, in the driver or else in the kernel's stack; refused where neither is to be had
    automatic,  ///< AF_XDP where the port's driver has it, else AF_PACKET, with a word
};

}  // namespace taktwerk::ecat
