#include "ecat/sim/ethernet_node.hpp"

#include <algorithm>

namespace taktwerk::ecat::sim {

namespace {

// Ethernet II; everything behind is in network byte order.
constexpr std::size_t source_at = 6, type_at = 12, payload_at = 14;
constexpr std::uint16_t type_arp = 0x0806, type_ip = 0x0800;
// ARP for IPv4 over Ethernet.
constexpr std::size_t arp_size = 28, arp_op_at = payload_at + 6, arp_sender_mac_at = payload_at + 8, arp_sender_ip_at = payload_at + 14,
                      arp_target_mac_at = payload_at + 18, arp_target_ip_at = payload_at + 24;
constexpr std::uint16_t arp_request = 1, arp_reply = 2;
// IPv4 and ICMP.
constexpr std::size_t ip_length_at = payload_at + 2, ip_fragment_at = payload_at + 6, ip_ttl_at = payload_at + 8,
                      ip_protocol_at = payload_at + 9, ip_checksum_at = payload_at + 10, ip_source_at = payload_at + 12,
                      ip_target_at = payload_at + 16, ip_least_header = 20;
constexpr std::byte protocol_icmp{1}, echo_request{8}, echo_reply{0}, usual_ttl{64};

std::uint16_t load16(std::span<const std::byte> bytes, std::size_t at) noexcept {
    return static_cast<std::uint16_t>(static_cast<unsigned>(bytes[at]) << 8 | static_cast<unsigned>(bytes[at + 1]));
}
std::uint32_t load32(std::span<const std::byte> bytes, std::size_t at) noexcept {
    return std::uint32_t{load16(bytes, at)} << 16 | load16(bytes, at + 2);
}
void store16(std::span<std::byte> bytes, std::size_t at, std::uint16_t value) noexcept {
    bytes[at] = static_cast<std::byte>(value >> 8);
    bytes[at + 1] = static_cast<std::byte>(value & 0xFFu);
}
void store32(std::span<std::byte> bytes, std::size_t at, std::uint32_t value) noexcept {
    store16(bytes, at, static_cast<std::uint16_t>(value >> 16));
    store16(bytes, at + 2, static_cast<std::uint16_t>(value & 0xFFFFu));
}

/// RFC 1071. Over bytes with their checksum in place: 0.
std::uint16_t internet_checksum(std::span<const std::byte> bytes) noexcept {
    std::uint32_t sum = 0;
    for (std::size_t at = 0; at < bytes.size(); at += 2)
        sum += static_cast<unsigned>(bytes[at]) << 8 | (at + 1 < bytes.size() ? static_cast<unsigned>(bytes[at + 1]) : 0u);
    while ((sum >> 16) != 0) sum = (sum & 0xFFFFu) + (sum >> 16);
    return static_cast<std::uint16_t>(~sum & 0xFFFFu);
}

void store_mac(std::span<std::byte> bytes, std::size_t at, const EoeMac& mac) noexcept {
    std::copy(mac.begin(), mac.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
}

}  // namespace

void EthernetNode::start() noexcept {
    assembly_ = {};
    cutter_.reset();
    next_.reset();
}

std::size_t EthernetNode::serve(std::span<const std::byte> message, std::span<std::byte> out, EsmState, Instant) noexcept {
    const auto type = eoe_type(message);
    if (type == EoeType::fragment) {
        const auto fragment = parse_eoe_fragment(message);
        if (!fragment) return 0;
        if (const auto frame = assembly_.take(*fragment)) take_frame(*frame);
        return 0;
    }
    if (type == EoeType::set_ip_request) return take_settings(message, out);
    if (type == EoeType::set_filter_request) return encode_eoe_result(out, 0, *type, EoeResult::no_filter_support);
    return 0;
}

std::size_t EthernetNode::take_settings(std::span<const std::byte> message, std::span<std::byte> out) noexcept {
    const auto asked = parse_eoe_set_ip(message);
    if (!asked) return encode_eoe_result(out, 0, EoeType::set_ip_request, EoeResult::unspecified);
    if (!options_.takes_ip) return encode_eoe_result(out, 0, EoeType::set_ip_request, EoeResult::no_ip_support);
    if (asked->mac) mac_ = *asked->mac;
    if (asked->ip) ip_ = *asked->ip;
    return encode_eoe_result(out, 0, EoeType::set_ip_request, EoeResult::success);
}

std::size_t EthernetNode::next(std::span<std::byte> out) noexcept {
    if (!next_) return 0;
    const std::size_t size = encode_eoe_fragment(out, *next_);
    next_ = cutter_->next();
    return size;
}

void EthernetNode::take_frame(std::span<const std::byte> frame) noexcept {
    if (ip_ == 0 || next_) return;  // one answer at a time: what comes meanwhile is asked again
    const auto type = load16(frame, type_at);
    if (type == type_arp) (void)answer_arp(frame);
    if (type == type_ip) (void)answer_echo(frame);
}

bool EthernetNode::answer_arp(std::span<const std::byte> frame) noexcept {
    constexpr std::array<std::byte, 6> ipv4_over_ethernet{std::byte{0}, std::byte{1}, std::byte{8},
                                                          std::byte{0}, std::byte{6}, std::byte{4}};
    if (frame.size() < payload_at + arp_size || load16(frame, arp_op_at) != arp_request || load32(frame, arp_target_ip_at) != ip_)
        return false;
    if (!std::equal(ipv4_over_ethernet.begin(), ipv4_over_ethernet.end(), frame.begin() + payload_at)) return false;
    std::copy_n(frame.begin(), payload_at + arp_size, reply_.begin());
    store16(reply_, arp_op_at, arp_reply);
    std::copy_n(frame.begin() + arp_sender_mac_at, 10, reply_.begin() + arp_target_mac_at);  // MAC and IP: sender becomes target
    store_mac(reply_, arp_sender_mac_at, mac_);
    store32(reply_, arp_sender_ip_at, ip_);
    std::copy_n(frame.begin() + arp_sender_mac_at, 6, reply_.begin());
    store_mac(reply_, source_at, mac_);
    send_reply(payload_at + arp_size);
    return true;
}

bool EthernetNode::answer_echo(std::span<const std::byte> frame) noexcept {
    if (frame.size() < payload_at + ip_least_header || !std::equal(mac_.begin(), mac_.end(), frame.begin())) return false;
    const auto version_and_words = static_cast<unsigned>(frame[payload_at]);
    const std::size_t header = std::size_t{4} * (version_and_words & 0xFu), length = load16(frame, ip_length_at);
    constexpr std::uint16_t more_or_offset = 0x3FFF;
    if (version_and_words >> 4 != 4 || header < ip_least_header || length < header + 8 || length > frame.size() - payload_at) return false;
    if (internet_checksum(frame.subspan(payload_at, header)) != 0 || (load16(frame, ip_fragment_at) & more_or_offset) != 0) return false;
    if (frame[ip_protocol_at] != protocol_icmp || load32(frame, ip_target_at) != ip_) return false;
    const auto icmp = frame.subspan(payload_at + header, length - header);
    if (icmp[0] != echo_request || internet_checksum(icmp) != 0) return false;
    const std::size_t size = payload_at + length;
    std::copy_n(frame.begin(), size, reply_.begin());
    std::copy_n(frame.begin() + source_at, 6, reply_.begin());
    store_mac(reply_, source_at, mac_);
    store32(reply_, ip_target_at, load32(frame, ip_source_at));
    store32(reply_, ip_source_at, ip_);
    reply_[ip_ttl_at] = usual_ttl;
    store16(reply_, ip_checksum_at, 0);
    store16(reply_, ip_checksum_at, internet_checksum(std::span{reply_}.subspan(payload_at, header)));
    const std::size_t icmp_at = payload_at + header;
    reply_[icmp_at] = echo_reply;
    store16(reply_, icmp_at + 2, 0);
    store16(reply_, icmp_at + 2, internet_checksum(std::span{reply_}.subspan(icmp_at, length - header)));
    ++echoes_;
    send_reply(size);
    return true;
}

void EthernetNode::send_reply(std::size_t size) noexcept {
    cutter_.emplace(std::span<const std::byte>{reply_}.first(size), mailbox_size_, number_);
    number_ = static_cast<std::uint8_t>((number_ + 1) & 0xF);
    if (cutter_->possible()) next_ = cutter_->next();
}

}  // namespace taktwerk::ecat::sim
