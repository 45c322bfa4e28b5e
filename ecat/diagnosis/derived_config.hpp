#pragma once
// A configuration from what was found, so that every diagnosis works without a machine file. Pure.

#include "ecat/bus_config.hpp"
#include "ecat/diagnosis/survey.hpp"

namespace taktwerk::ecat {

/// What a slave says of itself in its EEPROM, as a description: mailbox, sync managers, PDOs with names, clock.
[[nodiscard]] DeviceDescription describe(const SurveyedSlave& slave);

/// One entry for each slave on the cable that could be read, by position. Where `machine` names the slave and it is the device
/// expected, its description (with the names of objects) is used; else the EEPROM's. No start-up SDOs, PDOs as the slave has them.
[[nodiscard]] BusConfig derived_config(const Survey& survey, const BusConfig& machine = {});

/// Gives `bus` the surveyed slaves, in the order of `bus.config`, which is a derived_config(). For scripts without a bring-up.
void adopt(Bus& bus, const Survey& survey);

}  // namespace taktwerk::ecat
