#pragma once
// Where things stand: in an Ethernet frame, and from the header of a datagram on. Source: ETG.1000.4.

#include <cstddef>
#include <cstdint>

namespace taktwerk::ecat::frame_field {

inline constexpr std::size_t source = 6;  ///< Ethernet address of the sender
inline constexpr std::size_t adp = 2, ado = 4, length = 6, irq = 8;
inline constexpr std::uint8_t passed_a_slave = 0x02;  ///< in the first byte of the source: every processing unit sets it

}  // namespace taktwerk::ecat::frame_field
