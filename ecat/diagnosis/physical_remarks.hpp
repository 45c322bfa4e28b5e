#pragma once
// What is wrong with the bus as copper: currents of the E-bus, links that are not what EtherCAT needs. A bus may come up all the same, and fail
// when it gets warm.

#include <vector>

#include "ecat/diagnosis/survey.hpp"

namespace taktwerk::ecat {

/// The first terminal of each coupler whose E-bus current is more than what is left (bus.ebus_overload). Pure.
[[nodiscard]] std::vector<Error> ebus_overloads(const Survey& survey);

/// Links that are not 100 Mbit full duplex (bus.wrong_link), as the PHYs of all MII ports tell. Their management is written to: not beside
/// another master. A slave that does not let its PHYs be asked is passed over.
[[nodiscard]] Script<Result<std::vector<Error>>> wrong_links(DatagramPort& port, const Survey& survey);

}  // namespace taktwerk::ecat
