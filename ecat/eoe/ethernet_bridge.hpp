#pragma once
// Slaves and this computer, joined like the ports of a switch: it learns behind which port an address is, sends there what is for it, and
// to all others what is for everybody or for somebody it does not know. Service side.

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ecat/eoe/ethernet_link.hpp"
#include "ecat/eoe/frame_cutter.hpp"
#include "ecat/eoe/host_port.hpp"

namespace taktwerk::ecat {

class EthernetBridge {
public:
    static constexpr std::size_t most_addresses = 1024;  ///< learnt; then the oldest is forgotten

    explicit EthernetBridge(HostPort& host) noexcept : host_(host) {}
    EthernetBridge(const EthernetBridge&) = delete;
    EthernetBridge& operator=(const EthernetBridge&) = delete;

    /// Before carry(). The mailbox is open, and outlives the bridge.
    void add(MailboxEndpoint& mailbox);
    [[nodiscard]] const EthernetLink& link(std::size_t slave) const noexcept { return *links_[slave]; }
    [[nodiscard]] std::uint64_t to_host() const noexcept { return to_host_; }
    [[nodiscard]] std::uint64_t from_host() const noexcept { return from_host_; }

    /// Carries frames until `until`, or until a slave does not answer any more: that error; eoe.tap: the interface was deleted.
    [[nodiscard]] Script<Result<void>> carry(DatagramPort& port, std::optional<Instant> until);

private:
    static constexpr std::size_t host_side = static_cast<std::size_t>(-1);
    struct Known {
        EoeMac mac{};
        std::size_t side = 0;
    };

    void poll_host();
    void pass(std::span<const std::byte> frame, std::size_t from);
    void deliver(std::span<const std::byte> frame, std::size_t to);
    void learn(const EoeMac& mac, std::size_t side);
    [[nodiscard]] const Known* find(const EoeMac& mac) const noexcept;

    HostPort& host_;
    std::vector<std::unique_ptr<EthernetLink>> links_;
    std::vector<Known> known_;  // oldest first
    std::array<std::byte, 2048> buffer_{};
    std::uint64_t to_host_ = 0, from_host_ = 0;
};

}  // namespace taktwerk::ecat
