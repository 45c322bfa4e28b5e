#pragma once
// Error counters of a slave's ports, 0300h..0313h. Source: ETG.1000.4 (error counters).

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "ecat/script/datagram_port.hpp"
#include "ecat/topology/topology.hpp"

namespace taktwerk::ecat {

/// Of one port; each stops at 255.
struct PortCounters {
    std::uint8_t invalid_frames = 0;    ///< wrong checksum, seen here
    std::uint8_t rx_errors = 0;         ///< symbol errors on the wire
    std::uint8_t forwarded_errors = 0;  ///< frames that an earlier slave had marked as wrong
    std::uint8_t lost_links = 0;
    [[nodiscard]] bool clean() const noexcept { return (invalid_frames | rx_errors | forwarded_errors | lost_links) == 0; }
    /// Errors that began on the cable at this port: a frame that came damaged counts as invalid, and mostly as a symbol error, too.
    [[nodiscard]] unsigned own_errors() const noexcept {
        const unsigned arrived = invalid_frames > forwarded_errors ? invalid_frames - forwarded_errors : 0u;
        return arrived > rx_errors ? arrived : rx_errors;
    }
    friend bool operator==(const PortCounters&, const PortCounters&) = default;
};

struct SlaveCounters {
    std::array<PortCounters, ports_per_slave> ports;
    std::uint8_t processing_unit_errors = 0, pdi_errors = 0;
};

/// Nothing: it did not answer. One datagram.
[[nodiscard]] Script<std::optional<SlaveCounters>> read_port_counters(DatagramPort& port, std::uint16_t station);
/// Those of the ports of one slave begin at 0 again.
[[nodiscard]] Script<void> clear_port_counters(DatagramPort& port, std::uint16_t station);

}  // namespace taktwerk::ecat
