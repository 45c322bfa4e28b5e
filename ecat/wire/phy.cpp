#include "ecat/wire/phy.hpp"

#include <array>

namespace taktwerk::ecat {

namespace {

struct Ability {
    std::uint16_t bit;
    unsigned megabits;
    bool full_duplex;
};

/// IEEE 802.3 annex 28B.3: the first that both ends can is taken.
constexpr std::array<Ability, 4> by_priority{{{phy_ability::full_100, 100, true},
                                              {phy_ability::half_100, 100, false},
                                              {phy_ability::full_10, 10, true},
                                              {phy_ability::half_10, 10, false}}};

struct Maker {
    std::uint32_t code;
    std::string_view name;
};

/// Registers 2 and 3 in the makers' data sheets: DP83848 2000h 5C90h, DP83822 2000h A240h, LAN8710 0007h C0F0h, KSZ8081 0022h 1560h,
/// 88E1510 0141h 0DD0h, RTL8201 001Ch C816h, ADIN1200 0283h BC20h.
constexpr std::array<Maker, 7> makers{{{0x080017, "National Semiconductor (TI)"},
                                       {0x080028, "Texas Instruments"},
                                       {0x0001F0, "SMSC (Microchip)"},
                                       {0x000885, "Micrel (Microchip)"},
                                       {0x005043, "Marvell"},
                                       {0x000732, "Realtek"},
                                       {0x00A0EF, "Analog Devices"}}};

}  // namespace

PhyLink phy_link(const PhyRegisters& phy) noexcept {
    PhyLink link;
    link.up = (phy.status & phy_status::link) != 0;
    link.negotiates = (phy.control & phy_control::auto_negotiation) != 0;
    if (!link.up) return link;
    if (!link.negotiates) {
        link.megabits = (phy.control & phy_control::speed_100) != 0 ? 100 : 10;
        link.full_duplex = (phy.control & phy_control::full_duplex) != 0;
        return link;
    }
    link.agreed = (phy.status & phy_status::negotiated) != 0 && (phy.expansion & phy_expansion::partner_negotiates) != 0;
    const unsigned both = phy.advertised & phy.partner;
    for (const auto& ability : by_priority)
        if ((both & ability.bit) != 0) {
            link.megabits = ability.megabits;
            link.full_duplex = ability.full_duplex;
            break;
        }
    return link;
}

std::uint32_t phy_maker_code(const PhyRegisters& phy) noexcept {
    const std::uint32_t id = (std::uint32_t{phy.id1} << 16) | phy.id2;
    return id == 0 || id == 0xFFFF'FFFF ? 0 : (id >> 10) & 0x3F'FFFF;
}

std::string_view phy_maker(std::uint32_t code) noexcept {
    for (const auto& maker : makers)
        if (maker.code == code) return maker.name;
    return {};
}

}  // namespace taktwerk::ecat
