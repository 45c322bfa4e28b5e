#pragma once
// An Ethernet frame in pieces that fit into a mailbox. No I/O, no allocation. Source: ETG.1000.6 (EoE).

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "ecat/wire/eoe.hpp"

namespace taktwerk::ecat {

/// Header, one VLAN tag and 1500 bytes; without the checksum.
inline constexpr std::size_t longest_ethernet_frame = 1518;
inline constexpr std::size_t shortest_ethernet_frame = 14;

class FrameCutter {
public:
    /// `frame` outlives it. `mailbox_size` of the mailbox that it goes through. `number`: of the frame, 0..15.
    FrameCutter(std::span<const std::byte> frame, std::size_t mailbox_size, std::uint8_t number) noexcept
        : frame_(frame), room_(eoe_room(mailbox_size)), number_(number) {}

    /// The frame fits through this mailbox: neither too long nor in too many pieces.
    [[nodiscard]] bool possible() const noexcept;
    /// The next piece; nothing after the last. Only when possible().
    [[nodiscard]] std::optional<EoeFragment> next() noexcept;

private:
    std::span<const std::byte> frame_;
    std::size_t room_;
    std::uint8_t number_;
    std::size_t done_ = 0;
    std::uint8_t fragment_ = 0;
    bool over_ = false;
};

}  // namespace taktwerk::ecat
