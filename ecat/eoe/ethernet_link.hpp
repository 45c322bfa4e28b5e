#pragma once
// One slave's Ethernet through its mailbox, beside its other conversations: frames to it wait in a bounded queue, what it sends is put
// together and handed on. Service side.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "core/result.hpp"
#include "ecat/eoe/frame_assembly.hpp"
#include "ecat/mailbox/mailbox_client.hpp"

namespace taktwerk::ecat {

/// Between two looks at a slave that has nothing to say.
inline constexpr Duration ethernet_poll_period = std::chrono::milliseconds{1};

struct EthernetCounts {
    std::uint64_t sent = 0, received = 0;
    std::uint64_t dropped_full = 0;  ///< the queue to the slave was full
    std::uint64_t dropped_size = 0;  ///< does not fit through its mailbox
    std::uint64_t dropped_lost = 0;  ///< a frame of the bus with a piece of it was lost
    friend bool operator==(const EthernetCounts&, const EthernetCounts&) = default;
};

class EthernetLink {
public:
    static constexpr std::size_t queue_limit = 64;  ///< frames

    /// `mailbox` outlives it. `received` takes each whole frame of the slave.
    EthernetLink(MailboxEndpoint& mailbox, std::function<void(std::span<const std::byte>)> received);
    ~EthernetLink() { mailbox_.ethernet = {}; }
    EthernetLink(const EthernetLink&) = delete;
    EthernetLink& operator=(const EthernetLink&) = delete;

    /// Dropped when the queue is full, as a switch drops.
    void send(std::span<const std::byte> frame);
    [[nodiscard]] const EthernetCounts& counts() const noexcept { return counts_; }
    /// Frames of the slave whose pieces did not fit together.
    [[nodiscard]] std::uint32_t broken() const noexcept { return assembly_.dropped(); }

    /// Carries frames both ways until the slave does not answer any more: that error. Without end else.
    [[nodiscard]] Script<Result<void>> carry(DatagramPort& port);

private:
    [[nodiscard]] Script<Result<void>> send_frame(DatagramPort& port, std::vector<std::byte> frame);
    [[nodiscard]] Script<Result<void>> send_piece(DatagramPort& port, std::vector<std::byte> piece);

    MailboxEndpoint& mailbox_;
    std::function<void(std::span<const std::byte>)> received_;
    std::deque<std::vector<std::byte>> queue_;
    FrameAssembly assembly_;
    EthernetCounts counts_;
    std::uint8_t number_ = 0;
};

}  // namespace taktwerk::ecat
