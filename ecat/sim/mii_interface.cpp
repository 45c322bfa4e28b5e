#include "ecat/sim/mii_interface.hpp"

#include <utility>

#include "ecat/wire/phy.hpp"

namespace taktwerk::ecat::sim {

namespace {

/// A PHY that does not negotiate is set to what it would offer.
bool can(const SimPhy& phy, unsigned abilities) noexcept { return (phy.advertised & abilities) != 0; }

}  // namespace

void MiiInterface::power_on(std::uint8_t ports) noexcept {
    ports_ = ports;
    busy_ = false;
    errors_ = command_ = data_ = 0;
}

void MiiInterface::control_written(std::uint16_t control, std::uint8_t address, std::uint8_t reg, std::uint16_t data,
                                   Instant now) noexcept {
    if (busy_) return;
    errors_ = 0;
    command_ = static_cast<std::uint16_t>(control & mii::command_mask);
    if (command_ == 0) return;
    // The enable bit counts only in the same access as the command; 3 is none.
    if (command_ == mii::command_mask || (command_ == mii::write && (control & mii::write_enable) == 0)) {
        errors_ = mii::command_error;
        command_ = 0;
        return;
    }
    address_ = address;
    reg_ = reg;
    data_ = data;
    busy_ = true;
    due_ = now + command_time;
}

std::uint16_t MiiInterface::control() const noexcept { return static_cast<std::uint16_t>(errors_ | command_ | (busy_ ? mii::busy : 0u)); }

void MiiInterface::complete(std::uint8_t links) noexcept {
    busy_ = false;
    const bool reads = std::exchange(command_, std::uint16_t{0}) == mii::read;
    const bool there = address_ < ports_per_slave && ((ports_ >> address_) & 1u) != 0 && phys_[address_].answers;
    if (!there) errors_ = mii::read_error;
    if (!reads) return;  // nothing of a PHY is set by a master here
    data_ = there ? read(address_, ((links >> address_) & 1u) != 0) : std::uint16_t{0xFFFF};
}

std::uint16_t MiiInterface::read(unsigned port, bool link) const noexcept {
    const SimPhy& phy = phys_[port];
    const auto word = [](unsigned value) { return static_cast<std::uint16_t>(value); };
    constexpr unsigned can_do = 0x7800, extended = 0x0001, can_negotiate = 0x0008;  // 10 and 100 Mbit, half and full
    switch (reg_) {
        case phy_reg::control:
            if (phy.auto_negotiation) return phy_control::auto_negotiation | phy_control::speed_100 | phy_control::full_duplex;
            return word((can(phy, phy_ability::full_100 | phy_ability::half_100) ? phy_control::speed_100 : 0u) |
                        (can(phy, phy_ability::full_100 | phy_ability::full_10) ? phy_control::full_duplex : 0u));
        case phy_reg::status:
            return word(can_do | can_negotiate | extended | (link ? phy_status::link : 0u) |
                        (link && phy.auto_negotiation ? phy_status::negotiated : 0u));
        case phy_reg::id1: return 0x2000;  // as a DP83848
        case phy_reg::id2: return 0x5C90;
        case phy_reg::advertised: return phy.advertised;
        case phy_reg::partner: return link && phy.auto_negotiation ? phy.partner : std::uint16_t{0};
        case phy_reg::expansion: return word(link && phy.partner_negotiates ? phy_expansion::partner_negotiates : 0u);
        default: return 0;
    }
}

}  // namespace taktwerk::ecat::sim
