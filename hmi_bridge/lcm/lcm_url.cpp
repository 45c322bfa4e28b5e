#include "hmi_bridge/lcm/lcm_url.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <charconv>
#include <optional>

#include <fmt/format.h>

namespace taktwerk::hmi {
namespace {

constexpr std::string_view good_url = "Use udpm://239.255.76.67:7667?ttl=0.";

std::optional<int> number(std::string_view text, int lowest, int highest) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value < lowest || value > highest) return std::nullopt;
    return value;
}

Error wrong(std::string_view url, std::string what) { return {"hmi.lcm_url", std::string(url), std::move(what), std::string(good_url)}; }

}  // namespace

Result<LcmUrl> parse_lcm_url(std::string_view url) {
    LcmUrl out;
    if (url.starts_with("memq://")) {
        out.provider = LcmUrl::Provider::memq;
        out.text = "memq://";
        return out;
    }
    if (!url.starts_with("udpm://"))
        return wrong(url, "only udpm:// (and memq:// for tests) is taken as an LCM provider; the others block");
    auto rest = url.substr(7);
    std::string_view options;
    if (const auto mark = rest.find('?'); mark != std::string_view::npos) {
        options = rest.substr(mark + 1);
        rest = rest.substr(0, mark);
    }
    if (!rest.empty()) {
        const auto colon = rest.find(':');
        out.group = std::string(rest.substr(0, colon));
        if (colon != std::string_view::npos) {
            const auto port = number(rest.substr(colon + 1), 1, 65535);
            if (!port) return wrong(url, "the port is not 1 to 65535");
            out.port = static_cast<std::uint16_t>(*port);
        }
    }
    // LCM and the system take it as a C string: what stands behind a NUL would be checked by nobody.
    if (out.group.find('\0') != std::string::npos) return wrong(url, "the multicast address has a NUL in it");
    in_addr group{};
    if (::inet_pton(AF_INET, out.group.c_str(), &group) != 1 || !IN_MULTICAST(ntohl(group.s_addr)))
        return wrong(url, fmt::format("'{}' is not an IPv4 multicast address (224.0.0.0 to 239.255.255.255)", out.group));
    std::string others;
    while (!options.empty()) {
        const auto end = options.find('&');
        const auto option = options.substr(0, end);
        options = end == std::string_view::npos ? std::string_view{} : options.substr(end + 1);
        if (option.starts_with("ttl=")) {
            const auto ttl = number(option.substr(4), 0, 255);
            if (!ttl) return wrong(url, "ttl is not 0 to 255");
            out.ttl = *ttl;
        } else if (option.starts_with("recv_buf_size=") && number(option.substr(14), 1, 1 << 30)) {
            others += fmt::format("&{}", option);
        } else {
            return wrong(url, fmt::format("'{}' is not an option of udpm; there are ttl and recv_buf_size", option));
        }
    }
    out.text = fmt::format("udpm://{}:{}?ttl={}{}", out.group, out.port, out.ttl, others);
    return out;
}

}  // namespace taktwerk::hmi
