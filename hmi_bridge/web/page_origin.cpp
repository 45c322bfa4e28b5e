#include "hmi_bridge/web/page_origin.hpp"

#include <arpa/inet.h>

#include <algorithm>

namespace taktwerk::hmi::web {
namespace {

constexpr std::uint16_t http_port = 80;

std::string in_small_letters(std::string_view text) {
    std::string out(text);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return out;
}

}  // namespace

bool is_loopback(std::string_view address) {
    const std::string text(address);
    in_addr four{};
    if (::inet_pton(AF_INET, text.c_str(), &four) == 1) return (ntohl(four.s_addr) >> 24) == 127;
    in6_addr six{};
    return ::inet_pton(AF_INET6, text.c_str(), &six) == 1 && IN6_IS_ADDR_LOOPBACK(&six);
}

PageOrigin::PageOrigin(std::string_view address, std::uint16_t port) {
    std::vector<std::string> names{address.find(':') == std::string_view::npos ? std::string(address) : "[" + std::string(address) + "]"};
    if (is_loopback(address)) names.insert(names.end(), {"localhost", "127.0.0.1", "[::1]"});
    for (const auto& name : names) {
        hosts_.push_back(in_small_letters(name) + ":" + std::to_string(port));
        if (port == http_port) hosts_.push_back(in_small_letters(name));
    }
}

bool PageOrigin::knows_host(std::string_view host) const {
    return std::find(hosts_.begin(), hosts_.end(), in_small_letters(host)) != hosts_.end();
}

bool PageOrigin::is_own(std::string_view origin, std::string_view host) const {
    const auto small = in_small_letters(origin);
    for (const std::string_view scheme : {"http://", "https://"})
        if (small.starts_with(scheme) && small.substr(scheme.size()) == in_small_letters(host)) return knows_host(host);
    return false;
}

}  // namespace taktwerk::hmi::web
