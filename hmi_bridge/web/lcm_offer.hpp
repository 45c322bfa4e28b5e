#pragma once
// Whether a page's server can take a machine's values over LCM, by what the machine's `hello` says of it. Not real-time.

#include <cstdint>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "hmi_bridge/lcm/lcm_url.hpp"

namespace taktwerk::hmi::web {

/// From where a page's values come.
enum class ValueSource : std::uint8_t {
    automatic,  ///< LCM where it works, else the socket
    lcm,        ///< LCM or nothing
    socket,     ///< the socket alone
};

struct LcmOffer {
    static constexpr double least_rate_hz = 20;  ///< of a page that looks alive

    LcmUrl url;
    std::int64_t run = 0;  ///< whole_state_v5_t.run
    std::string why_not;   ///< empty: it can
};

/// `hello`: a machine's answer. Whatever it is, nothing throws.
[[nodiscard]] LcmOffer read_lcm_offer(const nlohmann::ordered_json& hello);

}  // namespace taktwerk::hmi::web
