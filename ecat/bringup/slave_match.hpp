#pragma once
// Who on the cable is which slave of the configuration. Pure; service side.
//
// A slave is found by exactly one of position, alias and explicit device identification; then vendor and product must be those
// of its description (or of one of its `also_accepted`), and the revision must satisfy the rule. Identity is the EEPROM's: the
// object 1018h of real devices says other things (its difference is a note, see compare_identity()).

#include <memory>
#include <string>
#include <vector>

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Gives every configured slave its place, in the order of the configuration. Those of groups that come and go get none, whether they are
/// there or not: they join a bus that is in operation (hot_connect.hpp). Positions in messages are those of the configuration, which do
/// not count groups. Returns how many of those found belong to groups.
/// Errors: bus.missing_slave, bus.duplicate_alias, bus.duplicate_device_id (both positions), bus.wrong_identity (with a hint
/// where the slaves only stand in another order), bus.ambiguous, bus.unexpected_slave (ExtraSlaves::refuse), bus.sii.
[[nodiscard]] Result<std::size_t> match(const BusConfig& config, const std::vector<FoundSlave>& found,
                                        std::vector<std::unique_ptr<BusSlave>>& slaves);

/// Is this the device the configuration wants? Names expected and found. Error bus.wrong_identity.
[[nodiscard]] Result<void> check_identity(const std::string& subject, const SlaveConfig& wanted, const Identity& found);
[[nodiscard]] Result<void> check_identity(const std::string& subject, const DeviceDescription& device, const Identity& found);

/// By who it says it is, whatever else is known: never a description that leaves open whom it means.
[[nodiscard]] bool recognises(const DeviceDescription& device, const Identity& found);

/// "vendor 000007FBh product 000C0108h revision 00010001h", or that it could not be read.
[[nodiscard]] std::string found_text(const FoundSlave& slave);

}  // namespace taktwerk::ecat
