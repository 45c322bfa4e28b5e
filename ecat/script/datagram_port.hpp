#pragma once
// How a script speaks to the bus: one datagram, one answer.
//
//     const Reply reply = co_await port.fprd(station, reg::al_status, 2);
//     if (!reply.ok()) co_return unanswered(subject, "AL status (0130h)", reply);
//
// A lost frame is sent again (register accesses are idempotent); mailbox transfers are not and ask for a single attempt. A
// working counter of 0 is an answer: nobody took the datagram. Service side only; the frames themselves are moved by the
// cycle or by pump(), through the AcyclicChannel.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/bytes.hpp"
#include "core/result.hpp"
#include "ecat/exchange/acyclic_channel.hpp"
#include "ecat/script/script.hpp"
#include "ecat/script/waits.hpp"

namespace taktwerk::ecat {

/// How a datagram ended.
struct Reply {
    bool lost = true;   ///< no frame came back in time, after all attempts
    bool held = false;  ///< it never left: what it waited for did not come
    std::uint16_t wkc = 0;
    std::uint16_t slaves_passed = 0;  ///< AP and B commands
    std::vector<std::byte> data;
    Instant sent_at{};  ///< when the frame left
    Duration queued{};  ///< how long it stood in line before it was handed in: no time that the slave took

    /// Exactly one slave answered.
    [[nodiscard]] bool ok() const noexcept { return !lost && wkc == 1; }
    [[nodiscard]] std::uint16_t u16(std::size_t offset = 0) const noexcept { return load_le<std::uint16_t>(data, offset); }
    [[nodiscard]] std::uint32_t u32(std::size_t offset = 0) const noexcept { return load_le<std::uint32_t>(data, offset); }
    [[nodiscard]] std::uint64_t u64(std::size_t offset = 0) const noexcept { return load_le<std::uint64_t>(data, offset); }
};

/// "no answer to AL status (0130h)": the error for a Reply that is not ok().
[[nodiscard]] Error unanswered(const std::string& subject, const std::string& what, const Reply& reply);

/// What co_await gives a Reply for.
class Transfer final : public Leaf<Transfer> {
public:
    Transfer(AcyclicChannel& channel, Command command, Address address, std::vector<std::byte> data, unsigned attempts,
             const SendGate& gate = {}, std::optional<Duration> wait = {})
        : channel_(channel), command_(command), address_(address), data_(std::move(data)), attempts_(attempts), gate_(gate), wait_(wait) {}
    ~Transfer();
    Transfer(const Transfer&) = delete;
    Transfer& operator=(const Transfer&) = delete;

    /// Submits it already; await it later. For transfers that go together.
    void start(Instant now) { (void)ready(now); }
    /// In the channel; generation 0: not (yet).
    [[nodiscard]] EntryId entry() const noexcept { return entry_.value_or(EntryId{}); }
    /// Takes a started transfer back. False: it has left (or never started), await it.
    bool withdraw() noexcept;

    bool ready(Instant now) override;
    Reply await_resume() { return std::move(reply_); }

private:
    std::optional<EntryId> submit() noexcept;
    bool stand_in_line(Instant now);

    AcyclicChannel& channel_;
    EntryTurn turn_;
    Command command_;
    Address address_;
    std::vector<std::byte> data_;
    unsigned attempts_;
    SendGate gate_;
    std::optional<Duration> wait_;  ///< for the gate
    std::optional<EntryId> entry_;
    std::optional<Instant> give_up_at_;
    std::optional<Instant> in_line_since_, line_seen_at_;
    std::uint64_t line_seen_ = 0;
    Reply reply_;
};

class DatagramPort {
public:
    /// After this time without an answer a datagram is lost even if nobody moves frames (no cycle, no pump). Counted from its entry
    /// into the channel.
    static constexpr Duration patience = std::chrono::milliseconds{300};
    /// Slaves to speak to side by side: two datagrams of each fit into the channel, so that nobody stands in line for long.
    static constexpr std::size_t slaves_at_once = 40;
    static_assert(2 * slaves_at_once < AcyclicChannel::entry_count);
    static constexpr unsigned default_attempts = 3;

    explicit DatagramPort(AcyclicChannel& channel) noexcept : channel_(channel) {}

    [[nodiscard]] Transfer fprd(std::uint16_t station, std::uint16_t address, std::size_t size, unsigned attempts = default_attempts) {
        return read(Command::FPRD, Address::physical(station, address), size, attempts);
    }
    /// Leaves when the gate opens, once; after `wait` it is held. What was read is never thrown away unseen.
    [[nodiscard]] Transfer fprd_gated(std::uint16_t station, std::uint16_t address, std::size_t size, const SendGate& gate, Duration wait) {
        return Transfer{channel_, Command::FPRD, Address::physical(station, address), std::vector<std::byte>(size), 1, gate, wait};
    }
    [[nodiscard]] Transfer fpwr(std::uint16_t station, std::uint16_t address, std::span<const std::byte> data,
                                unsigned attempts = default_attempts) {
        return write(Command::FPWR, Address::physical(station, address), data, attempts);
    }
    template <std::integral T>
    [[nodiscard]] Transfer fpwr(std::uint16_t station, std::uint16_t address, T value) {
        return write_value(Command::FPWR, Address::physical(station, address), value);
    }
    [[nodiscard]] Transfer aprd(std::uint16_t position, std::uint16_t address, std::size_t size) {
        return read(Command::APRD, Address::position(position, address), size, default_attempts);
    }
    [[nodiscard]] Transfer apwr(std::uint16_t position, std::uint16_t address, std::span<const std::byte> data) {
        return write(Command::APWR, Address::position(position, address), data, default_attempts);
    }
    template <std::integral T>
    [[nodiscard]] Transfer apwr(std::uint16_t position, std::uint16_t address, T value) {
        return write_value(Command::APWR, Address::position(position, address), value);
    }
    [[nodiscard]] Transfer brd(std::uint16_t address, std::size_t size) {
        return read(Command::BRD, Address::physical(0, address), size, default_attempts);
    }
    /// `size` zero bytes to every slave: clears a block of registers.
    [[nodiscard]] Transfer clear_all(std::uint16_t address, std::size_t size) {
        return read(Command::BWR, Address::physical(0, address), size, default_attempts);
    }
    template <std::integral T>
    [[nodiscard]] Transfer bwr(std::uint16_t address, T value) {
        return write_value(Command::BWR, Address::physical(0, address), value);
    }
    /// The addressed slave's value goes to all behind it. One attempt: a time is worth nothing later.
    [[nodiscard]] Transfer frmw(std::uint16_t station, std::uint16_t address, std::size_t size) {
        return read(Command::FRMW, Address::physical(station, address), size, 1);
    }

private:
    [[nodiscard]] Transfer read(Command command, Address address, std::size_t size, unsigned attempts) {
        return Transfer{channel_, command, address, std::vector<std::byte>(size), attempts};
    }
    [[nodiscard]] Transfer write(Command command, Address address, std::span<const std::byte> data, unsigned attempts) {
        return Transfer{channel_, command, address, std::vector<std::byte>(data.begin(), data.end()), attempts};
    }
    template <std::integral T>
    [[nodiscard]] Transfer write_value(Command command, Address address, T value) {
        std::vector<std::byte> bytes(sizeof(T));
        store_le(bytes, 0, value);
        return Transfer{channel_, command, address, std::move(bytes), default_attempts};
    }

    AcyclicChannel& channel_;
};

}  // namespace taktwerk::ecat
