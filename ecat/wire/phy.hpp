#pragma once
// The way to a slave's Ethernet PHYs (MII management, 0510h), their registers (IEEE 802.3, clause 22), and what these say of a link.
// Pure. Real-time safe.

#include <cstdint>
#include <optional>
#include <string_view>

namespace taktwerk::ecat {

/// Bits of reg::mii_control.
namespace mii {
inline constexpr std::uint16_t write_enable = 1u << 0;
inline constexpr std::uint16_t command_mask = 3u << 8;
inline constexpr std::uint16_t read = 1u << 8;
inline constexpr std::uint16_t write = 2u << 8;
inline constexpr std::uint16_t read_error = 1u << 13;  ///< no PHY answered
inline constexpr std::uint16_t command_error = 1u << 14;
inline constexpr std::uint16_t busy = 1u << 15;
/// Address of port 0's PHY; those of the others follow.
[[nodiscard]] constexpr std::uint8_t address_offset(std::uint16_t control) noexcept {
    return static_cast<std::uint8_t>((control >> 3) & 0x1Fu);
}
}  // namespace mii

namespace phy_reg {
inline constexpr std::uint8_t control = 0, status = 1, id1 = 2, id2 = 3, advertised = 4, partner = 5, expansion = 6;
}  // namespace phy_reg

namespace phy_control {
inline constexpr std::uint16_t full_duplex = 1u << 8, isolate = 1u << 10, power_down = 1u << 11, auto_negotiation = 1u << 12,
                               speed_100 = 1u << 13, loopback = 1u << 14;
}  // namespace phy_control

namespace phy_status {
inline constexpr std::uint16_t link = 1u << 2, remote_fault = 1u << 4, negotiated = 1u << 5;  ///< link: low once it was lost, until read
}  // namespace phy_status

/// Bits of advertised and partner.
namespace phy_ability {
inline constexpr std::uint16_t half_10 = 1u << 5, full_10 = 1u << 6, half_100 = 1u << 7, full_100 = 1u << 8;
}  // namespace phy_ability

namespace phy_expansion {
inline constexpr std::uint16_t partner_negotiates = 1u << 0;
}  // namespace phy_expansion

struct PhyRegisters {
    std::uint16_t control = 0, status = 0, id1 = 0, id2 = 0, advertised = 0, partner = 0, expansion = 0;
    friend bool operator==(const PhyRegisters&, const PhyRegisters&) = default;
};

struct PhyLink {
    bool up = false;
    unsigned megabits = 0;     ///< 0: not known, without a link
    bool full_duplex = false;  ///< of a link
    bool negotiates = false;   ///< this end does
    bool agreed = false;       ///< both ends did
    friend bool operator==(const PhyLink&, const PhyLink&) = default;
};
/// With auto-negotiation the best of what both ends can (28B.3), else what is set.
[[nodiscard]] PhyLink phy_link(const PhyRegisters& phy) noexcept;

/// The maker's 22 bits of registers 2 and 3; 0: no PHY answers there (all ones or zeros). Some makers write their OUI with the bits of each byte
/// turned round, as the IEEE has it, and some as it stands: so it is a number of its own.
[[nodiscard]] std::uint32_t phy_maker_code(const PhyRegisters& phy) noexcept;
/// Makers whose PHYs are found beside EtherCAT controllers; empty: not known here.
[[nodiscard]] std::string_view phy_maker(std::uint32_t code) noexcept;

}  // namespace taktwerk::ecat
