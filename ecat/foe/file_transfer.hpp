#pragma once
// Files through a slave's mailbox, as scripts. Service side only; they share the endpoint's lock with SDO transfers, in whose place they
// are while they last. What lost frames do to a message stands in ecat/mailbox/mailbox_client.hpp: each message reaches the slave once.
// Source: ETG.1000.6 (FoE).
//
// Errors: foe.refused (with the code's text and the slave's own), foe.timeout, foe.busy, foe.protocol, foe.mailbox, foe.name,
// foe.no_mailbox, bus.no_frame, bus.no_slave. Where the slave can still be told that the transfer is over, it is.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "ecat/foe/foe_step.hpp"
#include "ecat/mailbox/mailbox_client.hpp"

namespace taktwerk::ecat {

/// How far a transfer is.
struct FoeProgress {
    std::size_t bytes = 0;               ///< that are through
    std::optional<std::size_t> of{};     ///< when writing
    bool busy = false;                   ///< the slave says so; then
    std::uint16_t done = 0, entire = 0;  ///< in units of its own; entire 0: `done` is per cent
    std::string words{};                 ///< its own
};

struct FoePatience {
    /// Until an answer must be there. The standard states none; a slave that erases its flash without saying BUSY takes its time.
    Duration answer = std::chrono::seconds{20};
    /// Between BUSY and the same request again.
    Duration busy_pause = std::chrono::milliseconds{20};
    /// A slave that says BUSY without getting further is given up after it.
    Duration busy = std::chrono::minutes{5};
};

/// Larger files are not read: a slave that never ends is no file.
inline constexpr std::size_t largest_slave_file = std::size_t{64} * 1024 * 1024;

struct FoeSettings {
    FoePatience patience{};
    std::function<void(const FoeProgress&)> progress{};  ///< after each packet and each BUSY; may be empty
    std::size_t largest = largest_slave_file;            ///< of a file that is read
};

[[nodiscard]] Script<Result<std::vector<std::byte>>> read_file(DatagramPort& port, MailboxEndpoint& mailbox, FoeFile file,
                                                               FoeSettings settings);

/// How a file that was written ended.
struct FoeWritten {
    std::size_t acknowledged = 0;  ///< bytes
    bool begun = false;            ///< the slave took the request, or may have: what it held under this name may be gone
    std::optional<Error> failure;  ///< none: all of it is there
};
[[nodiscard]] Script<Result<FoeWritten>> write_file(DatagramPort& port, MailboxEndpoint& mailbox, FoeFile file,
                                                    std::vector<std::byte> content, FoeSettings settings);

/// Ends a transfer that was broken off on this side: an ERR, to which nothing comes back.
[[nodiscard]] Script<Result<void>> abandon_file(DatagramPort& port, MailboxEndpoint& mailbox);

/// The code in an error of code "foe.refused", else 0.
[[nodiscard]] std::uint32_t foe_code(const Error& error) noexcept;

}  // namespace taktwerk::ecat
