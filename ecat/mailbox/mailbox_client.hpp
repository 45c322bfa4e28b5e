#pragma once
// One slave's mailbox as the master uses it: a request goes in, its answer comes out, whatever comes between. What the
// messages mean is the business of ecat/coe/, ecat/foe/ and ecat/eoe/. Scripts; service side only. Source: ETG.1000.4
// (mailbox), ETG.1000.6 (CoE, FoE, EoE), SV33-E manual 6.2.8, reference/ethercat-masters.md section 5.
//
// One conversation at a time (the lock). What disturbs one:
//   lost while writing a request    it is written again with the same counter: a slave that already has it drops the repeat
//   lost while reading an answer    repeat request (SM activate bit 1) until the slave acknowledges, then read again; a slave
//                                   may repeat what was read before that: known by its counter and skipped
//   emergency                       kept with slave and time; the conversation goes on waiting
//   Ethernet of the slave (EoE)     handed on; the conversation goes on waiting
//   answer of an abandoned request  skipped
//   mailbox error 7 or 9            (no memory, in work) the mailbox is read empty and the request is made again
// A request that got no answer stays in the slave: at most max_pending of them, then a further one waits.
// Errors: sdo.timeout, sdo.mailbox, sdo.protocol (of other protocols: foe.timeout, eoe.timeout, ...), bus.no_frame, bus.no_slave.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "ecat/mailbox/emergency_log.hpp"
#include "ecat/script/datagram_port.hpp"
#include "ecat/wire/mailbox.hpp"

namespace taktwerk::ecat {

/// "Its mailbox is full" (SM status bit 3) as the cycle reads it with process data: no datagram needed to know.
struct MailboxFlag {
    const std::atomic<std::uint64_t>* word = nullptr;  ///< null: not mapped, the status is asked for
    unsigned bit = 0;
    [[nodiscard]] bool mapped() const noexcept { return word != nullptr; }
    [[nodiscard]] bool set() const noexcept { return (word->load(std::memory_order_acquire) >> bit & 1u) != 0; }
};

/// A slave's mailbox as the master knows it. Outlives the scripts that use it.
struct MailboxEndpoint {
    std::string subject;  ///< for messages: "slave 2 'y' (sv33-e)"
    std::uint16_t station = 0;
    std::uint16_t out_start = 0, out_size = 0;  ///< master -> slave
    std::uint16_t in_start = 0, in_size = 0;    ///< slave -> master; size 0: no mailbox
    std::uint8_t out_sm = 0, in_sm = 1;
    std::uint8_t max_pending = 4;  ///< messages the slave buffers
    bool complete_access = false;  ///< the slave says it can; false again after it turned out that it cannot
    MailboxFlag flag;

    std::uint8_t counter = 0;     ///< of the last request
    bool repeat_toggle = false;   ///< repeat request bit as last written
    bool repeated = false;        ///< the next message may be one that was read already
    std::uint8_t received = 0;    ///< counter of the last message from the slave
    std::uint8_t unanswered = 0;  ///< requests whose answer has not come; above 1 only after timeouts
    Instant last_written{};
    MailboxErrorDetail last_refusal = MailboxErrorDetail::none;  ///< the mailbox error in the last conversation
    ScriptLock lock;

    std::function<void(std::span<const std::byte>)> ethernet{};  ///< takes each EoE fragment that comes; empty: nobody does

    std::size_t slave = 0;                    ///< its name in the log
    EmergencyLog* log = nullptr;              ///< where its emergencies go; null: nowhere
    std::atomic<std::uint32_t> emergency{0};  ///< the last one for whoever asks from the cycle: code, register << 16; 0: none, or gone

    /// Power cycle or INIT: nothing is pending, counters start again, FMMUs are not set.
    void reset() noexcept {
        counter = 0;
        repeat_toggle = repeated = false;
        received = 0;
        unanswered = 0;
        flag = {};
        emergency.store(0, std::memory_order_relaxed);
    }
};

/// From writing a request until its answer must be there. SV33-E manual 6.2.8: "takes some time", not quantified.
inline constexpr Duration sdo_timeout = std::chrono::seconds{2};
/// Between two looks at the mailbox state at first; the pause doubles up to the longest while nothing comes.
inline constexpr Duration mailbox_poll_period = std::chrono::milliseconds{1};
inline constexpr Duration mailbox_longest_poll_period = std::chrono::milliseconds{8};
/// A request that was not answered for so long never will be: it no longer counts as pending.
inline constexpr Duration mailbox_forgets_after = std::chrono::seconds{10};

struct MailboxRequest {
    std::string about;               ///< for messages: "reading 1C12h:00"
    std::vector<std::byte> payload;  ///< the message without mailbox header
    /// Whether a message of the same protocol is the answer; others are skipped. Empty: there will be none.
    std::function<bool(std::span<const std::byte>)> answered_by{};
    MailboxType type = MailboxType::coe;
    Duration patience = sdo_timeout;  ///< until the answer must be there
};

// For whoever holds mailbox.lock. `request` outlives the script.

/// The answer: a message without mailbox header.
[[nodiscard]] Script<Result<std::vector<std::byte>>> ask(DatagramPort& port, MailboxEndpoint& mailbox, const MailboxRequest& request);
/// The next message that answers the same request: fragments of an SDO information answer, a file's packet.
[[nodiscard]] Script<Result<std::vector<std::byte>>> await_more(DatagramPort& port, MailboxEndpoint& mailbox,
                                                                const MailboxRequest& request);
/// A message that gets no answer (an SDO abort, an Ethernet fragment).
[[nodiscard]] Script<Result<void>> tell(DatagramPort& port, MailboxEndpoint& mailbox, const MailboxRequest& request);

/// Takes the lock and reads out what waits in the mailbox although nobody asked: emergencies, answers that came too late.
/// Ends when it is empty.
[[nodiscard]] Script<Result<void>> read_unasked(DatagramPort& port, MailboxEndpoint& mailbox);

/// Without end: read_unasked() whenever something waits and no conversation is going on. Where the status is not mapped the
/// slave is asked every unasked_poll_period.
[[nodiscard]] Script<void> listen(DatagramPort& port, MailboxEndpoint& mailbox);
inline constexpr Duration unasked_poll_period = std::chrono::milliseconds{100};

}  // namespace taktwerk::ecat
