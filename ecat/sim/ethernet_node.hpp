#pragma once
// A tiny network node behind the EoE of a simulated slave: it has a MAC address, takes an IP address (Set IP), answers ARP for it and ICMP
// echo to it. Whatever else comes it leaves alone, as a device without that service does. Allocation-free. Source: ETG.1000.6 (EoE),
// RFC 826 (ARP), RFC 791 and 1071 (IP, checksum), RFC 792 (ICMP).

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "ecat/eoe/frame_assembly.hpp"
#include "ecat/eoe/frame_cutter.hpp"
#include "ecat/sim/mailbox_service.hpp"
#include "ecat/wire/eoe.hpp"

namespace taktwerk::ecat::sim {

struct EthernetOptions {
    EoeMac mac{std::byte{0x02}, std::byte{0x54}, std::byte{0x57}, std::byte{0}, std::byte{0}, std::byte{1}};
    std::uint32_t ip = 0;  ///< 0: none until it is told one
    bool takes_ip = true;  ///< else Set IP is refused (0201h)
};

class EthernetNode final : public MailboxService {
public:
    explicit EthernetNode(const EthernetOptions& options) noexcept : options_(options), mac_(options.mac), ip_(options.ip) {}

    void set_rooms(std::size_t, std::size_t to_master) noexcept override { mailbox_size_ = to_master + mailbox_header; }
    void start() noexcept override;
    std::size_t serve(std::span<const std::byte> message, std::span<std::byte> out, EsmState state, Instant now) noexcept override;
    [[nodiscard]] bool pending() const noexcept override { return next_.has_value(); }
    std::size_t next(std::span<std::byte> out) noexcept override;

    [[nodiscard]] const EoeMac& mac() const noexcept { return mac_; }
    [[nodiscard]] std::uint32_t ip() const noexcept { return ip_; }
    [[nodiscard]] std::uint32_t echoes() const noexcept { return echoes_; }

private:
    static constexpr std::size_t mailbox_header = 6;

    std::size_t take_settings(std::span<const std::byte> message, std::span<std::byte> out) noexcept;
    void take_frame(std::span<const std::byte> frame) noexcept;
    bool answer_arp(std::span<const std::byte> frame) noexcept;
    bool answer_echo(std::span<const std::byte> frame) noexcept;
    void send_reply(std::size_t size) noexcept;

    EthernetOptions options_;
    EoeMac mac_;
    std::uint32_t ip_;
    FrameAssembly assembly_;
    std::array<std::byte, longest_ethernet_frame> reply_{};
    std::optional<FrameCutter> cutter_;  ///< of the reply that goes out
    std::optional<EoeFragment> next_;    ///< its next piece
    std::size_t mailbox_size_ = 0;
    std::uint8_t number_ = 0;
    std::uint32_t echoes_ = 0;
};

}  // namespace taktwerk::ecat::sim
