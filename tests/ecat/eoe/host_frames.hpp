#pragma once
// What a computer on the same Ethernet sends and expects: ARP and ping, written down here byte by byte, with nothing of the simulated node's code.
// RFC 826, RFC 791, RFC 792.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ecat/wire/eoe.hpp"

namespace taktwerk::ecat::test {

using HostBytes = std::vector<std::byte>;

inline void append(HostBytes& to, std::initializer_list<unsigned> values) {
    for (const unsigned v : values) to.push_back(static_cast<std::byte>(v));
}
inline void append_number(HostBytes& to, std::uint32_t value, unsigned bytes) {
    for (unsigned n = bytes; n-- > 0;) to.push_back(static_cast<std::byte>(value >> 8 * n & 0xFFu));
}
inline std::uint32_t number_at(const HostBytes& bytes, std::size_t at, unsigned size) {
    std::uint32_t value = 0;
    for (unsigned n = 0; n < size; ++n) value = value << 8 | static_cast<std::uint32_t>(bytes.at(at + n));
    return value;
}
/// RFC 1071.
inline std::uint16_t sum_of(const HostBytes& bytes, std::size_t from, std::size_t size) {
    std::uint32_t sum = 0;
    for (std::size_t at = from; at < from + size; ++at) sum += static_cast<std::uint32_t>(bytes[at]) << ((at - from) % 2 == 0 ? 8 : 0);
    while (sum > 0xFFFF) sum = (sum & 0xFFFF) + (sum >> 16);
    return static_cast<std::uint16_t>(~sum);
}

inline void append_host_mac(HostBytes& to) { append(to, {0x02, 0x11, 0x22, 0x33, 0x44, 0x55}); }

inline HostBytes arp_question(std::uint32_t own_ip, std::uint32_t asked) {
    HostBytes frame;
    append(frame, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF});
    append_host_mac(frame);
    append(frame, {0x08, 0x06, 0x00, 0x01, 0x08, 0x00, 6, 4, 0, 1});
    append_host_mac(frame);
    append_number(frame, own_ip, 4);
    append(frame, {0, 0, 0, 0, 0, 0});
    append_number(frame, asked, 4);
    return frame;
}

/// The MAC that an ARP answer gives for this address; all zero: it is no such answer.
inline EoeMac arp_answer_mac(const HostBytes& frame, std::uint32_t asked) {
    EoeMac mac{};
    if (frame.size() < 42 || number_at(frame, 12, 2) != 0x0806 || number_at(frame, 20, 2) != 2 || number_at(frame, 28, 4) != asked)
        return mac;
    std::copy_n(frame.begin() + 22, 6, mac.begin());
    return mac;
}

inline HostBytes echo_question(const EoeMac& to, std::uint32_t own_ip, std::uint32_t asked, std::size_t data, std::uint16_t sequence) {
    HostBytes frame{to.begin(), to.end()};
    append_host_mac(frame);
    append(frame, {0x08, 0x00, 0x45, 0});
    append_number(frame, static_cast<std::uint32_t>(28 + data), 2);
    append(frame, {0, 7, 0x40, 0, 63, 1, 0, 0});
    append_number(frame, own_ip, 4);
    append_number(frame, asked, 4);
    const std::uint16_t header = sum_of(frame, 14, 20);
    frame[24] = static_cast<std::byte>(header >> 8), frame[25] = static_cast<std::byte>(header & 0xFF);
    append(frame, {8, 0, 0, 0, 0x12, 0x34});
    append_number(frame, sequence, 2);
    for (std::size_t i = 0; i < data; ++i) frame.push_back(static_cast<std::byte>(i * 3 & 0xFF));
    const std::uint16_t icmp = sum_of(frame, 34, 8 + data);
    frame[36] = static_cast<std::byte>(icmp >> 8), frame[37] = static_cast<std::byte>(icmp & 0xFF);
    return frame;
}

/// Type 0, addresses exchanged, checksums right, identifier, sequence and data as they were asked.
inline bool answers_echo(const HostBytes& answer, const HostBytes& question) {
    return answer.size() == question.size() && std::equal(question.begin() + 6, question.begin() + 12, answer.begin()) &&
           std::equal(question.begin(), question.begin() + 6, answer.begin() + 6) && number_at(answer, 12, 2) == 0x0800 &&
           number_at(answer, 26, 4) == number_at(question, 30, 4) && number_at(answer, 30, 4) == number_at(question, 26, 4) &&
           sum_of(answer, 14, 20) == 0 && sum_of(answer, 34, answer.size() - 34) == 0 && answer[34] == std::byte{0} &&
           std::equal(question.begin() + 38, question.end(), answer.begin() + 38);
}

}  // namespace taktwerk::ecat::test
