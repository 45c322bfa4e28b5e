#pragma once
// The provider part of an LCM URL, as far as Taktwerk takes it.

#include <cstdint>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace taktwerk::hmi {

struct LcmUrl {
    enum class Provider : std::uint8_t { udpm, memq };
    Provider provider = Provider::udpm;
    std::string group = "239.255.76.67";  ///< multicast address (udpm)
    std::uint16_t port = 7667;
    int ttl = 0;       ///< 0: this host only
    std::string text;  ///< the URL for LCM, with the ttl said

    [[nodiscard]] bool leaves_host() const noexcept { return provider == Provider::udpm && ttl > 0; }
};

/// "udpm://239.255.76.67:7667?ttl=0" or "memq://". Errors: hmi.lcm_url (tcpq and others are not taken: they block or write files).
[[nodiscard]] Result<LcmUrl> parse_lcm_url(std::string_view url);

}  // namespace taktwerk::hmi
