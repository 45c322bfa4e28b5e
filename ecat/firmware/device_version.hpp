#pragma once
// Who a slave says it is and what runs in it, to be compared before and after an update. Service side.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// What a slave says of itself. What it does not say stays empty.
struct DeviceVersion {
    Identity eeprom;                        ///< vendor, product, revision, serial of its EEPROM
    std::optional<std::uint32_t> revision;  ///< object 1018h:03
    std::string hardware, software;         ///< objects 1009h and 100Ah
    std::optional<Error> silence;           ///< why its objects could not be read
    friend bool operator==(const DeviceVersion& a, const DeviceVersion& b) {
        return a.eeprom == b.eeprom && a.revision == b.revision && a.hardware == b.hardware && a.software == b.software;
    }
};

/// Reads the EEPROM anew, and in PREOP, to which it takes the slave, its objects. Of a slave in BOOT the EEPROM alone. An error: its
/// EEPROM cannot be read; that its application does not start stands in `silence`.
[[nodiscard]] Script<Result<DeviceVersion>> read_version(Bus& bus, BusSlave& slave);

/// "revision 00010001h, software '1.0'"
[[nodiscard]] std::string text(const DeviceVersion& version);
/// "revision 00010001h -> 00010002h", one line for each that differs; empty: none does.
[[nodiscard]] std::vector<std::string> changes(const DeviceVersion& before, const DeviceVersion& after);

}  // namespace taktwerk::ecat
