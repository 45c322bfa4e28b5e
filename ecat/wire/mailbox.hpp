#pragma once
// The mailbox header and the mailbox error reply. Bytes only. Source: ETG.1000.4 (mailbox), reference section 5.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace taktwerk::ecat {

inline constexpr std::size_t mailbox_header_size = 6;

enum class MailboxType : std::uint8_t { error = 0, aoe = 1, eoe = 2, coe = 3, foe = 4, soe = 5, voe = 15 };
[[nodiscard]] std::string_view name(MailboxType type) noexcept;

struct MailboxHeader {
    std::uint16_t length = 0;   ///< bytes of payload after the header
    std::uint16_t address = 0;  ///< station address of the sender; 0 between master and slave
    std::uint8_t channel = 0;   ///< 0..63, reserved for the future
    std::uint8_t priority = 0;  ///< 0..3
    MailboxType type = MailboxType::error;
    std::uint8_t counter = 0;  ///< 1..7; 0 = the slave does not check it
    friend bool operator==(const MailboxHeader&, const MailboxHeader&) = default;
};

/// The counter after `counter`: 1..7, then 1 again. After 0 comes 1.
[[nodiscard]] constexpr std::uint8_t next_mailbox_counter(std::uint8_t counter) noexcept {
    return static_cast<std::uint8_t>(counter >= 7 ? 1 : counter + 1);
}

void encode(const MailboxHeader& header, std::span<std::byte, mailbox_header_size> bytes) noexcept;
[[nodiscard]] MailboxHeader decode_mailbox_header(std::span<const std::byte, mailbox_header_size> bytes) noexcept;

/// One message as read from a mailbox. `payload` is a view: valid as long as the bytes are.
struct MailboxMessage {
    MailboxHeader header;
    std::span<const std::byte> payload;  ///< header.length bytes
};
/// Nothing when the mailbox is shorter than its header or the length field reaches beyond it.
[[nodiscard]] std::optional<MailboxMessage> parse_mailbox(std::span<const std::byte> mailbox) noexcept;

/// Completes a message whose payload stands at mailbox.subspan(6): writes the header with this length, zeroes the rest, so
/// that the full sync manager length can be written (only that switches the mailbox). False when the payload does not fit.
bool finish_mailbox(std::span<std::byte> mailbox, MailboxType type, std::uint8_t counter, std::size_t payload_size) noexcept;

/// Why a slave refused a mailbox message (payload of MailboxType::error).
enum class MailboxErrorDetail : std::uint16_t {
    none = 0,
    syntax = 1,
    unsupported_protocol = 2,
    invalid_channel = 3,
    service_not_supported = 4,
    invalid_header = 5,
    size_too_short = 6,
    no_more_memory = 7,
    invalid_size = 8,
    service_in_work = 9,
};
[[nodiscard]] std::string_view text(MailboxErrorDetail detail) noexcept;

inline constexpr std::size_t mailbox_error_size = 4;
[[nodiscard]] std::optional<MailboxErrorDetail> parse_mailbox_error(std::span<const std::byte> payload) noexcept;
void encode_mailbox_error(std::span<std::byte, mailbox_error_size> payload, MailboxErrorDetail detail) noexcept;

}  // namespace taktwerk::ecat
