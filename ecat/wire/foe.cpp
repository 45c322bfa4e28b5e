#include "ecat/wire/foe.hpp"

#include <algorithm>

#include "core/bytes.hpp"
#include "ecat/wire/mailbox.hpp"

namespace taktwerk::ecat {

std::string_view FoeMessage::text() const noexcept {
    const auto end = std::find(rest.begin(), rest.end(), std::byte{0});
    return {reinterpret_cast<const char*>(rest.data()), static_cast<std::size_t>(end - rest.begin())};
}

std::optional<FoeMessage> parse_foe(std::span<const std::byte> payload) noexcept {
    if (payload.size() < foe_header_size) return std::nullopt;
    const auto op = static_cast<std::uint8_t>(payload[0]);
    if (op < static_cast<std::uint8_t>(FoeOp::read_request) || op > static_cast<std::uint8_t>(FoeOp::busy)) return std::nullopt;
    return FoeMessage{static_cast<FoeOp>(op), load_le<std::uint32_t>(payload, 2), payload.subspan(foe_header_size)};
}

std::size_t encode_foe(std::span<std::byte> out, const FoeMessage& message) noexcept {
    if (out.size() < foe_header_size || message.rest.size() > out.size() - foe_header_size) return 0;
    out[0] = static_cast<std::byte>(message.op);
    out[1] = std::byte{0};
    store_le(out, 2, message.number);
    std::copy(message.rest.begin(), message.rest.end(), out.begin() + foe_header_size);
    return foe_header_size + message.rest.size();
}

std::span<const std::byte> foe_text(std::string_view text) noexcept { return std::as_bytes(std::span{text.data(), text.size()}); }

std::size_t foe_room(std::size_t mailbox_size) noexcept {
    constexpr std::size_t headers = mailbox_header_size + foe_header_size;
    return mailbox_size > headers ? mailbox_size - headers : 0;
}

}  // namespace taktwerk::ecat
