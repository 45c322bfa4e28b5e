#pragma once
// The SDO client: reads and writes objects of a slave through its mailbox, as scripts. Expedited, normal and segmented
// transfers, single entries and whole objects. Service side only. What lost frames, emergencies and busy slaves do to a
// transfer stands in mailbox_client.hpp. Source: ETG.1000.6 5.6.2, reference/ethercat-masters.md section 5.
//
// Errors: sdo.abort (with the code's text), sdo.timeout, sdo.mailbox, sdo.protocol, sdo.no_mailbox, bus.no_frame, bus.no_slave.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "ecat/mailbox/mailbox_client.hpp"
#include "ecat/script/datagram_port.hpp"
#include "ecat/wire/sdo.hpp"

namespace taktwerk::ecat {

/// What one transfer carries.
enum class SdoAccess : std::uint8_t {
    entry,     ///< the entry of that sub-index
    complete,  ///< all entries from sub-index 0 (its count as 16 bits) or 1 on, one after the other. Few slaves can.
};

[[nodiscard]] Script<Result<std::vector<std::byte>>> sdo_upload(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index,
                                                                std::uint8_t sub, SdoAccess access = SdoAccess::entry);
[[nodiscard]] Script<Result<void>> sdo_download(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index, std::uint8_t sub,
                                                std::vector<std::byte> data, SdoAccess access = SdoAccess::entry);

// A list object (assignment, mapping, any array): entries of `entry_size` bytes each, their number in sub-index 0.
// By complete access where the slave says it can; what comes back is believed only if its size fits the count, else, and
// after an abort, entry by entry (and for this slave from then on).

/// Element n is sub-index n + 1.
[[nodiscard]] Script<Result<std::vector<std::vector<std::byte>>>> sdo_upload_list(DatagramPort& port, MailboxEndpoint& mailbox,
                                                                                  std::uint16_t index, std::size_t entry_size);
/// Entry by entry this is the order that lists ask for: count to 0, entries, count to n.
[[nodiscard]] Script<Result<void>> sdo_download_list(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index,
                                                     std::vector<std::vector<std::byte>> entries);

/// "1C12h:00"
[[nodiscard]] std::string object_text(std::uint16_t index, std::uint8_t sub);
/// The abort code in an error of code "sdo.abort", else 0.
[[nodiscard]] std::uint32_t abort_code(const Error& error) noexcept;
/// For requests that a slave refused with this code: "reading 6041h:00 was refused: abort ..." and what to do about it.
[[nodiscard]] Error abort_error(const MailboxEndpoint& mailbox, const std::string& about, std::uint32_t code);

}  // namespace taktwerk::ecat
