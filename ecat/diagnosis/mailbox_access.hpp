#pragma once
// A slave's mailbox for a tool that comes in from the side: whatever state the slave is in, and whoever set its mailbox up.
//
// In INIT the slave is taken to PREOP. In PREOP and above the mailbox stays as its sync managers say. If another master talks
// through it at the same time, answers may go to the wrong one: that is for the caller to warn of.

#include <cstdint>
#include <vector>

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// Errors: sdo.no_mailbox, bus.refused_state, bus.no_slave, ...
[[nodiscard]] Script<Result<void>> open_mailbox(Bus& bus, BusSlave& slave);
/// The same for files and Ethernet, whatever the EEPROM says of protocols; for files also in BOOT. Errors: foe.no_mailbox, ...
[[nodiscard]] Script<Result<void>> open_mailbox_for(Bus& bus, BusSlave& slave, MailboxType protocol);

/// As sdo_upload() and sdo_download(). The mailbox counter of whoever spoke before is not known, and a slave drops a message
/// with the counter it saw last: a first request without an answer is therefore asked once more with the next counter.
[[nodiscard]] Script<Result<std::vector<std::byte>>> read_object(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub,
                                                                 SdoAccess access = SdoAccess::entry);
[[nodiscard]] Script<Result<void>> write_object(Bus& bus, BusSlave& slave, std::uint16_t index, std::uint8_t sub,
                                                std::vector<std::byte> value, SdoAccess access = SdoAccess::entry);

}  // namespace taktwerk::ecat
