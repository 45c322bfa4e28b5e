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

std::string with_brackets(std::string_view address) {
    return address.find(':') == std::string_view::npos ? std::string(address) : "[" + std::string(address) + "]";
}

}  // namespace

bool is_loopback(std::string_view address) {
    const std::string text(address);
    in_addr four{};
    if (::inet_pton(AF_INET, text.c_str(), &four) == 1) return (ntohl(four.s_addr) >> 24) == 127;
    in6_addr six{};
    return ::inet_pton(AF_INET6, text.c_str(), &six) == 1 && IN6_IS_ADDR_LOOPBACK(&six);
}

PageOrigin::PageOrigin(std::string_view address, std::uint16_t port, const std::vector<std::string>& names)
    : port_(port), everywhere_(address == "0.0.0.0" || address == "::") {
    if (!everywhere_) add(with_brackets(address), port);
    if (is_loopback(address))
        for (const char* name : {"localhost", "127.0.0.1", "[::1]"}) add(name, port);
    for (const auto& name : names) hosts_.push_back(in_small_letters(name));
}

void PageOrigin::add(const std::string& name, std::uint16_t port) {
    hosts_.push_back(in_small_letters(name) + ":" + std::to_string(port));
    if (port == http_port) hosts_.push_back(in_small_letters(name));
}

bool PageOrigin::knows_host(std::string_view host, std::string_view arrived) const {
    const auto small = in_small_letters(host);
    if (std::find(hosts_.begin(), hosts_.end(), small) != hosts_.end()) return true;
    // A number is nobody's name: what a foreign page is made to point here by still says that page's.
    if (!everywhere_ || arrived.empty()) return false;
    const auto number = in_small_letters(with_brackets(arrived));
    return small == number + ":" + std::to_string(port_) || (port_ == http_port && small == number);
}

bool PageOrigin::is_own(std::string_view origin, std::string_view host, std::string_view arrived) const {
    const auto small = in_small_letters(origin);
    for (const std::string_view scheme : {"http://", "https://"})
        if (small.starts_with(scheme) && small.substr(scheme.size()) == in_small_letters(host)) return knows_host(host, arrived);
    return false;
}

}  // namespace taktwerk::hmi::web
