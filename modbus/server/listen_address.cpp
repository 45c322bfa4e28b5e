#include "modbus/server/listen_address.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <charconv>

namespace taktwerk::modbus::server {

namespace {

std::optional<in_addr> v4(const std::string& host) {
    in_addr address{};
    return ::inet_pton(AF_INET, host.c_str(), &address) == 1 ? std::optional{address} : std::nullopt;
}

std::optional<in6_addr> v6(const std::string& host) {
    in6_addr address{};
    return ::inet_pton(AF_INET6, host.c_str(), &address) == 1 ? std::optional{address} : std::nullopt;
}

/// No computer has an address that is for many, or of the network 0; an IPv4 address is written as one.
bool is_own(const std::optional<in_addr>& address) {
    if (!address) return false;
    const auto number = ntohl(address->s_addr);
    const bool of_no_network = number != INADDR_ANY && number >> 24 == 0;
    return number != INADDR_BROADCAST && !IN_MULTICAST(number) && !of_no_network;
}
bool is_own(const std::optional<in6_addr>& address) {
    return address && !IN6_IS_ADDR_MULTICAST(&*address) && !IN6_IS_ADDR_V4MAPPED(&*address);
}

}  // namespace

std::optional<ListenAddress> parse_listen_address(std::string_view text) {
    const auto colon = text.rfind(':');
    if (colon == std::string_view::npos) return std::nullopt;
    const auto host = text.substr(0, colon), port = text.substr(colon + 1);
    ListenAddress out;
    const auto read = std::from_chars(port.data(), port.data() + port.size(), out.port);
    if (port.empty() || read.ec != std::errc{} || read.ptr != port.data() + port.size() || out.port == 0) return std::nullopt;
    const bool brackets = host.size() > 2 && host.front() == '[' && host.back() == ']';
    out.host = std::string(brackets ? host.substr(1, host.size() - 2) : host);
    const bool good = brackets ? is_own(v6(out.host)) : is_own(v4(out.host));
    return good ? std::optional{out} : std::nullopt;
}

std::string text_of(const ListenAddress& address) {
    const bool six = address.host.find(':') != std::string::npos;
    return (six ? "[" + address.host + "]" : address.host) + ":" + std::to_string(address.port);
}

Reach reach_of(const ListenAddress& address) {
    if (const auto four = v4(address.host)) {
        if (four->s_addr == htonl(INADDR_ANY)) return Reach::every_port;
        return ntohl(four->s_addr) >> 24 == 127 ? Reach::this_computer : Reach::one_port;
    }
    if (const auto six = v6(address.host)) {
        if (IN6_IS_ADDR_UNSPECIFIED(&*six)) return Reach::every_port;
        return IN6_IS_ADDR_LOOPBACK(&*six) ? Reach::this_computer : Reach::one_port;
    }
    return Reach::one_port;
}

}  // namespace taktwerk::modbus::server
