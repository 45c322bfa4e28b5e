#include "ecat/wire/mailbox.hpp"

#include <algorithm>

#include "core/bytes.hpp"

namespace taktwerk::ecat {

std::string_view name(MailboxType type) noexcept {
    switch (type) {
        case MailboxType::error: return "error";
        case MailboxType::aoe: return "AoE";
        case MailboxType::eoe: return "EoE";
        case MailboxType::coe: return "CoE";
        case MailboxType::foe: return "FoE";
        case MailboxType::soe: return "SoE";
        case MailboxType::voe: return "VoE";
    }
    return "unknown";
}

void encode(const MailboxHeader& header, std::span<std::byte, mailbox_header_size> bytes) noexcept {
    store_le<std::uint16_t>(bytes, 0, header.length);
    store_le<std::uint16_t>(bytes, 2, header.address);
    bytes[4] = static_cast<std::byte>((header.channel & 0x3Fu) | ((header.priority & 0x03u) << 6));
    bytes[5] = static_cast<std::byte>((static_cast<unsigned>(header.type) & 0x0Fu) | ((header.counter & 0x07u) << 4));
}

MailboxHeader decode_mailbox_header(std::span<const std::byte, mailbox_header_size> bytes) noexcept {
    MailboxHeader header;
    header.length = load_le<std::uint16_t>(bytes, 0);
    header.address = load_le<std::uint16_t>(bytes, 2);
    const auto channel = static_cast<unsigned>(bytes[4]);
    header.channel = static_cast<std::uint8_t>(channel & 0x3Fu);
    header.priority = static_cast<std::uint8_t>(channel >> 6);
    const auto type = static_cast<unsigned>(bytes[5]);
    header.type = static_cast<MailboxType>(type & 0x0Fu);
    header.counter = static_cast<std::uint8_t>((type >> 4) & 0x07u);
    return header;
}

std::optional<MailboxMessage> parse_mailbox(std::span<const std::byte> mailbox) noexcept {
    if (mailbox.size() < mailbox_header_size) return std::nullopt;
    const auto header = decode_mailbox_header(mailbox.first<mailbox_header_size>());
    if (header.length > mailbox.size() - mailbox_header_size) return std::nullopt;
    return MailboxMessage{header, mailbox.subspan(mailbox_header_size, header.length)};
}

bool finish_mailbox(std::span<std::byte> mailbox, MailboxType type, std::uint8_t counter, std::size_t payload_size) noexcept {
    if (mailbox.size() < mailbox_header_size || payload_size > mailbox.size() - mailbox_header_size || payload_size > 0xFFFF) return false;
    encode(MailboxHeader{.length = static_cast<std::uint16_t>(payload_size),
                         .address = 0,
                         .channel = 0,
                         .priority = 0,
                         .type = type,
                         .counter = counter},
           mailbox.first<mailbox_header_size>());
    const auto rest = mailbox.subspan(mailbox_header_size + payload_size);
    std::fill(rest.begin(), rest.end(), std::byte{0});
    return true;
}

std::string_view text(MailboxErrorDetail detail) noexcept {
    switch (detail) {
        case MailboxErrorDetail::none: return "no detail";
        case MailboxErrorDetail::syntax: return "syntax of the mailbox header is wrong";
        case MailboxErrorDetail::unsupported_protocol: return "the slave does not support this mailbox protocol";
        case MailboxErrorDetail::invalid_channel: return "invalid channel field";
        case MailboxErrorDetail::service_not_supported: return "the slave does not support this service";
        case MailboxErrorDetail::invalid_header: return "the protocol header is wrong";
        case MailboxErrorDetail::size_too_short: return "the message is too short";
        case MailboxErrorDetail::no_more_memory: return "the slave's mailbox memory is full";
        case MailboxErrorDetail::invalid_size: return "the size of the data is wrong";
        case MailboxErrorDetail::service_in_work: return "the slave is still busy with a service";
    }
    return "unknown mailbox error";
}

std::optional<MailboxErrorDetail> parse_mailbox_error(std::span<const std::byte> payload) noexcept {
    constexpr std::uint16_t mailbox_command_error = 1;
    if (payload.size() < mailbox_error_size || load_le<std::uint16_t>(payload, 0) != mailbox_command_error) return std::nullopt;
    return static_cast<MailboxErrorDetail>(load_le<std::uint16_t>(payload, 2));
}

void encode_mailbox_error(std::span<std::byte, mailbox_error_size> payload, MailboxErrorDetail detail) noexcept {
    store_le<std::uint16_t>(payload, 0, 1);
    store_le<std::uint16_t>(payload, 2, static_cast<std::uint16_t>(detail));
}

}  // namespace taktwerk::ecat
