#include "ecat/eoe/ip_settings.hpp"

#include <charconv>

#include <fmt/format.h>

namespace taktwerk::ecat {

namespace {

/// The number that `text` begins with, at most `largest`; it is taken off.
std::optional<unsigned> leading_number(std::string_view& text, unsigned largest) noexcept {
    unsigned value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc{} || value > largest) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

}  // namespace

Script<Result<void>> set_ip(DatagramPort& port, MailboxEndpoint& mailbox, EoeAddress address) {
    co_await mailbox.lock.acquire();
    const ScriptLockGuard guard{mailbox.lock};
    MailboxRequest request;
    request.about = "setting its IP address";
    request.type = MailboxType::eoe;
    request.payload.resize(eoe_set_ip_size);
    (void)encode_eoe_set_ip(request.payload, 0, address);
    request.answered_by = [](std::span<const std::byte> bytes) { return parse_eoe_result(bytes, EoeType::set_ip_request).has_value(); };
    const Result<std::vector<std::byte>> answer = co_await ask(port, mailbox, request);
    if (!answer) co_return answer.error();
    const EoeResult result = *parse_eoe_result(*answer, EoeType::set_ip_request);
    if (result == EoeResult::success) co_return Result<void>{};
    co_return Error{"eoe.refused", mailbox.subject,
                    fmt::format("{} was refused: {:04X}h {}", request.about, static_cast<unsigned>(result), text(result)),
                    "set it as the slave's maker says: by switches, objects or a page of its own; and leave --ip out here"};
}

std::optional<IpAndSubnet> parse_ip_and_subnet(std::string_view text) noexcept {
    IpAndSubnet out;
    for (int part = 0; part < 4; ++part) {
        const auto number = leading_number(text, 255);
        if (!number || text.empty() || text.front() != (part < 3 ? '.' : '/')) return std::nullopt;
        text.remove_prefix(1);
        out.ip = out.ip << 8 | *number;
    }
    const auto bits = leading_number(text, 32);
    if (!bits || !text.empty()) return std::nullopt;
    out.subnet = *bits == 0 ? 0 : 0xFFFFFFFFu << (32 - *bits);
    return out;
}

std::string ip_text(std::uint32_t ip) { return fmt::format("{}.{}.{}.{}", ip >> 24, ip >> 16 & 0xFFu, ip >> 8 & 0xFFu, ip & 0xFFu); }

}  // namespace taktwerk::ecat
