#pragma once
// File access over EtherCAT: one message. All functions work on a mailbox payload, that is without the 6-byte mailbox header
// (ecat/wire/mailbox.hpp). No allocation. Source: ETG.1000.6 (FoE).

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace taktwerk::ecat {

enum class FoeOp : std::uint8_t { read_request = 1, write_request = 2, data = 3, acknowledge = 4, error = 5, busy = 6 };

inline constexpr std::size_t foe_header_size = 6;  ///< op, reserved, 32 bits whose meaning the op decides

struct FoeMessage {
    FoeOp op = FoeOp::error;
    /// Requests: the password. Data and acknowledge: the packet. Error: the code (foe_error.hpp). Busy: done and entire, 16 bits each.
    std::uint32_t number = 0;
    /// Requests: the file's name. Data: the packet's bytes. Error and busy: words, as text() gives them. A view of the mailbox.
    std::span<const std::byte> rest;

    [[nodiscard]] std::uint16_t done() const noexcept { return static_cast<std::uint16_t>(number & 0xFFFFu); }
    /// 0: `done` is per cent.
    [[nodiscard]] std::uint16_t entire() const noexcept { return static_cast<std::uint16_t>(number >> 16); }
    /// `rest` to its first zero: slaves end their words so, or fill up with them.
    [[nodiscard]] std::string_view text() const noexcept;
};

/// Nothing when it is shorter than its header or its op does not exist.
[[nodiscard]] std::optional<FoeMessage> parse_foe(std::span<const std::byte> payload) noexcept;
/// The bytes written; 0 when `out` is too small.
std::size_t encode_foe(std::span<std::byte> out, const FoeMessage& message) noexcept;

/// Names and words as they lie in a message: characters, without an end.
[[nodiscard]] std::span<const std::byte> foe_text(std::string_view text) noexcept;

/// File bytes that a mailbox of this size carries in one packet. Fewer in a packet: it is the last.
[[nodiscard]] std::size_t foe_room(std::size_t mailbox_size) noexcept;

}  // namespace taktwerk::ecat
