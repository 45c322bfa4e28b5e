#pragma once
// The MII management of a slave controller (0510h..0515h) and the PHYs behind it, one a port: registers of a PHY are computed from the link that
// the port has. A command takes the time of its 64 clocks. Source: ETG.1000.4, ESC register description; IEEE 802.3 clause 22.

#include <array>
#include <cstdint>

#include "core/time.hpp"
#include "ecat/topology/topology.hpp"

namespace taktwerk::ecat::sim {

/// What a port's PHY is told, and what its partner can.
struct SimPhy {
    bool auto_negotiation = true;
    std::uint16_t advertised = 0x01E1;  ///< 10 and 100 Mbit, half and full
    std::uint16_t partner = 0x41E1;     ///< likewise, acknowledged; of one that does not negotiate what this end has found out
    bool partner_negotiates = true;
    bool answers = true;
};

class MiiInterface {
public:
    static constexpr Duration command_time = std::chrono::microseconds{26};  ///< 64 clocks of 2.5 MHz

    /// Bit p: port p has a PHY.
    void power_on(std::uint8_t ports) noexcept;
    /// A write to 0510h/0511h, as it came from the bus. Commands while busy are ignored.
    void control_written(std::uint16_t control, std::uint8_t address, std::uint8_t reg, std::uint16_t data, Instant now) noexcept;
    /// What 0510h reads.
    [[nodiscard]] std::uint16_t control() const noexcept;
    [[nodiscard]] std::uint16_t data() const noexcept { return data_; }
    [[nodiscard]] bool busy() const noexcept { return busy_; }
    [[nodiscard]] Instant due() const noexcept { return due_; }  ///< only when busy()
    /// The running command ends. Bit p of `links`: port p has a link.
    void complete(std::uint8_t links) noexcept;

    [[nodiscard]] SimPhy& phy(unsigned port) noexcept { return phys_[port]; }

private:
    [[nodiscard]] std::uint16_t read(unsigned port, bool link) const noexcept;

    std::array<SimPhy, ports_per_slave> phys_{};
    std::uint8_t ports_ = 0;
    std::uint8_t address_ = 0, reg_ = 0;
    std::uint16_t data_ = 0, errors_ = 0, command_ = 0;
    bool busy_ = false;
    Instant due_{};
};

}  // namespace taktwerk::ecat::sim
