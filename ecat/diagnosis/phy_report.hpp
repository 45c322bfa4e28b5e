#pragma once
// The Ethernet PHYs of a slave, asked through its controller (0510h..0517h): is there a link at each port, how fast, agreed by both ends?
// EtherCAT wants 100 Mbit full duplex everywhere; whatever else a port has loses frames. Reads only.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "ecat/diagnosis/survey.hpp"
#include "ecat/wire/phy.hpp"

namespace taktwerk::ecat {

/// What was found out about one port.
struct PhyReport {
    unsigned port = 0;
    std::uint8_t address = 0;         ///< of the PHY
    std::optional<PhyRegisters> phy;  ///< none: no PHY answers; `trouble` says why
    std::optional<Error> trouble;     ///< phy.silent, phy.busy
    [[nodiscard]] PhyLink link() const noexcept { return phy ? phy_link(*phy) : PhyLink{}; }
};

/// Of the MII ports of a surveyed slave, or of one of them. A port on the E-bus has no PHY. An error: the slave did not answer, or its own
/// processor keeps the MII management (phy.taken).
[[nodiscard]] Script<Result<std::vector<PhyReport>>> read_phys(DatagramPort& port, const SurveyedSlave& slave, std::optional<unsigned> only,
                                                               std::string subject);

/// What is wrong with a link for EtherCAT (bus.wrong_link); nothing: it is well, or there is none. Pure.
[[nodiscard]] std::optional<Error> phy_trouble(const PhyReport& report, const std::string& subject);
/// The same in one sentence; empty: nothing.
[[nodiscard]] std::string phy_finding(const PhyReport& report);

}  // namespace taktwerk::ecat
