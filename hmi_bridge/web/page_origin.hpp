#pragma once
// Whether a request is meant for this server and comes from its own page. The name in `Host` is compared with a list (DNS rebinding brings a foreign
// name to a local address), and a WebSocket's `Origin` with that name (a foreign page may open a WebSocket to anywhere). RFC 6454, RFC 6455 section 10.2.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace taktwerk::hmi::web {

/// "127.0.0.1", "::1" (without brackets) and the rest of 127.0.0.0/8.
[[nodiscard]] bool is_loopback(std::string_view address);

class PageOrigin {
public:
    /// `address`: where the server listens. On loopback its names are localhost, 127.0.0.1, [::1] and the address; elsewhere the address; for all
    /// addresses (0.0.0.0, ::) the one at which a connection has come. `names`: more, as a browser writes them into `Host`: "hmi.example", "hmi.example:8443".
    PageOrigin(std::string_view address, std::uint16_t port, const std::vector<std::string>& names = {});

    /// `host`: the header as it came, with or without a port (80 then). Letters in either case. `arrived`: the address at which the connection came,
    /// without brackets.
    [[nodiscard]] bool knows_host(std::string_view host, std::string_view arrived = {}) const;
    /// Of a WebSocket or a POST: known host, and `origin` is there and is http:// or https:// and that same host.
    [[nodiscard]] bool is_own(std::string_view origin, std::string_view host, std::string_view arrived = {}) const;

private:
    void add(const std::string& name, std::uint16_t port);

    std::uint16_t port_;
    bool everywhere_;
    std::vector<std::string> hosts_;  ///< in small letters, with port; without, too, when it is 80
};

}  // namespace taktwerk::hmi::web
