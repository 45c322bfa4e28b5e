#pragma once
// The SDO client: reads and writes one object of a slave through its mailbox, as scripts. Expedited, normal and segmented
// transfers; no complete access yet. Service side only. Source: ETG.1000.6, reference/ethercat-masters.md section 5.
//
// One conversation at a time (the endpoint's lock). Emergencies and other messages that arrive between request and answer
// are kept or skipped, never an error. What a lost frame does:
//   lost while writing a request    it is written again with the same counter: a slave that already has it drops the repeat
//   lost while reading an answer    repeat request (SM activate bit 1) until the slave acknowledges, then read again
// Errors: sdo.abort (with the code's text), sdo.timeout, sdo.mailbox, sdo.protocol, sdo.no_mailbox, bus.no_frame, bus.no_slave.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "ecat/script/datagram_port.hpp"
#include "ecat/wire/sdo.hpp"

namespace taktwerk::ecat {

/// A slave's mailbox as the master knows it. Outlives the scripts that use it.
struct MailboxEndpoint {
    std::string subject;  ///< for messages: "slave 2 'y' (sv33-e)"
    std::uint16_t station = 0;
    std::uint16_t out_start = 0, out_size = 0;  ///< master -> slave
    std::uint16_t in_start = 0, in_size = 0;    ///< slave -> master; size 0: no mailbox
    std::uint8_t out_sm = 0, in_sm = 1;
    std::uint8_t counter = 0;    ///< of the last request
    bool repeat_toggle = false;  ///< repeat request bit as last written
    ScriptLock lock;
    std::vector<Emergency> emergencies;  ///< received, oldest first, at most emergency_limit
    static constexpr std::size_t emergency_limit = 32;

    /// Power cycle or INIT: counters start again.
    void reset() noexcept {
        counter = 0;
        repeat_toggle = false;
    }
};

/// From writing a request until its answer must be there. SV33-E manual 6.2.8: "takes some time", not quantified.
inline constexpr Duration sdo_timeout = std::chrono::seconds{2};
/// Between two looks at the mailbox state.
inline constexpr Duration mailbox_poll_period = std::chrono::milliseconds{1};

[[nodiscard]] Script<Result<std::vector<std::byte>>> sdo_upload(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index,
                                                                std::uint8_t sub);
[[nodiscard]] Script<Result<void>> sdo_download(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index, std::uint8_t sub,
                                                std::vector<std::byte> data);

/// "1C12h:00"
[[nodiscard]] std::string object_text(std::uint16_t index, std::uint8_t sub);
/// The abort code in an error of code "sdo.abort", else 0.
[[nodiscard]] std::uint32_t abort_code(const Error& error) noexcept;

}  // namespace taktwerk::ecat
