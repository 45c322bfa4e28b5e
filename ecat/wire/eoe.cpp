#include "ecat/wire/eoe.hpp"

#include <algorithm>

#include "core/bytes.hpp"
#include "ecat/wire/mailbox.hpp"

namespace taktwerk::ecat {

namespace {

// First word: type, port, flags. Second word of a fragment: its number, blocks, frame.
constexpr unsigned type_mask = 0x000F, port_shift = 4, last_fragment = 1u << 8, time_appended = 1u << 9, time_request = 1u << 10;
constexpr unsigned number_mask = 0x3F, blocks_shift = 6, frame_shift = 12;

// What of a Set IP request is given: MAC, then IP, subnet, gateway and DNS in a row, then the name.
constexpr std::uint32_t has_mac = 1u << 0, has_ip = 1u << 1, has_name = 1u << 5;
constexpr std::size_t flags_at = eoe_header_size, mac_at = flags_at + 4, ip_at = mac_at + 6, name_at = ip_at + 16, name_size = 32;

std::uint16_t head(EoeType type, std::uint8_t port) noexcept {
    return static_cast<std::uint16_t>(static_cast<unsigned>(type) | ((port & 0xFu) << port_shift));
}

EoeType answer_to(EoeType asked) noexcept { return static_cast<EoeType>(static_cast<std::uint8_t>(asked) + 1); }

}  // namespace

std::optional<EoeType> eoe_type(std::span<const std::byte> payload) noexcept {
    if (payload.size() < eoe_header_size) return std::nullopt;
    const unsigned type = load_le<std::uint16_t>(payload, 0) & type_mask;
    if (type > static_cast<unsigned>(EoeType::get_filter_response)) return std::nullopt;
    return static_cast<EoeType>(type);
}

std::optional<EoeFragment> parse_eoe_fragment(std::span<const std::byte> payload) noexcept {
    if (eoe_type(payload) != EoeType::fragment) return std::nullopt;
    const unsigned first = load_le<std::uint16_t>(payload, 0), second = load_le<std::uint16_t>(payload, 2);
    EoeFragment out;
    out.port = static_cast<std::uint8_t>(first >> port_shift & 0xFu);
    out.last = (first & last_fragment) != 0;
    out.time_asked = (first & time_request) != 0;
    out.number = static_cast<std::uint8_t>(second & number_mask);
    out.blocks = static_cast<std::uint8_t>(second >> blocks_shift & number_mask);
    out.frame = static_cast<std::uint8_t>(second >> frame_shift);
    out.data = payload.subspan(eoe_header_size);
    if ((first & time_appended) == 0) return out;
    if (!out.last || out.data.size() < eoe_time_size) return std::nullopt;
    const std::size_t size = out.data.size() - eoe_time_size;
    out.time = load_le<std::uint32_t>(out.data, size);
    out.data = out.data.first(size);
    return out;
}

std::size_t encode_eoe_fragment(std::span<std::byte> out, const EoeFragment& fragment) noexcept {
    const bool timed = fragment.last && fragment.time.has_value();
    const std::size_t size = eoe_header_size + fragment.data.size() + (timed ? eoe_time_size : 0);
    if (out.size() < size) return 0;
    const unsigned first = head(EoeType::fragment, fragment.port) | (fragment.last ? last_fragment : 0u) | (timed ? time_appended : 0u) |
                           (fragment.time_asked ? time_request : 0u);
    const unsigned second =
        (fragment.number & number_mask) | ((fragment.blocks & number_mask) << blocks_shift) | ((fragment.frame & 0xFu) << frame_shift);
    store_le(out, 0, static_cast<std::uint16_t>(first));
    store_le(out, 2, static_cast<std::uint16_t>(second));
    std::copy(fragment.data.begin(), fragment.data.end(), out.begin() + eoe_header_size);
    if (timed) store_le(out, size - eoe_time_size, *fragment.time);
    return size;
}

std::size_t eoe_room(std::size_t mailbox_size) noexcept {
    constexpr std::size_t headers = mailbox_header_size + eoe_header_size;
    return mailbox_size > headers ? (mailbox_size - headers) / eoe_block * eoe_block : 0;
}

std::size_t encode_eoe_set_ip(std::span<std::byte> out, std::uint8_t port, const EoeAddress& address) noexcept {
    if (out.size() < eoe_set_ip_size || address.name.size() >= name_size) return 0;
    const auto message = out.first(eoe_set_ip_size);
    std::fill(message.begin(), message.end(), std::byte{0});
    store_le(message, 0, static_cast<std::uint16_t>(head(EoeType::set_ip_request, port) | last_fragment));
    std::uint32_t flags = 0;
    if (address.mac) {
        flags |= has_mac;
        std::copy(address.mac->begin(), address.mac->end(), message.begin() + mac_at);
    }
    const std::array numbers{&address.ip, &address.subnet, &address.gateway, &address.dns};
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        if (!*numbers[n]) continue;
        flags |= has_ip << n;
        store_le(message, ip_at + 4 * n, **numbers[n]);
    }
    if (!address.name.empty()) {
        flags |= has_name;
        const auto name = std::as_bytes(std::span{address.name.data(), address.name.size()});
        std::copy(name.begin(), name.end(), message.begin() + name_at);
    }
    store_le(message, flags_at, flags);
    return eoe_set_ip_size;
}

std::optional<EoeAddress> parse_eoe_set_ip(std::span<const std::byte> payload) noexcept {
    if (eoe_type(payload) != EoeType::set_ip_request || payload.size() < mac_at) return std::nullopt;
    const auto flags = load_le<std::uint32_t>(payload, flags_at);
    EoeAddress out;
    if ((flags & has_mac) != 0 && payload.size() >= ip_at) {
        out.mac.emplace();
        std::copy_n(payload.begin() + mac_at, out.mac->size(), out.mac->begin());
    }
    const std::array numbers{&out.ip, &out.subnet, &out.gateway, &out.dns};
    for (std::size_t n = 0; n < numbers.size(); ++n)
        if ((flags & (has_ip << n)) != 0 && payload.size() >= ip_at + 4 * (n + 1))
            *numbers[n] = load_le<std::uint32_t>(payload, ip_at + 4 * n);
    if ((flags & has_name) != 0 && payload.size() >= name_at + name_size) {
        const auto field = payload.subspan(name_at, name_size - 1);
        const auto end = std::find(field.begin(), field.end(), std::byte{0});
        out.name = {reinterpret_cast<const char*>(field.data()), static_cast<std::size_t>(end - field.begin())};
    }
    return out;
}

std::string_view text(EoeResult result) noexcept {
    switch (result) {
        case EoeResult::success: return "success";
        case EoeResult::unspecified: return "unspecified error";
        case EoeResult::unsupported_type: return "the slave does not know this service";
        case EoeResult::no_ip_support: return "the slave takes no IP settings";
        case EoeResult::no_dhcp_support: return "the slave has no DHCP";
        case EoeResult::no_filter_support: return "the slave has no address filter";
    }
    return "a result of its maker";
}

std::optional<EoeResult> parse_eoe_result(std::span<const std::byte> payload, EoeType asked) noexcept {
    if (eoe_type(payload) != answer_to(asked)) return std::nullopt;
    return static_cast<EoeResult>(load_le<std::uint16_t>(payload, 2));
}

std::size_t encode_eoe_result(std::span<std::byte> out, std::uint8_t port, EoeType asked, EoeResult result) noexcept {
    if (out.size() < eoe_header_size) return 0;
    store_le(out, 0, static_cast<std::uint16_t>(head(answer_to(asked), port) | last_fragment));
    store_le(out, 2, static_cast<std::uint16_t>(result));
    return eoe_header_size;
}

}  // namespace taktwerk::ecat
